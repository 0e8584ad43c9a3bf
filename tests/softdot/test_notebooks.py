"""The notebooks run from top to bottom, and what they find is what their text says."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LIMIT_S = 600
CLAIMS = {
    "first_press": "assert pressed.converged; assert (np.diff(pressed.reaction_force_N) > 0.0).all()",
    "design_study": "assert len(frame) == 5; assert thick.open_circuit_voltage_V[-1] < thin.open_circuit_voltage_V[-1]",
    "reading_a_verdict": "assert named.missing_physics[0]['mechanism'] == 'hyperelastic-stiffening'; "
    "assert not control.mismatch",
}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs(path):
    cells = nbformat.read(path, as_version=4).cells
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells)


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "cache"))
    book = nbformat.read(path, as_version=4)
    book.cells.append(nbformat.v4.new_code_cell(f"import numpy as np; {CLAIMS[path.stem]}"))
    NotebookClient(book, timeout=LIMIT_S, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert not any(output.output_type == "error" for cell in book.cells for output in cell.get("outputs", []))
