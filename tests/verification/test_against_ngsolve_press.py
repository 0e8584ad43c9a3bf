"""The press of the true segment with a round dot against NGSolve: media, film, charge and curved contact together.

The mesh is shared, so that the error of the elements nearly cancels; element integrals, contact and solver are not.
The codes part in the contact: one pressure for each surface node and exact complementarity here, a linear multiplier
at the corners with an augmented Lagrangian there. NGSolve solves a quarter with symmetry planes, we the whole.
"""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

from mesh.options import MeshOptions
from solve.model import Press
from tests.pressing import press_segment
from tests.solve.segments import cap, materials, segment
from tests.verification.quarter import mirrored, quarter, save_case
from tests.verification.row import agrees

pytestmark = [
    pytest.mark.press,
    pytest.mark.skipif(importlib.util.find_spec("ngsolve") is None, reason="ngsolve is not installed"),
    pytest.mark.skipif(importlib.util.find_spec("pypardiso") is None, reason="NGSolve borrows MKL's PARDISO"),
]
PROGRAM = Path(__file__).with_name("ngsolve_press.py")
DEPTH_MM, STEPS = 0.3, 4
AUGMENTATION_MPA_PER_MM = 20.0  # a quarter of it moves the force by 0.05 %, the voltage by 0.2 %
MESHES = {
    "coarse": MeshOptions(
        mesher="layered", contact_element_size_mm=0.15, element_size_mm=0.6, film_element_size_mm=0.5
    ),
    "fine": MeshOptions(mesher="layered", contact_element_size_mm=0.12, element_size_mm=0.5, film_element_size_mm=0.45),
}


def by_ngsolve(part, stack, dot, path):
    """History of the whole segment from a process of its own: {depth in um: (force N, voltage V)}."""
    save_case(
        path,
        part,
        stack,
        depth=DEPTH_MM,
        steps=STEPS,
        radius=dot.radius_mm,
        augmentation=AUGMENTATION_MPA_PER_MM,
        media=["effector", "medium1", "medium2"],
        moduli=[1.0, 5.0, 1.0],
        film_thickness=0.028,
    )
    done = subprocess.run([sys.executable, PROGRAM, path], capture_output=True, encoding="utf-8", check=True)
    history = json.loads(done.stdout.splitlines()[-1])["history"]
    return {round(1e3 * at["depth_mm"]): (4.0 * at["force_N"], at["voltage_V"]) for at in history}


@pytest.mark.parametrize("mesh", ["coarse", pytest.param("fine", marks=pytest.mark.evidence)])
def test_press_with_a_round_dot(mesh, tmp_path):
    """Force and voltage within 1 % at 0.15 and 0.3 mm."""
    options = MESHES[mesh]
    stack = segment(boundary="clamped")
    dot = cap(stack)
    part = quarter(stack, dot, options)
    theirs = by_ngsolve(part, stack, dot, tmp_path / "case.npz")
    press = Press(indentation_mm=DEPTH_MM, load_steps=STEPS)
    result = press_segment(stack, materials(), dot, press, mirrored(part, stack, options))
    assert result.converged, result.failure
    for step in (result.steps[2], result.steps[4]):
        depth_um = round(1e6 * step.indentation_m)
        force_N, voltage_V = theirs[depth_um]
        agrees(f"round dot, {depth_um} um, force (N)", step.reaction_force_N, force_N, 0.01)
        agrees(f"round dot, {depth_um} um, voltage (V)", float(step.open_circuit_voltage_V[0]), voltage_V, 0.01)
