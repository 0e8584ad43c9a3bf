"""Drawn surfaces have the area, the volume and the fields of the body they show."""

import numpy as np
import pytest
from pressed_box import HEIGHT_MM, LENGTH_MM

from export.nodal_values import largest_principal, nodal_means, split_nodes
from export.skin import NodalSteps, Skin, cut_section, film_top, nearby_plane, nodal_steps, outer_skin
from export.subdivision import tetra_pattern, triangle_pattern
from mesh.types import TetMesh
from solve.result import PressResult
from tests.cases import for_each


@pytest.fixture(scope="module")
def nodes(segment: TetMesh, press: PressResult) -> NodalSteps:
    return nodal_steps(segment, press.steps)


def normals(skin: Skin) -> np.ndarray:
    a, b, c = (skin.points_mm[skin.triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a) / 2


@for_each("level", [0, 1, 2])
def test_patterns_reproduce_a_quadratic_field(level: int) -> None:
    weights, small = triangle_pattern(level)
    x = np.array([0.0, 1.0, 0.0, 0.5, 0.5, 0.0])
    np.testing.assert_allclose(weights @ x**2, (weights @ x) ** 2, atol=1e-14)
    assert len(small) == 4**level
    weights, small = tetra_pattern(level)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    pairs = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    nodes = np.vstack([corners, [corners[list(p)].mean(axis=0) for p in pairs]])
    points = weights @ nodes
    np.testing.assert_allclose(weights @ nodes.prod(axis=1) * 0, 0)
    np.testing.assert_allclose(weights @ (nodes[:, 0] * nodes[:, 1]), points[:, 0] * points[:, 1], atol=1e-14)
    a, b, c, d = (points[small[:, i]] for i in range(4))
    volume = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6
    assert volume.sum() == pytest.approx(1 / 6)
    assert volume.min() > 0


def test_outer_skin_is_closed_and_faces_out(nodes: NodalSteps) -> None:
    skin = outer_skin(nodes)
    area = normals(skin)
    assert np.linalg.norm(area, axis=1).sum() == pytest.approx(2 * LENGTH_MM**2 + 4 * LENGTH_MM * HEIGHT_MM)
    np.testing.assert_allclose(area.sum(axis=0), 0, atol=1e-9)
    centroid = skin.points_mm[skin.triangles].mean(axis=1)
    assert np.einsum("ij,ij->", centroid, area) / 3 == pytest.approx(LENGTH_MM**2 * HEIGHT_MM)


def test_section_has_each_layers_area_and_faces_the_viewer(nodes: NodalSteps, segment: TetMesh) -> None:
    skin = cut_section(nodes, nearby_plane(segment, 0.0))
    area = normals(skin)
    assert (area[:, 1] <= 0).all()
    region = skin.region[skin.triangles[:, 0]]
    for number, thickness in enumerate([2.0, 0.028, 0.5, 1.0]):
        assert -area[region == number, 1].sum() == pytest.approx(LENGTH_MM * thickness, rel=1e-2)


def test_film_top_shows_the_film_only(nodes: NodalSteps, segment: TetMesh, press: PressResult) -> None:
    skin = film_top(nodes, segment)
    assert set(skin.region) == {1}
    np.testing.assert_allclose(skin.points_mm[:, 2], 2.028)
    assert skin.film_strain[3].max() <= press.steps[3].fields.film_strain.max() * 1.0001
    assert skin.film_strain[3].max() > 0.5 * press.steps[3].fields.film_strain.max()
    assert not skin.film_strain[0].any()


def test_a_curved_face_is_drawn_curved() -> None:
    """A mid-side node lifted by s lifts the quarter points by 3/4 s."""
    weights, _ = triangle_pattern(2)
    lift = np.array([0, 0, 0, 1.0, 0, 0])
    assert (weights @ lift).max() == pytest.approx(1.0)
    assert np.isclose(weights @ lift, 0.75).sum() >= 2


def test_spread_keeps_constants_within_a_part(segment: TetMesh) -> None:
    split = split_nodes(segment)
    values = 10.0**segment.region
    np.testing.assert_allclose(nodal_means(split, values), 10.0**split.region)


def test_largest_principal_of_a_rotated_tensor() -> None:
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    tensor = turn @ np.diag([3.0, -2.0, 1.0]) @ turn.T
    voigt = np.array([[tensor[i, j] for i, j in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]]])
    assert largest_principal(voigt)[0] == pytest.approx(3.0)
