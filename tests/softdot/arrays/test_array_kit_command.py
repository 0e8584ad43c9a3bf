"""softdot kit of an array at the command line: what it writes, and what it refuses."""

import json
import re

import numpy as np
import pytest

from softdot.cli import main
from softdot.config.loading import load_config
from softdot.kit import folder as make
from softdot.tolerances.budget import tolerance_budget
from tests.softdot.arrays.test_array_command import SMALL
from tests.softdot.test_kit import MADE_UP, prepared

SHEETS = '\n[fabrication.routes]\neffector = "sheet"\nmedium1 = "sheet"\nmedium2 = "sheet"\n'
"""Nothing is cast, so that no mould is built."""


def written(tmp_path, text):
    path = tmp_path / "array.toml"
    path.write_text(text, "utf-8")
    return str(path)


def in_array(line):
    return SMALL.replace("rows = 1", f"rows = 1\n{line}")


@pytest.fixture(scope="module")
def summary(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kit")
    with pytest.MonkeyPatch.context() as patch:
        prepared(patch)
        patch.setattr(make, "tolerance_budget", lambda *_: MADE_UP)
        path = written(folder, SMALL.replace("rows = 1", "rows = 3") + SHEETS)
        assert main(["kit", path, "-q", "-o", str(folder / "out")]) == 0
    told = json.loads((folder / "out" / "kit.json").read_text("utf-8"))
    return told | {"page": (folder / "out" / "kit.html").read_text("utf-8"), "folder": folder / "out"}


@pytest.mark.press
def test_the_kit_of_a_cell_has_its_files(summary):
    names = {path.name for path in (summary["folder"] / "cut").iterdir()}
    assert {"film.dxf", "film.svg", "mask-top.dxf", "mask-bottom.dxf", "spacer-x.dxf", "spacer-y.svg"} <= names
    assert {part["label"] for part in summary["parts"]} == {"base", "jig"}


@pytest.mark.press
def test_every_electrode_has_its_trace_and_its_capacitance(summary):
    """Relative permittivity 12, 2.3 x 2.3 mm, 28 um; no film between a trace and the common electrode."""
    film = summary["film"]
    names = [f"segment-r{row}c{column}" for row in (1, 2, 3) for column in (1, 2)]
    assert set(film["capacitance_pF"]) == set(names)
    assert list(film["capacitance_pF"].values()) == pytest.approx([8.8541878e-3 * 12.0 * 2.3**2 / 0.028] * 6)
    traces = film["traces"]
    assert [trace["pad"] for trace in traces] == list(range(1, 8))
    assert sorted(trace["electrode"] for trace in traces) == sorted([*names, "common"])
    assert all(trace["parasitic_capacitance_pF"] == pytest.approx(0.0, abs=1e-9) for trace in traces)
    for trace in traces:
        assert trace["squares"] == pytest.approx(trace["length_mm"] / 0.3)
        assert trace["resistance_ohm"]["NiAl"] == pytest.approx(3.0 * trace["squares"])


def test_the_bill_counts_the_pieces_of_the_array(summary):
    pieces = {one["name"]: one["pieces"] for one in summary["components"]}
    assert pieces == {"effector": 6, "medium 1": 1, "film": 1, "medium 2": 1}
    cut = {one["name"]: one["pieces"] for one in summary["flat_patterns"]}
    assert (cut["sheet-effector"], cut["adhesive-medium1-effector"], cut["sheet-medium2"]) == (6, 6, 1)
    sizes = {one["name"]: one["size"] for one in summary["components"]}
    assert sizes["medium 2"] == "4.8 × 7.3 mm, 2 mm"


def test_the_page_speaks_of_the_array_and_says_whose_budget_it_shows(summary):
    page = summary["page"]
    assert "an array of 6 segments" in page
    assert "Traces and pads" in page
    assert "This budget is that of one segment of the array alone, free at its own sides" in page
    assert summary["tolerance_budget_of"] == "one segment of the array alone, free at its own sides"
    assert not any(check["what"].startswith("first press: the cap") for check in summary["checks"])
    assert any("beyond the free rim" in warning for warning in summary["warnings"])


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("pitch_mm = 2.0", "array.pitch_mm = 2: the segments overlap along x"),
        ("cells = 2\ncell_pitch_mm = 4.0", "array.cell_pitch_mm = 4: the cells overlap, it must be at least 4.8"),
        ("pitch_mm = 2.4", "array.electrode_margin_mm = 0: 'segment-r1c1' and 'segment-r1c2' are 0.1 mm apart"),
        ('grid_layers = ["medium1", "film"]', "array.grid_layers = ['medium1', 'film']: gaps of 0.2 mm"),
        ('shared = ["medium2"]', "array.shared = ['medium2']: no trace leads out of a film that is an island"),
    ],
)
def test_bad_arrays_are_one_sentence_and_nothing_is_written(tmp_path, monkeypatch, capsys, line, sentence):
    prepared(monkeypatch)
    path = written(tmp_path, in_array(line) + SHEETS)
    assert main(["kit", path, "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"softdot: {sentence}"), said
    assert said.count("\n") == 1
    assert [entry.name for entry in tmp_path.iterdir()] == ["array.toml"]


def test_traces_that_cannot_be_led_out_are_refused_with_what_fits(tmp_path, monkeypatch, capsys):
    """The middle of three by three has no way out between electrodes that are 0.2 mm apart."""
    prepared(monkeypatch)
    text = SMALL.replace("rows = 1", "rows = 3").replace("columns = 2", "columns = 3").replace('cell = "⠉"', "")
    assert main(["kit", written(tmp_path, text + SHEETS), "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert re.search(
        r"electrode_margin_mm = 0: .* takes 0 traces of 0.3 mm .*, and 1 must pass; .* at least 0.25", said
    )
    assert said.count("\n") == 1
    assert [entry.name for entry in tmp_path.iterdir()] == ["array.toml"]


def test_the_budget_presses_one_segment_held_as_its_grid_holds_it(tmp_path):
    free = load_config(written(tmp_path, SMALL))
    alone = make.budget_config(free)
    assert (alone.array, alone.dot.cell, alone.segment) == (None, None, free.segment)
    held = make.budget_config(load_config(written(tmp_path, in_array('grid_layers = ["medium1", "film"]'))))
    assert (held.segment.boundary, held.segment.held_layers) == ("clamped", ("medium1", "film"))


@pytest.mark.evidence
def test_whole_kit_of_a_pair(tmp_path, capsys):
    """With moulds, pictures and the budget of a lone segment, which is the budget of that segment itself."""
    from matplotlib.image import imread

    path, out = written(tmp_path, SMALL), tmp_path / "out"
    assert main(["kit", path, "-q", "--json", "-o", str(out)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["failure"] is None
    assert {check["component"] for check in told["cavity_checks"]} == {"effector", "medium1", "medium2"}
    assert all(answer["printable"] for answer in told["printability"])
    nominal = tolerance_budget(make.budget_config(load_config(path))).nominal
    assert told["tolerance_budget"]["nominal"]["voltage_V"] == pytest.approx(nominal.voltage)
    pictures = sorted((out / "pictures").glob("*.png"))
    assert {"exploded.png", "section.png", "mould-medium2.png", "cut-spacer-y.png"} <= {one.name for one in pictures}
    assert all(np.ptp(imread(one)[..., :3]) > 0.5 for one in pictures)
