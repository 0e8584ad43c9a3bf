"""softdot plate: the files against the table of standards, and what is refused."""

import io
import json
import re
import shutil
import subprocess
import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh
from build123d import import_step
from matplotlib.image import imread
from scipy import ndimage

from geometry.solids import volume_mm3
from softdot.cli import main
from softdot.plate import folder as make

pytestmark = pytest.mark.press

BRAILLE = "⠃⠗⠁⠊⠇⠇⠑"
# diameter, height, dot pitch, cell pitch in mm, as the sources of the table print them; ADA: the middle of its ranges
STANDARDS = {
    "marburg-medium": (1.5, 0.5, 2.5, 6.0),
    "nls": (1.44, 0.48, 2.34, 6.2),
    "ada": ((1.5 + 1.6) / 2, (0.6 + 0.9) / 2, (2.3 + 2.5) / 2, (6.1 + 7.6) / 2),
}
FILES = {
    "plate.json", "plate.step", "plate.3mf", "plate.stl", "plate.png", "printability-fdm.png", "printability-sla.png",
}  # fmt: skip
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
FACE_MM = 2.0
"""The face of the plate stands this high."""


def write(folder, *arguments, checked=False):
    """Run the command without its pictures, and mostly without the check; returns the folder that it wrote."""
    with pytest.MonkeyPatch.context() as patch:
        if not checked:
            patch.setattr(make, "check_plate", lambda _: ())
        patch.setattr(make, "draw_plate", lambda _, path: path.touch())
        patch.setattr(make, "draw_findings", lambda _body, _answer, path: path.touch())
        patch.setattr(make, "ensure_rendering", lambda: None)
        assert main(["plate", *arguments, "-o", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module", params=STANDARDS)
def written(request, tmp_path_factory):
    """A standard with its numbers and the folder of its plate."""
    folder = tmp_path_factory.mktemp("plate") / request.param
    return STANDARDS[request.param], write(folder, "braille", "--standard", request.param, checked=True)


def measured_dots(surface, face=FACE_MM):
    """Middle x, y, diameter of the base and height (n, 4) of what stands on a face, from triangles alone."""
    over = surface.vertices[:, 2][surface.faces].max(axis=1) > face + 1e-6
    pairs = surface.face_adjacency[over[surface.face_adjacency].all(axis=1)]
    labels = trimesh.graph.connected_component_labels(pairs, node_count=len(surface.faces))
    rows = []
    for label in np.unique(labels[over]):
        dot = surface.vertices[np.unique(surface.faces[labels == label])]
        base = dot[np.abs(dot[:, 2] - face) < 1e-6][:, :2]
        low, high = base.min(axis=0), base.max(axis=0)
        rows.append((*(low + high) / 2, (high - low).mean(), dot[:, 2].max() - face))
    return np.array(rows)


def test_dots_of_the_exported_surface_have_the_sizes_of_the_standard(written):
    (diameter, height, _, _), folder = written
    dots = measured_dots(trimesh.load(folder / "plate.stl"))
    assert len(dots) == 17
    assert dots[:, 2] == pytest.approx(diameter, abs=0.01)
    assert dots[:, 3] == pytest.approx(height, abs=0.01)


def test_a_reader_above_reads_the_word_at_the_pitches_of_the_standard(written):
    """Every dot lies within 0.01 mm of a place of the grid that the pitches give, and the places spell braille."""
    (_, _, pitch, cell_pitch), folder = written
    dots = measured_dots(trimesh.load(folder / "plate.stl"))
    x, y = dots[:, 0] - dots[:, 0].min(), dots[:, 1].max() - dots[:, 1]
    cells = [0] * 7
    numbers = {(0, 0): 1, (0, 1): 2, (0, 2): 3, (1, 0): 4, (1, 1): 5, (1, 2): 6}
    for right, down in zip(x, y, strict=True):
        cell = int((right + 0.01) // cell_pitch)
        column, row = round((right - cell * cell_pitch) / pitch), round(down / pitch)
        assert right == pytest.approx(cell * cell_pitch + column * pitch, abs=0.01)
        assert down == pytest.approx(row * pitch, abs=0.01)
        cells[cell] |= 1 << numbers[column, row] - 1
    assert "".join(chr(0x2800 + bits) for bits in cells) == BRAILLE


def test_step_stl_and_3mf_hold_the_same_closed_part(written):
    _, folder = written
    summary = json.loads((folder / "plate.json").read_text("utf-8"))
    [part] = import_step(folder / "plate.step").children
    assert part.label == "plate"
    assert volume_mm3(part) == pytest.approx(summary["volume_mm3"], rel=1e-6)
    surface = trimesh.load(folder / "plate.stl")
    assert surface.is_volume
    assert surface.volume == pytest.approx(summary["volume_mm3"], rel=1e-3)
    assert surface.extents == pytest.approx(summary["size_mm"], abs=0.01)
    with zipfile.ZipFile(folder / "plate.3mf") as archive:
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    assert model.get("unit") == "millimeter"
    [thing] = [thing for thing in model.iter(CORE + "object") if thing.get("name")]
    assert thing.get("name") == "plate"
    assert model.find(f".//{CORE}base").get("displaycolor")
    corners = [[float(v.get(axis)) for axis in "xyz"] for v in thing.iter(CORE + "vertex")]
    faces = [[int(t.get(corner)) for corner in ("v1", "v2", "v3")] for t in thing.iter(CORE + "triangle")]
    other = trimesh.Trimesh(corners, faces, process=False)
    assert other.is_volume
    assert other.volume == pytest.approx(summary["volume_mm3"], rel=1e-3)


def test_summary_says_every_size_and_where_it_comes_from(written):
    (diameter, height, pitch, cell_pitch), folder = written
    assert {path.name for path in folder.iterdir()} == FILES | {"log.txt"}
    summary = json.loads((folder / "plate.json").read_text("utf-8"))
    assert summary["format"] == "softdot-plate/1"
    assert summary["cells"] == [BRAILLE]
    assert summary["translation"] == {"table": "uncontracted English (UEB grade 1)", "liblouis": None}
    sizes = {name: size["value_mm"] for name, size in summary["dimensions"].items()}
    assert sizes.pop("line_pitch_mm") in (10.0, 10.1)
    assert sizes == pytest.approx(
        {"base_diameter_mm": diameter, "height_mm": height, "dot_pitch_mm": pitch, "cell_pitch_mm": cell_pitch}
    )
    assert all(size["source"] and size["basis"] for size in summary["dimensions"].values())
    assert len(summary["dots"]) == 17
    assert set(summary["files"]) == FILES


def test_a_braille_plate_is_advised_for_sla(written):
    _, folder = written
    answers = {a["profile"]: a for a in json.loads((folder / "plate.json").read_text("utf-8"))["printability"]}
    assert answers["sla"]["printable"]
    assert answers["sla"]["advised_process"] == answers["fdm"]["advised_process"] == "sla"
    rules = {finding["rule"]: finding for finding in answers["fdm"]["findings"]}
    (diameter, height, _, _), _ = written
    assert rules["feature"]["value"] == pytest.approx(diameter, abs=0.01)
    assert rules["relief"]["value"] == pytest.approx(height, abs=0.01)


def test_the_other_kinds(tmp_path):
    standard = ["--standard", "marburg-medium"]
    series = write(tmp_path / "series", "--kind", "height-series", "--heights-mm", "0.3,0.5,0.9", *standard)
    dots = measured_dots(trimesh.load(series / "plate.stl"))
    dots = dots[np.argsort(dots[:, 0])]
    assert dots[:, 3] == pytest.approx([0.3, 0.5, 0.9], abs=0.01)
    assert dots[:, 2] == pytest.approx(1.5, abs=0.01)
    assert np.diff(dots[:, 0]) == pytest.approx(10.0, abs=0.01)
    dot = write(tmp_path / "dot", "--kind", "dot", "--height-mm", "0.4", *standard)
    assert measured_dots(trimesh.load(dot / "plate.stl"))[0] == pytest.approx([0, 0, 1.5, 0.4], abs=0.01)
    tip = write(tmp_path / "tip", "--kind", "tip", *standard)
    surface = trimesh.load(tip / "plate.stl")
    assert surface.is_volume
    flat = json.loads((tip / "plate.json").read_text("utf-8"))["dots"][0]["base_z_mm"]
    assert measured_dots(surface, flat)[0] == pytest.approx([0, 0, 1.5, 0.5], abs=0.01)


def test_json_and_pictures_of_the_whole_command(tmp_path, capfd):
    assert main(["plate", "⠃⠗", "--standard", "nls", "-o", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capfd.readouterr().out) == json.loads((tmp_path / "out/plate.json").read_text("utf-8"))
    for name in ("printability-fdm.png", "printability-sla.png"):
        pixels = imread(tmp_path / "out" / name)
        assert pixels.shape[:2] == (1200, 1600)
        assert pixels[300:900, 200:1100, :3].std() > 0.02  # something is drawn
    pixels = imread(tmp_path / "out/plate.png")
    drawn = np.flatnonzero((pixels[..., :3] < 0.99).any(axis=(1, 2)))
    assert pixels.shape[1] == 1600
    assert np.ptp(drawn) > 0.8 * len(pixels)  # and no empty page below it
    assert pixels[300:800, 200:1100, :3].std() > 0.02


REFUSED = {
    "empty text": (["", "--standard", "ada"], "text: is empty"),
    "no text": (["--standard", "ada"], "text: is empty"),
    "unknown standard": (["a", "--standard", "adda"], "--standard = 'adda': .* did you mean 'ada'"),
    "standard like none": (["a", "--standard", "q"], "known are nls, ada, .*jumbo"),
    "size that is not fixed": (["a", "--standard", "norway"], "--standard 'norway': has no height_mm; give it by"),
    "character": (["aπ", "--standard", "ada"], "'π' .* at place 2 .*liblouis"),
    "long line": (["a" * 41, "--standard", "ada"], "41 cells, at most 40 .*--width-cells"),
    "option of another kind": (["a", "--standard", "ada", "--thread", "M6"], "--thread: has no meaning for .*text"),
    "given pitch of another kind": (
        ["--kind", "tip", "--standard", "ada", "--dot-pitch-mm", "2"], "--dot-pitch-mm: has no meaning for --kind tip",
    ),
    "text of another kind": (["a", "--kind", "dot", "--standard", "ada"], "--kind dot has no text"),
    "thickness": (["a", "--standard", "ada", "--thickness-mm", "-1"], "--thickness-mm = -1: must be from 0.01 to 1000"),
    "zero margin": (["a", "--standard", "ada", "--margin-mm", "0"], "--margin-mm = 0: must be from 0.01 to 1000"),
    "width": (["a", "--standard", "ada", "--width-cells", "0"], "--width-cells = 0: must be at least 1"),
    "heights": (
        ["--kind", "height-series", "--standard", "ada", "--heights-mm", "0.1,x"], "'0.1,x': must be numbers in mm",
    ),
    "tiny": (["a", "--standard", "ada", "--base-diameter-mm", "1e-9"], "--base-diameter-mm = 1e-09: must be from 0.01"),
    "low": (["--kind", "height-series", "--standard", "ada", "--heights-mm", "0.5,1e-7"], "--heights-mm = 1e-07: must"),
    "no number": (["a", "--standard", "ada", "--height-mm", "nan"], "--height-mm = nan: must be from 0.01 to 1000"),
}  # fmt: skip


@pytest.mark.parametrize(("arguments", "words"), REFUSED.values(), ids=REFUSED)
def test_bad_input_is_one_sentence_and_nothing_is_written(tmp_path, capfd, arguments, words):
    assert main(["plate", *arguments, "-o", str(tmp_path / "new/out")]) == 2
    said = capfd.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert said.err.startswith("softdot: ")
    assert re.search(words, said.err), said.err
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_leaves_nothing(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(make, "check_plate", interrupted)
    monkeypatch.setattr(make, "ensure_rendering", lambda: None)
    assert main(["plate", "a", "--standard", "nls", "-o", str(tmp_path / "out")]) == 130
    assert list(tmp_path.iterdir()) == []


def test_an_earlier_plate_is_replaced_and_a_strange_folder_is_not(tmp_path, capfd):
    out = write(tmp_path / "out", "a", "--standard", "nls")
    write(out, "b", "--standard", "nls")
    assert json.loads((out / "plate.json").read_text("utf-8"))["cells"] == ["⠃"]
    (out / "mine.txt").write_text("kept", "utf-8")
    assert main(["plate", "a", "--standard", "nls", "-o", str(out)]) == 2
    assert "holds 'mine.txt'" in capfd.readouterr().err


SLICED = {
    "text": ("braille", "--standard", "marburg-medium"),
    "series": ("--kind", "height-series", "--standard", "ada"),
    "tip": ("--kind", "tip", "--standard", "marburg-medium"),
}
needs_slicer = pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed")


def slicer(*arguments):
    """What PrusaSlicer says."""
    done = subprocess.run(["prusa-slicer", *map(str, arguments)], capture_output=True, encoding="utf-8", timeout=170)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


@needs_slicer
@pytest.mark.parametrize("arguments", SLICED.values(), ids=SLICED)
def test_prusaslicer_slices_every_kind_by_the_advised_process(tmp_path, arguments):
    folder = write(tmp_path / "out", *arguments, checked=True)
    summary = json.loads((folder / "plate.json").read_text("utf-8"))
    assert {answer["advised_process"] for answer in summary["printability"]} == {"sla"}
    for name in ("plate.stl", "plate.3mf"):
        assert "manifold = yes" in slicer("--info", folder / name)
    said = slicer(
        "--export-sla", folder / "plate.stl", "--supports-enable=0", "--pad-enable=0", "-o", tmp_path / "x.sl1"
    )
    assert "Slicing done" in said
    assert "manifold" not in said.lower()
    assert "repair" not in said.lower()


@needs_slicer
def test_layers_of_the_slicer_show_the_dots(tmp_path):
    """The first layer over the face of a Marburg plate shows 17 discs of the right area."""
    folder = write(tmp_path / "out", *SLICED["text"])
    options = ("--layer-height", "0.05", "--initial-layer-height", "0.05", "--supports-enable=0", "--pad-enable=0")
    display = (
        "--display-width",
        "120",
        "--display-height",
        "68",
        "--display-pixels-x",
        "2560",
        "--display-pixels-y",
        "1440",
    )
    slicer("--export-sla", folder / "plate.stl", *options, *display, "-o", tmp_path / "x.sl1")
    with zipfile.ZipFile(tmp_path / "x.sl1") as archive:
        names = sorted(name for name in archive.namelist() if name.endswith(".png") and "thumb" not in name)
        layer = imread(io.BytesIO(archive.read(names[round(FACE_MM / 0.05)]))) > 0.5
    assert ndimage.label(layer)[1] == 17
    # a sphere of 0.8125 mm, cut 0.025 mm over the base, the middle of the layer
    radius_squared = 0.8125**2 - (0.8125 - 0.5 + 0.025) ** 2
    pixel_mm2 = (120 / 2560) * (68 / 1440)
    assert layer.sum() * pixel_mm2 == pytest.approx(17 * np.pi * radius_squared, rel=0.03)


@needs_slicer
def test_prusaslicer_slices_a_plate_for_fdm_too(tmp_path):
    folder = write(tmp_path / "out", *SLICED["text"])
    slicer("--export-gcode", folder / "plate.stl", "-o", tmp_path / "x.gcode")
    assert "G1 " in (tmp_path / "x.gcode").read_text("utf-8")
