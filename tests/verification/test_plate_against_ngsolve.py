"""A press with a flat plate against NGSolve on the same mesh: solids, film, charge and contact force together.

Both codes then hold the same discrete problem and differ by quadrature only: both are given a rule of higher degree
(on these coarse elements our default of degree 3 is worth 0.02 % of voltage), and must agree to 1e-6.
"""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from geometry.dot import DotShape
from geometry.stack import layers
from mesh.build import build
from mesh.options import MeshOptions
from solve.fem.quadrature import tetrahedron
from solve.model import Press
from tests.pressing import press_segment
from tests.solve.segments import materials, segment

pytestmark = [
    pytest.mark.press,
    pytest.mark.skipif(importlib.util.find_spec("ngsolve") is None, reason="ngsolve is not installed"),
]
COARSE = MeshOptions(mesher="layered", element_size_mm=0.9, contact_element_size_mm=0.45)
DEPTH_MM = 0.1
PROGRAM = Path(__file__).with_name("ngsolve_plate.py")


def by_ngsolve(tet_mesh, held, path):
    """Force (N) and voltage (V) from a process of its own."""
    names = [name for name in tet_mesh.facets if not name.startswith("film-")]
    facets = {f"facet:{name}": tet_mesh.facets[name][:, :3] for name in names}
    np.savez(
        path,
        points=tet_mesh.points_mm,
        tets=tet_mesh.tets[:, :4],
        region=tet_mesh.region,
        region_names=tet_mesh.region_names,
        facet_names=names,
        held=np.array(held, str),
        depth=DEPTH_MM,
        media=["effector", "medium1", "medium2"],
        moduli=[1.0, 5.0, 1.0],
        film_thickness=0.028,
        **facets,
    )
    done = subprocess.run([sys.executable, PROGRAM, path], capture_output=True, encoding="utf-8", check=True)
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize("held", [(), ("medium1", "film")], ids=["free", "film held"])
def test_plate(held, tmp_path, monkeypatch):
    for module in ("terms.solid", "terms.film", "fields"):
        monkeypatch.setattr(f"solve.{module}.tetrahedron", lambda: tetrahedron(5))
    stack = segment(boundary="clamped", held_layers=held) if held else segment(boundary="free")
    top = np.array([0.0, 0.0, layers(stack)[-1].top_mm])
    plate = DotShape("plate", 1.0, 0.0, np.zeros((1, 3)), top, np.eye(3))
    tet_mesh = build(stack, plate, COARSE)
    result = press_segment(stack, materials(), plate, Press(indentation_mm=DEPTH_MM, load_steps=1), tet_mesh)
    ours = result.steps[-1]
    assert np.abs(ours.fields.gap_m).max() < 1e-9  # the whole top touches
    force_N, voltage_V = by_ngsolve(tet_mesh, held, tmp_path / "case.npz")
    assert ours.reaction_force_N == pytest.approx(force_N, rel=1e-6)
    assert float(ours.open_circuit_voltage_V[0]) == pytest.approx(voltage_V, rel=1e-6)
