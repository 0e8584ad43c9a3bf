"""softdot array at the command line: what it writes, and what it refuses."""

import csv
import json

import numpy as np
import pytest

from softdot.cli import main

SMALL = """
[segment]
length_mm = 2.3
width_mm = 2.3
boundary = "free"
[segment.effector]
height_mm = 1.0
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
[array]
columns = 2
rows = 1
[dot]
standard = "marburg-medium"
cell = "⠉"
[press]
indentation_mm = 0.15
load_steps = 2
[mesh]
element_size_mm = 1.0
contact_element_size_mm = 0.4
"""


def test_bad_arrays_are_one_sentence_and_nothing_is_written(tmp_path, capfd):
    path = tmp_path / "array.toml"
    for line, sentence in {
        "pitch_mm = 2.0": "array.pitch_mm = 2: the segments overlap along x",
        "colums = 3": "array.colums is not a key; did you mean 'columns'?",
        'shared = ["glue"]': "array.shared[0] = 'glue': must be",
    }.items():
        path.write_text(SMALL.replace("rows = 1", f"rows = 1\n{line}"), "utf-8")
        assert main(["array", str(path), "-o", str(tmp_path / "out")]) == 2
        said = capfd.readouterr().err
        assert said.startswith(f"softdot: {sentence}"), said
        assert said.count("\n") == 1
        assert not (tmp_path / "out").exists()


def test_run_sends_an_array_to_its_own_command(tmp_path, capfd):
    path = tmp_path / "array.toml"
    path.write_text(SMALL, "utf-8")
    assert main(["run", str(path), "-o", str(tmp_path / "out")]) == 2
    assert "array: this is one segment's command; use softdot array" in capfd.readouterr().err


def test_check_tells_the_cost_of_all_presses(tmp_path, capfd):
    path = tmp_path / "array.toml"
    path.write_text(SMALL, "utf-8")
    assert main(["check", str(path), "--json"]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told["mistakes"] == []
    assert told["expected"]["tetrahedra"] > 500


@pytest.mark.press
def test_a_pair_of_segments_gives_its_folder(tmp_path, capfd, monkeypatch):
    """Matrix, cell, sides, variants; a second run solves only the press that is drawn."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "cache"))
    path, out = tmp_path / "array.toml", tmp_path / "out"
    path.write_text(SMALL, "utf-8")
    assert main(["array", str(path), "--variants", "-q", "--json", "-o", str(out)]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told == json.loads((out / "array.json").read_text("utf-8"))
    charge = np.array(told["charge_matrix_pC"])
    np.testing.assert_array_equal(charge, charge[::-1, ::-1])
    assert 0.0 < told["largest_crosstalk_percent"] < 50.0
    cell = told["cell_press"]
    assert np.abs(cell["superposition_error_percent"]).max() < 20.0
    assert told["effective_side_stiffness_N_per_mm3"]["inner"] is None
    assert told["effective_side_stiffness_N_per_mm3"]["edge"] > 0.0
    by_name = {one["name"]: one for one in told["variants"]}
    assert by_name["nothing runs through"]["largest_crosstalk_percent"] < 1e-6
    with (out / "crosstalk.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 3 * 2
    assert float(rows[-2]["charge_pC"]) == pytest.approx(charge[1, 0])
    assert {entry.name for entry in out.iterdir()} == {
        "array.json", "cad", "crosstalk.csv", "log.txt", "pictures", "report.html", "results"
    }  # fmt: skip
    assert "segment-r1c2" in (out / "cad" / "array.step").read_text("utf-8", "replace")
    assert "http" not in (out / "report.html").read_text("utf-8").replace("http://www.w3.org", "")
