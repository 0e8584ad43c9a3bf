"""Every notebook of the examples runs from a folder of its own, is stored without results, and finds what it explains.

A notebook is executed as Jupyter would, in a new kernel, with an empty cache. A last cell, which is not part of the
file, then asks the variables that are left: forces that grow, a charge that is capacitance times voltage, sums that are
one, a law that is found again.
"""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from foundation.thread_pools import ONE_THREAD_VARIABLES
from tests.cases import for_each

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
LONGEST_CELL_S = 900

FACTS = {
    "first_press": """
assert pressed.converged
assert (np.diff(pressed.reaction_force_N) > 0).all()
assert (np.diff(pressed.film_charge_pC) > 0).all()
assert (np.diff(on_average) > 0).all()
np.testing.assert_allclose(charge_pC.sum(), pressed.film_charge_pC[-1], rtol=1e-6)
np.testing.assert_allclose(pressed.open_circuit_voltage_V * pressed.film_capacitance_pF, pressed.film_charge_pC)
np.testing.assert_allclose(pressed.reaction_force_N[-1], 0.33, rtol=0.03)  # examples/README.md, a finer mesh
np.testing.assert_allclose(pressed.open_circuit_voltage_V[-1], 6.7, rtol=0.06)
""",
    "design_study": """
clamped, free = presses["clamped"], presses["free"]
assert (clamped.reaction_force_N[1:] > free.reaction_force_N[1:]).all()  # what is held is stiffer
assert clamped.open_circuit_voltage_V[4] < free.open_circuit_voltage_V[4]  # at 0.2 mm
assert clamped.open_circuit_voltage_V[6] > free.open_circuit_voltage_V[6]  # at 0.3 mm
assert (table["status"] == "solved").all()
assert best[FORCE] <= LIMIT_N
np.testing.assert_allclose(moduli, 1.0, atol=1e-3)
np.testing.assert_allclose(coefficients, [0.0, 1.0], atol=1e-3)
assert (comparison["change (%)"].abs() < 4.0).all()
assert checked.reaction_force_N[-1] <= LIMIT_N
""",
    "reading_a_verdict": """
(one,) = named.missing_physics
assert one["mechanism"] == "hyperelastic-stiffening"
ratio = one["parameters"]["force_ratio"]
stretch = 1 + TRAVEL_MM / LENGTH_MM
truth = 1 + 0.1 * (stretch**2 + 2 / stretch - 3)
assert abs(truth - 1.405) < 1e-9
assert ratio["low"] < truth < ratio["high"]
assert not agreeing.mismatch
assert unexplained.mismatch and unexplained.content["unexplained"] and not unexplained.missing_physics
first, second = rivals(unexplained)["probability"].nlargest(2)
assert first > 100.0 * second
assert rivals(unexplained)["error_left"].min() > 0.02
""",
}


def test_every_notebook_states_a_fact():
    assert [path.stem for path in NOTEBOOKS] == sorted(FACTS)


@for_each("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_results(path):
    notebook = nbformat.read(path, as_version=nbformat.NO_CONVERT)
    nbformat.validate(notebook)
    assert (notebook.nbformat, notebook.nbformat_minor) == (4, 5)
    assert notebook.metadata.kernelspec.name == "python3"
    assert len({cell.id for cell in notebook.cells}) == len(notebook.cells)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.id for cell in code if cell.outputs or cell.execution_count is not None] == []


@pytest.mark.process
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_finds_what_it_explains(path, tmp_path, monkeypatch):
    for name, value in {
        **ONE_THREAD_VARIABLES,
        "SOFTDOT_CACHE": str(tmp_path / "cache"),
        "PYTHONPATH": str(ROOT),
    }.items():
        monkeypatch.setenv(name, value)
    place = tmp_path / "elsewhere"
    place.mkdir()
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(FACTS[path.stem]))
    NotebookClient(
        notebook, timeout=LONGEST_CELL_S, kernel_name="python3", resources={"metadata": {"path": str(place)}}
    ).execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if "image/png" in str(output)]
    assert len(pictures) >= 3
    assert list(place.iterdir()) == []  # a notebook that is run in examples/ leaves nothing there
