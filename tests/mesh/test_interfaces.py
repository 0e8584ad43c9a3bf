"""Interfaces split by name: the parts share no node but at a rim, and every named facet stays with its own part."""

import numpy as np
import pytest
from mesh_samples import built, corner_faces, facet_area

from foundation.errors import InputError
from mesh.interfaces import INTERFACES, inner_nodes, interface_facets, split_interface
from mesh.types import TET_FACES, TetMesh
from tests.cases import for_each

SAMPLES = ["cylinder solid layered", "block plane-strain layered"]
FOOT = {"cylinder solid layered": np.pi * 0.75**2, "block plane-strain layered": 1.2 * 0.2}
INNER = [name for name in INTERFACES if name != "bond-base"]


def faces(tet_mesh: TetMesh, *regions: str) -> np.ndarray:
    """Faces (k, 6) of some regions."""
    index = np.concatenate([tet_mesh.region_tets(name) for name in regions])
    return tet_mesh.tets[index][:, TET_FACES].reshape(-1, 6)


def belong(facets: np.ndarray, to: np.ndarray) -> bool:
    """Whether each facet has the nodes of one of the faces, in whatever order."""
    rows = np.sort(np.concatenate([facets, to]), axis=1)
    _, kind = np.unique(rows, axis=0, return_inverse=True)
    return bool(np.isin(kind.ravel()[: len(facets)], kind.ravel()[len(facets) :]).all())


def split_all(tet_mesh: TetMesh, names) -> TetMesh:
    for name in names:
        tet_mesh = split_interface(tet_mesh, name)[0]
    return tet_mesh


def in_a_disc(tet_mesh: TetMesh, facets: np.ndarray, radius_mm: float = 0.5) -> np.ndarray:
    """Facets near the middle of the interface: of a slice whole rectangles."""
    corners = tet_mesh.points_mm[facets[:, :3], :2]
    if (tet_mesh.twin != np.arange(len(tet_mesh.twin))).any():
        return np.abs(corners[..., 0].max(axis=1) + corners[..., 0].min(axis=1)) / 2 < radius_mm
    return np.linalg.norm(corners.mean(axis=1), axis=1) < radius_mm


@for_each("sample", SAMPLES)
@for_each("name", INTERFACES)
def test_an_interface_covers_the_foot_of_the_part_above_and_faces_up(sample, name):
    tet_mesh = built(sample)
    facets = interface_facets(tet_mesh, name)
    a, b, c = np.moveaxis(tet_mesh.points_mm[facets[:, :3]], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()
    whole = 2.5 * tet_mesh.thickness_mm
    expected = FOOT[sample] if name == "bond-effector-medium1" else whole
    assert facet_area(tet_mesh.points_mm, facets) == pytest.approx(expected, rel=0.05)


@for_each("sample", SAMPLES)
@for_each("name", INNER)
def test_a_split_interface_joins_nothing_and_its_faces_match(sample, name):
    tet_mesh, (below, above) = built(sample), INTERFACES[name]
    split, lower, upper = split_interface(tet_mesh, name)
    np.testing.assert_array_equal(split.points_mm[lower], split.points_mm[upper])
    assert belong(lower, faces(split, below))
    assert belong(upper[:, [0, 2, 1, 5, 4, 3]], faces(split, above))
    ends = [np.unique(split.tets[split.region_tets(part)]) for part in (below, above)]
    assert not len(np.intersect1d(*ends))
    assert not len(interface_facets(split, name))
    np.testing.assert_array_equal(split.points_mm[split.tets], tet_mesh.points_mm[tet_mesh.tets])


@for_each("sample", SAMPLES)
@for_each("order", [1, -1], ids=["upwards", "downwards"])
def test_named_facets_stay_with_their_part_when_all_interfaces_are_split(sample, order):
    tet_mesh = built(sample)
    split = split_all(tet_mesh, INNER[::order])
    assert split.facets.keys() == tet_mesh.facets.keys()
    for name in ("film-bottom", "film-top"):
        turned = split.facets[name][:, [0, 2, 1, 5, 4, 3]] if name == "film-bottom" else split.facets[name]
        assert belong(turned, faces(split, "film"))
    for name in (name for name in split.facets if name.startswith("side-")):
        assert belong(split.facets[name], faces(split, name.removeprefix("side-")))
    assert belong(split.facets["contact"], faces(split, "effector", "medium1"))
    assert belong(split.facets["base"], faces(split, "medium2"))
    for name, facets in split.facets.items():
        np.testing.assert_array_equal(split.points_mm[facets], tet_mesh.points_mm[tet_mesh.facets[name]])


def test_a_slice_stays_free_of_y_in_every_part():
    """Nodes of one part share a twin just where they share x and z; nodes of two parts never do."""
    split = split_all(built("block plane-strain layered"), INNER)
    twins = []
    for part in split.region_names:
        nodes = np.unique(split.tets[split.region_tets(part)])
        _, place = np.unique(np.round(split.points_mm[nodes][:, [0, 2]], 7), axis=0, return_inverse=True)
        pairs = np.unique(np.column_stack([place.ravel(), split.twin[nodes]]), axis=0)
        assert len(pairs) == len(np.unique(place)) == len(np.unique(split.twin[nodes]))
        twins.append(np.unique(split.twin[nodes]))
    assert len(np.unique(np.concatenate(twins))) == sum(map(len, twins))


@for_each("sample", SAMPLES)
@for_each("name", ["bond-film-medium2", "bond-medium1-film"])
def test_a_patch_doubles_the_nodes_inside_and_leaves_its_rim_joined(sample, name):
    tet_mesh = built(sample)
    facets = interface_facets(tet_mesh, name)
    joined = ~in_a_disc(tet_mesh, facets)
    split, lower, upper = split_interface(tet_mesh, name, joined)
    np.testing.assert_array_equal(lower[joined], upper[joined])
    apart = np.unique(lower[lower != upper])
    rim = np.intersect1d(tet_mesh.twin[facets[joined]], tet_mesh.twin[facets[~joined]])
    assert len(rim)
    assert not len(np.intersect1d(tet_mesh.twin[apart], rim))
    inside = np.setdiff1d(tet_mesh.twin[facets[~joined]], rim)
    np.testing.assert_array_equal(np.unique(tet_mesh.twin[apart]), inside)
    assert len(split.points_mm) == len(tet_mesh.points_mm) + len(apart)


def test_a_patch_of_one_facet_opens_nowhere():
    tet_mesh = built("cylinder solid layered")
    facets = interface_facets(tet_mesh, "bond-film-medium2")
    corners = tet_mesh.points_mm[facets[:, :3], :2].mean(axis=1)
    one = np.arange(len(facets)) == np.argmin(np.linalg.norm(corners, axis=1))
    assert not len(inner_nodes(tet_mesh, facets, ~one))


def test_the_base_lets_go_of_the_ground_where_it_is_not_joined():
    tet_mesh = built("cylinder solid layered")
    joined = ~in_a_disc(tet_mesh, interface_facets(tet_mesh, "bond-base"))
    split, lower, upper = split_interface(tet_mesh, "bond-base", joined)
    assert (lower == -1).all()
    np.testing.assert_array_equal(np.sort(split.facets["base"], axis=1), np.sort(upper[joined], axis=1))
    np.testing.assert_array_equal(split.tets, tet_mesh.tets)
    assert not len(split_interface(tet_mesh, "bond-base")[0].facets["base"])


def test_a_stack_without_effector_has_no_bond_below_one():
    with pytest.raises(InputError, match=r"bond-effector-medium1.*no effector"):
        interface_facets(built("none solid layered"), "bond-effector-medium1")


def test_splitting_cuts_no_element_from_its_part():
    """Parts keep all their inner faces: only the interface's faces turn into outer ones."""
    tet_mesh = built("cylinder solid layered")
    split, lower, _ = split_interface(tet_mesh, "bond-film-medium2")

    def outer(tets):
        return (np.unique(corner_faces(tets), axis=0, return_counts=True)[1] == 1).sum()

    assert outer(split.tets) == outer(tet_mesh.tets) + 2 * len(lower)
