"""The bonded interfaces of a stack, their nodes doubled where a bond or a gap takes the place of a perfect joint, and
the same mesh moved to a segment of other sizes.

Put the film between medium 2 and medium 1: extrude their interface, in a solid or in the section of a slice.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geometry.arrays import Bools, Floats, Ints
from geometry.base import InputError
from geometry.parameters import Segment
from geometry.stack import layers
from mesh.outline import StackOutline
from mesh.sizing import Sizing, graded_through
from mesh.types import TET_FACES, UPSIDE_DOWN, LinearMesh, TetMesh, face_neighbours, node_mask, oriented, split_prisms

# bond -> (part below, part above); the ground below the base is no part
INTERFACES = {
    "bond-base": ("", "medium2"),
    "bond-film-medium2": ("medium2", "film"),
    "bond-medium1-film": ("film", "medium1"),
    "bond-effector-medium1": ("medium1", "effector"),
}


def interface_facets(tet_mesh: TetMesh, name: str) -> Ints:
    """Quadratic facets (k, 6) of the part below the bond, normal up; of the base those of medium 2.

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
        facets={key: _follow(tet_mesh, key, above, new) for key in tet_mesh.facets},
        twin=np.concatenate([tet_mesh.twin, new[tet_mesh.twin[doubled]]]),
    )
    return split, facets, new[facets]


def _follow(tet_mesh: TetMesh, name: str, above: str, new: Ints) -> Ints:
    """Named facets with the nodes of the part that they belong to; the film's faces belong to the film."""
    facets = tet_mesh.facets[name]
    if name.startswith("film-") and above != "film":
        return facets
    faces = tet_mesh.tets[tet_mesh.region_tets(above)][:, TET_FACES[:, :3]].reshape(-1, 3)
    count = len(tet_mesh.points_mm)
    mine = np.isin(_keys(facets[:, :3], count), _keys(faces, count))
    return np.where(mine[:, None], new[facets], facets)


def _keys(corners: Ints, count: int) -> Ints:
    """One number for each triangle (k, 3), whatever the order of its corners; count below two million nodes."""
    a, b, c = np.sort(corners, axis=1).T
    return np.asarray((a * count + b) * count + c)


def morphed(tet_mesh: TetMesh, old: Segment, new: Segment) -> TetMesh:
    """Nodes moved linearly within each layer and with length and width; for small changes of the sizes.

    ValueError where the layers differ in number.
    """
    before, after = (np.array([0.0, *(layer.top_mm for layer in layers(segment))]) for segment in (old, new))
    if len(before) != len(after):
        raise ValueError("the segments differ in their layers")
    points = tet_mesh.points_mm.copy()
    points[:, 2] = np.interp(points[:, 2], before, after)
    points[:, 0] *= new.length_mm / old.length_mm
    thickness = tet_mesh.thickness_mm
    if old.section == "solid":
        points[:, 1] *= new.width_mm / old.width_mm
        thickness *= new.width_mm / old.width_mm
    return replace(tet_mesh, points_mm=points, thickness_mm=thickness)


@dataclass(frozen=True)
class MeshedSection:
    """points_mm : (n, 2) x and z; triangles : (m, 3); region : (m,) index into region_names."""

    points_mm: Floats
    triangles: Ints
    region: Ints
    region_names: tuple[str, ...]


def structured(
    stack: StackOutline, field: Sizing, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> MeshedSection:
    """A graded grid of x columns and z layers, every rectangle cut by a diagonal that mirrors about x = 0."""
    x = _columns(stack, field)
    points = np.column_stack([np.tile(x, len(heights)), np.repeat(heights, len(x))])
    layer, column = np.divmod(np.arange((len(x) - 1) * (len(heights) - 1)), len(x) - 1)
    middle = (x[column] + x[column + 1]) / 2
    kept = (layer_region[layer] < 3) | (np.abs(middle) < stack.effector_half_x)
    kept &= middle > stack.low[0]
    column, layer, middle = column[kept], layer[kept], middle[kept]
    a = layer * len(x) + column
    b, c, d = a + 1, a + 1 + len(x), a + len(x)
    rising = (middle > 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
    other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
    triangles = np.where(rising, one, other).reshape(-1, 3)
    return MeshedSection(points, triangles, np.repeat(layer_region[layer], 2), names)


def _columns(stack: StackOutline, field: Sizing) -> Floats:
    """x lines through the sides of the effector, as fine as the finest of skin and film at each x."""

    def size(x: Floats) -> Floats:
        at = [np.column_stack([x, np.zeros_like(x), np.full_like(x, z)]) for z in (stack.film_top, stack.top)]
        return np.minimum(field.at(at[0]), field.at(at[1]))

    half, foot = stack.half_x, stack.effector_half_x
    breaks = [-half, 0.0, half]
    if 0.0 < foot < half * (1 - 1e-9):
        breaks = [-half, -foot, 0.0, foot, half]
    return graded_through(breaks, size)


NAMES = ("medium2", "film", "medium1", "effector")


def with_film(bare: LinearMesh, thickness_mm: float, film_layers: int) -> LinearMesh:
    """A mesh of medium2, medium1 (and effector) with the film's layers extruded from the interface."""
    neighbour = face_neighbours(bare.tets)
    lower = bare.region == 0
    owner, face = np.nonzero(lower[:, None] & (neighbour >= 0) & (bare.region[neighbour] == 1))
    facets = bare.tets[owner[:, None], TET_FACES[face, :3]]
    points, levels, moved = _levels(bare.points_mm, bare.tets, lower, np.unique(facets), thickness_mm, film_layers)
    prisms = [split_prisms(levels[i][facets], levels[i + 1][facets]) for i in range(film_layers)]
    tets = np.concatenate([np.where(lower[:, None], bare.tets, moved[bare.tets]), *prisms])
    region = _regions(bare.region, 3 * len(facets) * film_layers)
    return LinearMesh(points, oriented(points, tets), region, _names(bare.region))


def section_with_film(bare: MeshedSection, thickness_mm: float, film_layers: int) -> MeshedSection:
    """Put a film into a slice: interface edges of the x-z section become rectangles, cut in two, mirrored at x = 0."""
    lower = bare.region == 0
    edges = _interface_edges(bare)
    points, levels, moved = _levels(bare.points_mm, bare.triangles, lower, np.unique(edges), thickness_mm, film_layers)
    cells = []
    for i in range(film_layers):
        (a, b), (d, c) = levels[i][edges].T, levels[i + 1][edges].T
        rising = (bare.points_mm[edges, 0].sum(axis=1) > 0)[:, None, None]
        one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
        other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
        cells.append(np.where(rising, one, other).reshape(-1, 3))
    triangles = np.concatenate([np.where(lower[:, None], bare.triangles, moved[bare.triangles]), *cells])
    region = _regions(bare.region, 2 * len(edges) * film_layers)
    return MeshedSection(points, triangles, region, _names(bare.region))


def _levels(
    points: Floats, cells: Ints, lower: NDArray[np.bool_], interface: Ints, thickness: float, film_layers: int
) -> tuple[Floats, list[Ints], Ints]:
    """Raised points with the film's nodes added, node numbers on each level, and those above the film."""
    above = np.setdiff1d(np.unique(cells[~lower]), interface)
    result = points.copy()
    result[above, -1] += thickness
    same = np.arange(len(points), dtype=np.int64)
    levels, added = [same], [result]
    for i in range(1, film_layers + 1):
        level = same.copy()
        level[interface] = len(points) + (i - 1) * len(interface) + np.arange(len(interface))
        copy = points[interface].copy()
        copy[:, -1] += thickness * i / film_layers
        levels.append(level)
        added.append(copy)
    return np.concatenate(added), levels, levels[-1]


def _interface_edges(bare: MeshedSection) -> Ints:
    """Edges (k, 2) between medium 2 and medium 1, from smaller to larger x."""
    pairs = np.sort(bare.triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    low = np.unique(pairs[bare.region == 0].reshape(-1, 2), axis=0)
    high = np.unique(pairs[bare.region == 1].reshape(-1, 2), axis=0)
    both, count = np.unique(np.concatenate([low, high]), axis=0, return_counts=True)
    edges = both[count == 2]
    x = bare.points_mm[edges, 0]
    return np.take_along_axis(edges, np.argsort(x, axis=1), axis=1)


def _regions(bare: Ints, added: int) -> Ints:
    """Regions with the film as number 1."""
    return np.concatenate([np.where(bare > 0, bare + 1, 0), np.full(added, 1, dtype=np.int64)])


def _names(bare: Ints) -> tuple[str, ...]:
    """Names of the parts once the film is in."""
    return NAMES[: int(bare.max()) + 2]
