"""softdot kit: every file, one page that needs nothing else, refusals in one sentence."""

import json
import re
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from softdot.cli import main
from softdot.kit import folder as make
from softdot.tolerances.budget import Budget, Effect
from softdot.tolerances.questions import Response
from softdot.tolerances.tolerances import Tolerance
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError
from tests.cases import for_each
from tests.softdot.conftest import MINIMAL

FREE = """
[segment]
boundary = "free"
[segment.medium1]
thickness_mm = 0.5
material = "dragon-skin-10"
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
material = "sponge"
[fabrication]
cavities = [1, 1]
"""
DOME = (
    """
[segment.effector]
shape = "dome"
diameter_mm = 2.0
height_mm = 0.8
material = "dragon-skin-10"
"""
    + MINIMAL
)
COARSE = (
    "[segment.effector]"
    + MINIMAL
    + """
material = "vnr-soft"
[fabrication]
cavities = [1, 1]
[press]
indentation_mm = 0.1
load_steps = 2
[mesh]
element_size_mm = 0.6
contact_element_size_mm = 0.4
mesher = "layered"
"""
)
NOMINAL, CHANGE, NOTHING = Response(0.5, 9.0), Response(0.05, 1.8), Response(0.0, 0.0)
PERCENTILES = ("below_5_percent", "below_50_percent", "below_95_percent")
MADE_UP = Budget(
    NOMINAL, NOTHING, CHANGE,
    (Effect(Tolerance("height of the dot", 0.5, 0.1, "mm", "a book", "high"), CHANGE, NOTHING, "derivative"),),
    (0.6, 0.2),
    {
        "count": 10_000, "presses": 7, "left_out_error": {"force_percent": 0.5, "voltage_percent": 1.5},
        "force_N": dict(zip(PERCENTILES, (0.41, 0.5, 0.61), strict=True)),
        "voltage_V": dict(zip(PERCENTILES, (7.1, 9.0, 11.2), strict=True)),
    },
)  # fmt: skip


def white_pictures(contents, _cut, folder):
    """A small white picture for every one that the page can ask for."""
    from matplotlib.image import imsave

    names = ["exploded", "section", "jig", *(f"assembly-{number}" for number in range(1, 7))]
    names += [f"mould-{pour.component}" for pour in contents.solid.pours]
    names += [f"cut-{pattern.name}" for pattern in contents.flat.patterns]
    names += [f"printability-{part.label}" for part in contents.solid.parts]
    for name in names:
        imsave(folder / f"{name}.png", np.ones((2, 2, 3)))


@pytest.fixture(scope="module")
def kit(tmp_path_factory):
    """The kit of a free segment without an effector, its pictures and its budget made up; what was printed."""
    folder = tmp_path_factory.mktemp("kit")
    (folder / "free.toml").write_text(FREE, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(make, "ensure_rendering", lambda: None)
        patch.setattr(make, "draw_all", white_pictures)
        patch.setattr(make, "tolerance_budget", lambda *_: MADE_UP)
        status = main(["kit", str(folder / "free.toml"), "-o", str(folder / "out"), "--json"])
    assert status == 0
    return folder / "out"


@pytest.fixture(scope="module")
def summary(kit):
    return json.loads((kit / "kit.json").read_text("utf-8"))


@pytest.mark.press
def test_everything_is_there(kit, summary):
    assert {entry.name for entry in kit.iterdir()} == make.KIT.files
    assert summary["format"] == "softdot-kit/1"
    assert {f"parts/{path.name}" for path in (kit / "parts").iterdir()} == {part["file"] for part in summary["parts"]}
    files = {file for pattern in summary["flat_patterns"] for file in pattern["files"]}
    assert {f"cut/{path.name}" for path in (kit / "cut").iterdir()} == files


def test_stl_holds_the_volume_of_the_part(kit, summary):
    for part in summary["parts"]:
        surface = trimesh.load(kit / part["file"])
        assert surface.is_volume
        assert surface.volume == pytest.approx(part["volume_mm3"], rel=2e-3)
        assert np.ptp(surface.bounds, axis=0) == pytest.approx(part["size_mm"], abs=0.02)


def test_3mf_says_millimetres_and_names_and_colours_its_parts(kit, summary):
    with zipfile.ZipFile(kit / "kit.3mf") as package:
        model = package.read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in model
    assert all(part["label"] in model for part in summary["parts"])
    assert re.search(r'displaycolor="#[0-9A-F]{6}', model)


def test_parts_lie_side_by_side(kit, summary):
    """In the file for all of them no two boxes touch, and all stand on z = 0."""
    from build123d import import_step

    boxes = [solid.bounding_box() for solid in import_step(kit / "kit.step").solids()]
    assert len(boxes) == len(summary["parts"])
    for number, one in enumerate(boxes):
        assert abs(one.min.Z) < 1e-6
        for other in boxes[:number]:
            apart_x = max(one.min.X - other.max.X, other.min.X - one.max.X)
            assert max(apart_x, one.min.Y - other.max.Y, other.min.Y - one.max.Y) > 1.0


def test_step_holds_every_part_by_name(kit, summary):
    text = (kit / "kit.step").read_text(encoding="utf-8")
    assert "MILLI" in text
    assert all(f"'{part['label']}'" in text for part in summary["parts"])


def test_page_needs_nothing_else(kit):
    """Pictures are in the page; it asks for no other file."""
    page = (kit / "kit.html").read_text("utf-8")
    assert set(re.findall(r'(?:src|href)="(\w+):', page)) == {"data"}
    assert "@page" in page


@for_each(
    "head",
    [
        "What you build", "What you need", "Parts to print", "Can they be printed?", "Moulds and pours",
        "Flat patterns", "Step by step", "Checks on the way", "Tolerance budget",
    ],
)  # fmt: skip
def test_page_has_every_chapter(kit, head):
    assert f"<h2>{head}</h2>" in (kit / "kit.html").read_text("utf-8")


def test_page_names_every_file_and_every_thickness(kit, summary):
    page = (kit / "kit.html").read_text("utf-8")
    for name in [part["label"] for part in summary["parts"]] + [one["name"] for one in summary["flat_patterns"]]:
        assert name in page
    for size in ("2.5 × 2.5 mm, 0.5 mm", "2.5 × 2.5 mm, 2 mm", "28 µm", "23.7 pF", "dragon-skin-10, component B"):
        assert size in page


def test_mass_is_density_times_volume(summary):
    """Sponge of 0.2 g/cm3, 2.5 x 2.5 x 2 mm: 2.5 mg; film of 1.78 g/cm3: 0.3115 mg."""
    masses = {one["name"]: one["mass_mg"] for one in summary["components"]}
    assert masses["medium 2"] == pytest.approx(2.5)
    assert masses["film"] == pytest.approx(0.3115)


def test_bill_holds_both_components_of_the_mix(summary):
    """10 g are the least that can be mixed, one to one."""
    masses = {item["what"]: item["mass_g"] for item in summary["bill_of_materials"]}
    assert masses["dragon-skin-10, component A"] == masses["dragon-skin-10, component B"] == pytest.approx(5.0)


def test_capacitance_to_expect_is_that_of_a_plate(summary):
    assert summary["film"]["capacitance_pF"]["film"] == pytest.approx(8.8541878e-3 * 12.0 * 2.5**2 / 0.028)


def test_steps_end_with_a_press_and_use_what_is_there(summary):
    text = " ".join(action for step in summary["steps"] for action in step["actions"])
    named = set(re.findall(r"adhesive-[\w-]+\w", text))
    assert named == {one["name"] for one in summary["flat_patterns"] if one["name"].startswith("adhesive")}
    assert summary["checks"][-1]["what"].startswith("first press")


def prepared(monkeypatch):
    monkeypatch.setattr(make, "ensure_rendering", lambda: None)
    monkeypatch.setattr(make, "draw_all", white_pictures)


@pytest.mark.press
@pytest.mark.parametrize(
    ("error", "plain"),
    [
        (StoppedShortError("sub-steps fell below 1/64"), "did not reach its full load"),
        (LinearSolveError("pardiso: backward error 2.8e-08"), "could not be differentiated accurately enough"),
    ],
)
def test_a_budget_that_fails_leaves_a_kit_without_it(tmp_path, monkeypatch, capsys, error, plain):
    """The page says in plain words why; the solver's own sentence stands in kit.json and on the command line alone."""

    def stop(*_):
        raise error

    prepared(monkeypatch)
    monkeypatch.setattr(make, "tolerance_budget", stop)
    (tmp_path / "free.toml").write_text(FREE, "utf-8")
    assert main(["kit", str(tmp_path / "free.toml"), "-o", str(tmp_path / "out")]) == 3
    said = capsys.readouterr()
    assert said.out.endswith(f"\n{tmp_path / 'out' / 'kit.html'}\n")
    assert f"softdot: not converged, tolerance budget: {error}" in said.err
    summary = json.loads((tmp_path / "out" / "kit.json").read_text("utf-8"))
    assert (summary["tolerance_budget"], summary["tolerance_budget_state"]) == (None, "failed")
    assert summary["failure"] == f"tolerance budget: {error}"
    page = (tmp_path / "out" / "kit.html").read_text("utf-8")
    assert plain in page
    assert str(error) not in page


def wait_for(path):
    """A budget that takes longer than the files, beside which it is pressed."""
    for _ in range(6000):
        if path.exists():
            return
        time.sleep(0.01)
    raise AssertionError(f"{path} never came")


@pytest.mark.press
def test_the_kit_is_there_before_its_budget(tmp_path, monkeypatch):
    """Complete, and the page says that the budget is still to come."""
    seen = {}

    def look(*_):
        wait_for(tmp_path / "out" / "kit.json")
        seen["entries"] = {entry.name for entry in (tmp_path / "out").iterdir()}
        seen["summary"] = json.loads((tmp_path / "out" / "kit.json").read_text("utf-8"))
        seen["page"] = (tmp_path / "out" / "kit.html").read_text("utf-8")
        return MADE_UP

    prepared(monkeypatch)
    monkeypatch.setattr(make, "tolerance_budget", look)
    (tmp_path / "free.toml").write_text(FREE, "utf-8")
    assert main(["kit", str(tmp_path / "free.toml"), "-o", str(tmp_path / "out")]) == 0
    assert seen["entries"] == make.KIT.files
    assert (seen["summary"]["tolerance_budget"], seen["summary"]["failure"]) == (None, None)
    assert seen["summary"]["tolerance_budget_state"] == "unfinished"
    assert "The tolerance budget comes later" in seen["page"]
    summary = json.loads((tmp_path / "out" / "kit.json").read_text("utf-8"))
    assert summary["tolerance_budget_state"] == "complete"
    assert "The tolerance budget comes later" not in (tmp_path / "out" / "kit.html").read_text("utf-8")


@pytest.mark.press
def test_a_budget_does_not_go_into_another_kit(tmp_path, monkeypatch, capsys):
    """A second command that wrote its own kit into the folder meanwhile keeps it."""

    def overtaken(*_):
        wait_for(tmp_path / "out" / "kit.json")
        (tmp_path / "out" / "kit.json").write_text("{}", "utf-8")
        return MADE_UP

    prepared(monkeypatch)
    monkeypatch.setattr(make, "tolerance_budget", overtaken)
    (tmp_path / "free.toml").write_text(FREE, "utf-8")
    assert main(["kit", str(tmp_path / "free.toml"), "-o", str(tmp_path / "out")]) == 2
    assert "another kit was written there meanwhile" in capsys.readouterr().err
    assert (tmp_path / "out" / "kit.json").read_text(encoding="utf-8") == "{}"


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ("[fabrication]\nwall_mm = 0.3\n", "fabrication.wall_mm = 0.3: .*SLA limit for the unsupported wall of 0.6 mm"),
        ('[fabrication]\nlid_face = "top"\n', "undercut.*where the limit is 0"),
        ('[fabrication]\nmould_style = "open"\ndraft_deg = 0.2\n', "do not leave a mould without a parting"),
        ("[fabrication]\ntab_width_mm = 0.9\n", "below the limit of 0.3 mm for patterned metal"),
        ("[fabrication]\nkerf = 0.2\n", "fabrication.kerf is not a key"),
    ],
)
def test_an_impossible_kit_is_refused_in_one_sentence(tmp_path, monkeypatch, capsys, more, sentence):
    prepared(monkeypatch)
    (tmp_path / "dome.toml").write_text(DOME + more, "utf-8")
    assert main(["kit", str(tmp_path / "dome.toml"), "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert re.search(sentence, said)
    assert said.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["dome.toml"]


@pytest.mark.press
@pytest.mark.parametrize(("when", "left"), [("draw_all", ["free.toml"]), ("tolerance_budget", ["free.toml", "out"])])
def test_an_interrupt_leaves_a_whole_kit_or_nothing(tmp_path, monkeypatch, when, left):
    def interrupt(*_):
        raise KeyboardInterrupt

    prepared(monkeypatch)
    monkeypatch.setattr(make, when, interrupt)
    (tmp_path / "free.toml").write_text(FREE, "utf-8")
    assert main(["kit", str(tmp_path / "free.toml"), "-o", str(tmp_path / "out")]) == 130
    assert sorted(path.name for path in tmp_path.iterdir()) == left
    assert all({entry.name for entry in (tmp_path / name).iterdir()} == make.KIT.files for name in left[1:])


def test_another_folder_is_not_touched(tmp_path, monkeypatch, capsys):
    prepared(monkeypatch)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "letter.txt").write_text("mine", "utf-8")
    assert main(["kit", "-o", str(tmp_path / "out")]) == 2
    assert "holds 'letter.txt'" in capsys.readouterr().err
    assert (tmp_path / "out" / "letter.txt").read_text(encoding="utf-8") == "mine"


@pytest.mark.press
def test_whole_kit_of_a_coarse_segment(tmp_path, capsys):
    """With its own budget and pictures: a picture for every step, none of them empty, and a budget in order."""
    from matplotlib.image import imread

    (tmp_path / "coarse.toml").write_text(COARSE, "utf-8")
    out: Path = tmp_path / "out"
    assert main(["kit", str(tmp_path / "coarse.toml"), "-o", str(out), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary == json.loads((out / "kit.json").read_text("utf-8"))
    rows = summary["tolerance_budget"]["rows"]
    assert [abs(row["voltage_V"]) for row in rows] == sorted((abs(row["voltage_V"]) for row in rows), reverse=True)
    pictures = sorted((out / "pictures").glob("*.png"))
    assert {"exploded.png", "section.png", "jig.png", "mould-effector.png"} <= {path.name for path in pictures}
    assert all(np.ptp(imread(path)[..., :3]) > 0.5 for path in pictures)
    page = (out / "kit.html").read_text("utf-8")
    assert page.count("data:image/png;base64,") >= len(pictures) - 1
