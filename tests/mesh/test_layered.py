"""The deterministic mesher and its parts."""

import numpy as np
import pytest
from mesh_samples import corner_faces, dot, options, segment

import mesh
from foundation.errors import InputError
from mesh.bisection import refine
from mesh.footprint import start_triangulation
from mesh.outline import stack_outline
from mesh.sizing import graded_points, graded_points_through
from mesh.types import split_prisms
from tests.cases import for_each


@for_each("section", ["solid", "plane-strain"])
def test_the_same_input_gives_the_same_mesh_bit_for_bit(section: str) -> None:
    of = segment("block", section)
    one, other = (mesh.build(of, dot(of), options("layered")) for _ in range(2))
    assert one.points_mm.tobytes() == other.points_mm.tobytes()
    assert one.tets.tobytes() == other.tets.tobytes()


@for_each("section", ["solid", "plane-strain"])
def test_a_dome_is_refused_in_one_sentence(section: str) -> None:
    of = segment("dome", section)
    with pytest.raises(InputError, match=r"cannot mesh segment\.effector\.shape = dome: use pytetwild"):
        mesh.build(of, dot(of), options("layered"))


def test_prisms_that_share_a_side_agree_on_its_diagonal() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        number = rng.permutation(4)
        lower = number[np.array([[0, 1, 2], [3, 2, 1]])]
        tets = split_prisms(lower, lower + 4)
        _, count = np.unique(corner_faces(tets), axis=0, return_counts=True)
        assert (count == 2).sum() == 6  # two inside each prism, two on the shared side
        assert (count == 1).sum() == 12  # two on each of four free sides, four lids


@for_each("effector", ["none", "block", "cylinder"])
def test_bisection_keeps_the_area_conforms_and_reaches_the_size(effector: str) -> None:
    stack = stack_outline(segment(effector))
    radius = stack.effector_half_x if effector == "cylinder" else None
    fine = refine(start_triangulation(stack, 0.5), lambda xy: 0.1 + 0.3 * np.hypot(*xy.T), radius)
    corner = fine.points[fine.triangles]
    area = _areas(corner)
    assert area.min() > 0
    assert area.sum() == pytest.approx(2.5 * 2.0, rel=1e-12)
    pairs = np.sort(fine.triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    edges, count = np.unique(pairs, axis=0, return_counts=True)
    assert count.max() == 2
    rim = fine.points[edges[count == 1]]
    assert np.linalg.norm(rim[:, 0] - rim[:, 1], axis=1).sum() == pytest.approx(2 * (2.5 + 2.0), rel=1e-12)
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
    assert (longest <= (0.1 + 0.3 * np.hypot(*corner.mean(axis=1).T)) * (1 + 1e-9)).all()
    if effector == "block":
        assert area[fine.part == 1].sum() == pytest.approx(1.2, rel=1e-12)


def _areas(corner: np.ndarray) -> np.ndarray:
    """Signed areas of triangles (m, 3, 2)."""
    return np.linalg.det(np.stack([corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]], axis=1)) / 2


def test_graded_steps_follow_the_size() -> None:
    points = graded_points(0.0, 2.0, lambda z: 0.1 + 0.4 * z)
    steps, middle = np.diff(points), (points[1:] + points[:-1]) / 2
    assert points[0] == 0.0
    assert points[-1] == 2.0
    assert (steps <= 1.05 * (0.1 + 0.4 * middle)).all()
    assert (steps[1:] / steps[:-1] < 1.6).all()
    through = graded_points_through([-1.0, 0.3, 1.0], lambda z: np.full_like(z, 0.25))
    assert 0.3 in through
    assert np.diff(through).max() <= 0.25 + 1e-12
