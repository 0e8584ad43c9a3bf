"""Jacobians and quality of single elements."""

import numpy as np
import pytest

from mesh.jacobian import scaled_jacobians, smallest_determinant_ratio, volumes
from mesh.quality import dihedral_angles, refuse_inverted
from mesh.types import MeshingError, TetMesh

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
REGULAR = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])[[0, 2, 1, 3]]
CORNER = np.vstack([np.zeros(3), np.eye(3)])


def ten(corners: np.ndarray) -> np.ndarray:
    """A straight ten-node element, shape (1, 10, 3)."""
    return np.vstack([corners, [corners[[a, b]].mean(axis=0) for a, b in EDGES]])[None]


def test_the_regular_tetrahedron_is_perfect() -> None:
    assert abs(scaled_jacobians(ten(REGULAR))[0]) == pytest.approx(1.0)
    np.testing.assert_allclose(dihedral_angles(REGULAR[None]), np.degrees(np.arccos(1 / 3)))


def test_the_corner_of_a_cube_has_its_textbook_angles_and_volume() -> None:
    angles = np.sort(dihedral_angles(CORNER[None])[0])
    np.testing.assert_allclose(angles[:3], np.degrees(np.arctan(np.sqrt(2))))
    np.testing.assert_allclose(angles[3:], 90.0)
    assert volumes(ten(CORNER))[0] == pytest.approx(1 / 6)
    assert smallest_determinant_ratio(ten(CORNER))[0] == pytest.approx(1.0)


def test_volume_of_a_curved_element_is_that_of_its_polynomial_map() -> None:
    nodes = ten(CORNER)
    nodes[0, 6, 0] -= 0.1
    # The middle of edge 0-2 moves: x = X - 0.4 l0 l2 with l0 l2 = (1 - X - Y - Z) Y, so det = 1 + 0.4 Y, and
    # the integrals of 1 and Y over the unit tetrahedron are 1/6 and 1/24.
    assert volumes(nodes)[0] == pytest.approx(1 / 6 + 0.4 / 24, rel=1e-12)


def test_a_node_pushed_through_the_element_is_found_and_refused() -> None:
    nodes = ten(CORNER)
    nodes[0, 4] = [0.5, 0.9, 0.9]
    assert smallest_determinant_ratio(nodes)[0] < 0
    element = TetMesh(nodes[0], np.arange(10)[None], np.zeros(1, dtype=np.int64), ("medium2",), {}, np.arange(10), 1.0)
    with pytest.raises(MeshingError, match="1 of 1 elements of the mesh are inverted"):
        refuse_inverted(element)
