"""The whole crosstalk matrix of two segments against NGSolve: film and media run through, effectors do not.

The mesh is shared, element integrals, contact and solver are not (see test_against_ngsolve_press.py). Both codes solve
a half, as the dots stand in the plane y = 0, and the press of the first segment: that of the second is its image.
"""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mesh.types import TET_FACES, boundary_faces
from softdot.arrays.case import ArrayCase
from softdot.arrays.matrix import crosstalk
from softdot.arrays.presses import ArrayPresses
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from tests.verification.row import agrees

pytestmark = [
    pytest.mark.evidence,
    pytest.mark.skipif(importlib.util.find_spec("ngsolve") is None, reason="ngsolve is not installed"),
    pytest.mark.skipif(importlib.util.find_spec("pypardiso") is None, reason="NGSolve borrows MKL's PARDISO"),
]
PROGRAM = Path(__file__).with_name("ngsolve_array.py")
DEPTH_MM, STEPS, THEIR_STEPS = 0.3, 4, 12  # their Newton method has no line search
AUGMENTATION_MPA_PER_MM = 20.0
TABLES = {
    "segment": {"length_mm": 2.3, "width_mm": 2.3, "boundary": "free"},
    "array": {"columns": 2, "rows": 1},
    "press": {"indentation_mm": DEPTH_MM, "load_steps": STEPS},
    "mesh": {"element_size_mm": 0.7, "contact_element_size_mm": 0.2, "film_element_size_mm": 0.45},
}


def by_ngsolve(press, electrodes, path):
    """Force (N) and voltage of both electrodes (V) at full depth, from a process of its own."""
    half = press.solved_mesh
    assert half.planes == (1,)
    owner, face = boundary_faces(half.tets)
    outer = half.tets[owner[:, None], TET_FACES[face, :3]]
    facets = {name: half.facets[name][:, :3] for name in ("base", "contact")}
    facets["plane-y"] = outer[(np.abs(half.points_mm[outer][..., 1]) < 1e-9).all(axis=1)]
    np.savez(
        path,
        points=half.points_mm,
        tets=half.tets[:, :4],
        region=half.region,
        region_names=half.region_names,
        held=np.array([], str),
        facet_names=list(facets),
        **{f"facet:{name}": nodes for name, nodes in facets.items()},
        depth=DEPTH_MM,
        steps=THEIR_STEPS,
        radius=press.dot.radius_mm,
        dot_x=press.dot.origin_mm[0],
        electrodes=electrodes,
        augmentation=AUGMENTATION_MPA_PER_MM,
        media=["effector", "medium1", "medium2"],
        moduli=[1.0, 5.0, 1.0],
        film_thickness=0.028,
    )
    done = subprocess.run([sys.executable, PROGRAM, path], capture_output=True, encoding="utf-8", check=True)
    last = json.loads(done.stdout.splitlines()[-1])["history"][-1]
    return 2.0 * last["force_N"], last["voltage_V"]


def test_matrix_of_two_segments(tmp_path, monkeypatch):
    """Every entry within 2 %, the force within 1 %."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    case = ArrayCase(config_from(with_default_design(TABLES)))
    matrix = crosstalk(case, ArrayPresses())
    electrodes = np.array(case.layout.edges(0))
    force_N, voltages_V = by_ngsolve(case.press_over(case.layout.places[0]), electrodes, tmp_path / "case.npz")
    agrees("array 2 x 1, force (N)", matrix.force_N[0, -1], force_N, 0.01)
    for i, j in np.ndindex(2, 2):
        agrees(f"array 2 x 1, voltage [{i}][{j}] (V)", matrix.voltage_V[i, -1, j], voltages_V[(i + j) % 2], 0.02)
