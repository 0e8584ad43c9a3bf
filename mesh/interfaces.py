"""The bonded interfaces of a stack, their nodes doubled where a bond or a gap takes the place of a perfect joint."""

from dataclasses import replace

import numpy as np

from foundation.arrays import Bools, Ints
from foundation.errors import InputError
from mesh.types import TET_FACES, UPSIDE_DOWN, TetMesh, face_neighbours, node_mask

# bond -> (part below, part above); the ground below the base is no part
INTERFACES = {
    "bond-base": ("", "medium2"),
    "bond-film-medium2": ("medium2", "film"),
    "bond-medium1-film": ("film", "medium1"),
    "bond-effector-medium1": ("medium1", "effector"),
}


def interface_facets(tet_mesh: TetMesh, name: str) -> Ints:
    """Quadratic facets (k, 6) of the part below the bond, normal up; those of medium 2 for the base.

    An interface that is split already has none left. InputError when the stack lacks the part above.
    """
    below, above = INTERFACES[name]
    if above not in tet_mesh.region_names:
        raise InputError(f"component = '{name}': the segment has no {above}")
    if name == "bond-base":
        return tet_mesh.facets["base"][:, UPSIDE_DOWN]
    lower, upper = tet_mesh.region_names.index(below), tet_mesh.region_names.index(above)
    neighbour = face_neighbours(tet_mesh.tets[:, :4])
    other = np.where(neighbour >= 0, tet_mesh.region[neighbour], -1)
    owner, face = np.nonzero((tet_mesh.region[:, None] == lower) & (other == upper))
    return np.asarray(tet_mesh.tets[owner[:, None], TET_FACES[face]])


def inner_nodes(tet_mesh: TetMesh, facets: Ints, joined: Bools) -> Ints:
    """Nodes of interface facets (k, 6) that no joined facet touches, nor touches a twin of theirs."""
    held = node_mask(len(tet_mesh.points_mm), tet_mesh.twin[facets[joined]].ravel())
    nodes = np.unique(facets)
    return nodes[~held[tet_mesh.twin[nodes]]]


def split_interface(tet_mesh: TetMesh, name: str, joined: Bools | None = None) -> tuple[TetMesh, Ints, Ints]:
    """Double the nodes of an interface for the part above it.

    joined : (k,) facets of interface_facets that stay joined; none does without it. Their nodes stay single, so
    that the rim of a delaminated patch remains closed.
    Returns the mesh and the lower and upper facets (k, 6), normal up, matched node by node. Of bond-base the lower
    nodes are -1, the ground, and only joined facets remain in facets["base"], which holds them still.
    """
    facets = interface_facets(tet_mesh, name)
    joined = np.zeros(len(facets), bool) if joined is None else joined
    if name == "bond-base":
        named = {**tet_mesh.facets, "base": tet_mesh.facets["base"][joined]}
        return replace(tet_mesh, facets=named), np.full_like(facets, -1), facets
    above = INTERFACES[name][1]
    count, doubled = len(tet_mesh.points_mm), inner_nodes(tet_mesh, facets, joined)
    new = np.arange(count)
    new[doubled] = count + np.arange(len(doubled))
    tets = tet_mesh.tets.copy()
    upper_tets = tet_mesh.region_tets(above)
    tets[upper_tets] = new[tets[upper_tets]]
    split = replace(
        tet_mesh,
        points_mm=np.concatenate([tet_mesh.points_mm, tet_mesh.points_mm[doubled]]),
        tets=tets,
        facets={key: _split_facets(tet_mesh, key, above, new) for key in tet_mesh.facets},
        twin=np.concatenate([tet_mesh.twin, new[tet_mesh.twin[doubled]]]),
    )
    return split, facets, new[facets]


def _split_facets(tet_mesh: TetMesh, name: str, above: str, new: Ints) -> Ints:
    """Named facets (k, 6) with the new nodes of the part that they belong to; the film's faces belong to the film."""
    facets = tet_mesh.facets[name]
    if name.startswith("film-") and above != "film":
        return facets
    faces = tet_mesh.tets[tet_mesh.region_tets(above)][:, TET_FACES[:, :3]].reshape(-1, 3)
    count = len(tet_mesh.points_mm)
    mine = np.isin(_triangle_keys(facets[:, :3], count), _triangle_keys(faces, count))
    return np.where(mine[:, None], new[facets], facets)


def _triangle_keys(corners: Ints, count: int) -> Ints:
    """One number (k,) for each triangle (k, 3), whatever the order of its corners; for less than two million nodes."""
    a, b, c = np.sort(corners, axis=1).T
    return np.asarray((a * count + b) * count + c)
