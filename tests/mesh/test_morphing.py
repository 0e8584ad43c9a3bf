"""The map that moves a mesh to other sizes: moving twice is moving once, and surfaces stay what they are."""

import numpy as np

from geometry.parameters import Effector
from mesh.morphing import morphed_mesh
from mesh.outline import stack_outline
from mesh.types import TetMesh
from tests.cases import for_each
from tests.solve.segments import segment

FEET = {
    "layer": [{"height_mm": one} for one in (1.0, 0.8, 1.3)],
    "block": [{"length_mm": a, "width_mm": 1.6, "height_mm": h} for a, h in ((1.4, 1.0), (1.8, 0.8), (1.1, 1.2))],
    "cylinder": [{"diameter_mm": a, "height_mm": h} for a, h in ((1.4, 1.0), (1.8, 0.8), (1.1, 1.2))],
    "dome": [{"diameter_mm": a, "height_mm": h} for a, h in ((1.6, 0.6), (1.8, 0.5), (1.3, 0.64))],
}


def cloud(stack):
    """A mesh that has nodes alone: within the layers, within the effector, and on its rim and its skin."""
    random, outline = np.random.default_rng(1), stack_outline(stack)
    low = random.uniform([-1.25, -1.25, 0.0], [1.25, 1.25, outline.medium1_top], (300, 3))
    around, out = random.uniform(0.0, 2.0 * np.pi, 200), np.sqrt(random.uniform(0.0, 1.0, 200))
    out[:20] = 1.0
    radius = out * outline.effector_half_x
    skin = np.full(200, outline.top)
    if outline.shape == "dome":
        skin = outline.dome_centre_z + np.sqrt(outline.dome_radius**2 - radius**2)
    share = random.uniform(0.0, 1.0, 200)
    share[:100] = 1.0
    height = outline.medium1_top + share * (skin - outline.medium1_top)
    high = np.column_stack([radius * np.cos(around), radius * np.sin(around), height])
    points, none = np.vstack([low, high]), np.zeros((0, 10), dtype=np.int64)
    return TetMesh(points, none, none[:, 0], ("medium2",), {}, np.arange(len(points)), 2.5)


@for_each("shape", FEET)
def test_moving_twice_is_moving_once_and_a_skin_stays_a_skin(shape):
    one, two, three = (
        segment(effector=Effector(shape=shape, **foot), length_mm=length, width_mm=2.5)
        for foot, length in zip(FEET[shape], (2.5, 2.9, 2.2), strict=True)
    )
    mesh = cloud(one)
    there = morphed_mesh(mesh, one, two)
    np.testing.assert_allclose(
        morphed_mesh(there, two, three).points_mm, morphed_mesh(mesh, one, three).points_mm, atol=1e-12
    )
    np.testing.assert_allclose(morphed_mesh(there, two, one).points_mm, mesh.points_mm, atol=1e-12)
    outline, skin, rim = stack_outline(two), there.points_mm[300:400], there.points_mm[300:320]
    if shape == "dome":
        away = np.linalg.norm(skin - [0.0, 0.0, outline.dome_centre_z], axis=1)
        np.testing.assert_allclose(away, outline.dome_radius, atol=1e-9)
    else:
        np.testing.assert_allclose(skin[:, 2], outline.top, atol=1e-12)
    if shape in ("cylinder", "dome"):
        np.testing.assert_allclose(np.hypot(rim[:, 0], rim[:, 1]), outline.effector_half_x, atol=1e-12)
