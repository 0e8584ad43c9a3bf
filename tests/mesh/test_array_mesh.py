"""The mesh of an array: exact volumes, conforming, no orphans, symmetric, walls of a grid among the sides."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.array.layout import array_layout
from geometry.array.parameters import Array, Groove
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector
from mesh.array.mesh import array_mesh
from mesh.array.sizing import expected_elements
from mesh.options import MeshOptions
from mesh.symmetry import mirrored_mesh
from mesh.types import face_neighbours, signed_volumes
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import physical_gradients, quadratic
from tests.cases import for_each
from tests.geometry.test_array import ALL, segment

COARSE = MeshOptions(element_size_mm=0.9, contact_element_size_mm=0.4)
GROOVES = (Groove(layer="medium2", width_mm=0.4, depth_mm=0.5), Groove(layer="effector", width_mm=0.3, depth_mm=0.4))
ARRAYS = {
    "effectors of their own": (Array(columns=2, rows=1), {}),
    "blocks": (Array(columns=2, rows=1), {"effector": Effector(shape="block", length_mm=1.2, width_mm=1.0)}),
    "grooves": (Array(columns=2, rows=2, shared=ALL, grooves=GROOVES), {"length_mm": 2.5, "width_mm": 2.5}),
    "islands": (Array(columns=3, rows=1, shared=()), {}),
    "grid": (Array(columns=2, rows=1, grid_layers=("effector", "medium1", "film")), {}),
    "no effector": (Array(columns=2, rows=1, shared=("film",)), {"effector": None}),
    "domes": (Array(columns=2, rows=1), {"effector": Effector(shape="dome", diameter_mm=1.6, height_mm=0.5)}),
    "cylinders": (Array(columns=2, rows=1), {"effector": Effector(shape="cylinder", diameter_mm=1.6)}),
}
ROUND = {"domes": 2 * np.pi * 0.5 * (3 * 0.8**2 + 0.5**2) / 6, "cylinders": 2 * np.pi * 0.8**2}


def mesh_of(name, planes=()):
    array, changes = ARRAYS[name]
    one = array_layout(array, segment(**changes), Dot())
    return one, array_mesh(one, resolve_dot(Dot(), one.whole), COARSE, planes)


VOLUMES = {  # length x width x height, by hand
    "effectors of their own": {"effector": 2 * 2.3**2, "medium1": 4.8 * 2.3 * 0.5, "film": 4.8 * 2.3 * 0.028},
    "blocks": {"effector": 2 * 1.2 * 1.0, "medium2": 4.8 * 2.3 * 2.0},
    "grooves": {
        "effector": 25.0 - 0.4 * (2 * 0.3 * 5.0 - 0.3**2),
        "medium2": 50.0 - 0.5 * (2 * 0.4 * 5.0 - 0.4**2),
        "medium1": 12.5,
    },
    "islands": {"effector": 3 * 2.3**2, "film": 3 * 2.3**2 * 0.028, "medium2": 3 * 2.3**2 * 2.0},
    "grid": {"effector": 2 * 2.3**2, "film": 2 * 2.3**2 * 0.028, "medium2": 4.8 * 2.3 * 2.0},
    "no effector": {"medium1": 2 * 2.3**2 * 0.5, "film": 4.8 * 2.3 * 0.028, "medium2": 2 * 2.3**2 * 2.0},
}


@for_each("name", VOLUMES)
def test_parts_have_their_exact_volume(name):
    _, found = mesh_of(name)
    volume = signed_volumes(found.points_mm, found.tets[:, :4])
    assert volume.min() > 0.0
    for part, expected in VOLUMES[name].items():
        assert volume[found.region_tets(part)].sum() == pytest.approx(expected, rel=1e-9)


@for_each("name", ROUND)
def test_round_effectors_have_their_volume_and_skin(name):
    """Curved elements: within 0.5 %, and every node of the skin on a sphere or cylinder around its segment."""
    one, found = mesh_of(name)
    _, slope = quadratic(tetrahedron()[0])
    _, weight = physical_gradients(found.points_mm[found.tets[found.region_tets("effector")]], slope, tetrahedron()[1])
    assert weight.min() > 0.0
    assert weight.sum() == pytest.approx(ROUND[name], rel=5e-3)
    facets = found.facets["contact"]
    above = facets[(found.points_mm[facets][..., 2] > 2.6).any(axis=1)]
    skin = found.points_mm[np.unique(above)]
    middle = np.where(skin[:, 0] > 0.0, one.places[1].x_mm, one.places[0].x_mm)
    beside = np.hypot(skin[:, 0] - middle, skin[:, 1])
    if name == "domes":
        radius = (0.8**2 + 0.5**2) / (2 * 0.5)
        np.testing.assert_allclose(np.hypot(beside, skin[:, 2] - (3.028 - radius)), radius, atol=1e-6)
    else:
        assert (np.isclose(beside, 0.8, atol=1e-6) | np.isclose(skin[:, 2], 3.528)).all()


@pytest.mark.press
@for_each("name", ARRAYS)
def test_no_node_is_an_orphan_and_no_face_has_three_elements(name):
    _, found = mesh_of(name)
    assert (np.unique(found.tets) == np.arange(len(found.points_mm))).all()
    face_neighbours(found.tets[:, :4])  # raises where three share a face


@pytest.mark.press
@for_each("name", ARRAYS)
def test_a_quarter_unfolds_to_the_whole(name):
    """As many elements in each part, and facets of the same names and areas."""
    _, whole = mesh_of(name)
    _, quarter = mesh_of(name, (0, 1))
    images = mirrored_mesh(quarter).tet_mesh
    assert len(images.tets) == len(whole.tets)
    assert {key: len(facets) for key, facets in images.facets.items()} == {
        key: len(facets) for key, facets in whole.facets.items()
    }


def test_walls_of_a_grid_are_sides_and_those_of_islands_are_not():
    """Of film: four walls around each of two segments in the grid; without one the rim alone."""
    one, held = mesh_of("grid")
    _, free = mesh_of("effectors of their own")
    walls = held.points_mm[held.facets["side-film"][:, :3]].mean(axis=1)
    assert (np.abs(np.abs(walls[:, 0]) - 0.1) < 1e-9).any()
    rim = free.points_mm[free.facets["side-effector"][:, :3]].mean(axis=1)
    assert (np.abs(np.abs(rim[:, :2]) - np.array(one.half_mm)) < 1e-9).any(axis=1).all()


def test_the_dot_can_touch_what_faces_up():
    """Effectors and the bare medium 1 between them, no wall and no film."""
    one, found = mesh_of("effectors of their own")
    heights = np.unique(np.round(found.points_mm[found.facets["contact"]][..., 2], 9))
    np.testing.assert_allclose(heights, [2.528, 3.528])
    corner = found.points_mm[found.facets["contact"][:, :3]]
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1).sum()
    assert area == pytest.approx(4 * one.half_mm[0] * one.half_mm[1])


def test_elements_grow_away_from_the_pressed_segment():
    """A row of five, one end pressed: the other end has a fraction of its elements, and about as many as foretold."""
    one = array_layout(Array(columns=5, rows=1), segment(), Dot())
    dot = resolve_dot(Dot(offset_mm=(one.places[0].x_mm, 0.0)), one.whole)
    sizes = MeshOptions(element_size_mm=0.6, contact_element_size_mm=0.15)
    found = array_mesh(one, dot, sizes)
    x = found.points_mm[found.tets[:, :4]].mean(axis=1)[:, 0]
    near, far = (np.abs(x - one.places[k].x_mm) < 1.25 for k in (0, 4))
    assert far.sum() < 0.35 * near.sum()
    assert 0.5 < expected_elements(one, dot, sizes) / len(found.tets) < 2.0


def test_a_gap_below_the_dot_is_not_another_mesh():
    one = array_layout(Array(columns=2, rows=1), segment(), Dot())
    dot = resolve_dot(Dot(), one.whole)
    moved = replace(dot, origin_mm=dot.origin_mm + np.array([0.0, 0.0, 0.2]))
    np.testing.assert_array_equal(array_mesh(one, dot, COARSE).tets, array_mesh(one, moved, COARSE).tets)
