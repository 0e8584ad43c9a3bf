"""Element sizes: fine under the dot and on the film, coarse at the base, smooth between."""

import numpy as np
import pytest
from mesh_samples import dot, options, segment

import mesh
from mesh.outline import stack_outline
from mesh.sizing import sizing_field
from mesh.types import TetMesh
from tests.cases import for_each

SIZES = {"element_size_mm": 0.4, "contact_element_size_mm": 0.12}


def edges_mm(tet_mesh: TetMesh, facets: np.ndarray, radius: float) -> np.ndarray:
    """Lengths of the edges of facets whose centroids lie within a radius of the axis."""
    corner = tet_mesh.points_mm[facets[:, :3]]
    near = np.hypot(*corner.mean(axis=1)[:, :2].T) < radius
    return np.linalg.norm(corner[near] - np.roll(corner[near], 1, axis=1), axis=2).ravel()


@pytest.mark.press
@for_each("mesher", ["layered", "pytetwild"])
def test_sizes_are_those_asked_for(mesher: str) -> None:
    of = segment()
    tet_mesh = mesh.build(of, dot(of), options(mesher, film_layers=1, **SIZES))
    contact = edges_mm(tet_mesh, tet_mesh.facets["contact"], 0.6)
    film = edges_mm(tet_mesh, tet_mesh.facets["film-top"], 0.8)
    base = edges_mm(tet_mesh, tet_mesh.facets["base"], 2.0)
    assert np.median(contact) == pytest.approx(0.12, rel=0.35)
    assert np.quantile(contact, 0.95) < 1.7 * 0.12
    assert np.median(film) < 1.35 * np.sqrt(0.4 * 0.12)
    if mesher == "pytetwild":
        assert np.median(base) == pytest.approx(0.4, rel=0.35)
        assert np.median(base) > 2 * np.median(contact)


def test_the_field_grows_smoothly_from_contact_and_film() -> None:
    of = segment()
    stack = stack_outline(of)
    field = sizing_field(stack, dot(of), options("layered", **SIZES))
    rng = np.random.default_rng(2)
    low, high = [-1.25, -1.0, 0.0], [1.25, 1.0, stack.top]
    one = rng.uniform(low, high, (500, 3))
    other = np.clip(one + rng.normal(0, 0.1, (500, 3)), low, high)
    slope = np.abs(field.at(one) - field.at(other)) / np.linalg.norm(one - other, axis=1)
    assert slope.max() < 0.5  # neighbouring edges differ by less than a factor 1.5
    assert field.at(np.array([[0.0, 0.0, stack.top]]))[0] == pytest.approx(0.12)
    assert field.at(np.array([[0.0, 0.0, 0.0]]))[0] == pytest.approx(0.4)
    # Overlap of a sphere of radius 0.9 mm, 0.3 mm deep: sqrt(2 0.9 0.3) = 0.735 mm.
    assert field.at(np.array([[0.73, 0.0, stack.top]]))[0] == pytest.approx(0.12)


def test_the_fine_spot_follows_the_dot() -> None:
    of = segment()
    stack = stack_outline(of)
    field = sizing_field(stack, dot(of, x_mm=0.9), options("layered", **SIZES))
    left, right = field.at(np.array([[-0.9, 0.0, stack.top], [0.9, 0.0, stack.top]]))
    assert right == pytest.approx(0.12)
    assert left > 2 * right
