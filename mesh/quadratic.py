"""Ten-node tetrahedra whose mid-side nodes lie on the true curved surface, with named quadratic triangles."""

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats, Ints
from geometry.parameters import Segment
from mesh.jacobian import smallest_determinant_ratio
from mesh.options import MeshOptions
from mesh.outline import RoundSkin, StackOutline, curved_surface, stack_outline
from mesh.quality import refuse_inverted
from mesh.slice import node_twins
from mesh.types import TET_FACES, LinearMesh, Planes, TetMesh, boundary_faces, face_neighbours, unique_edges

LEAST_JACOBIAN_RATIO = 0.1  # a curved element keeps at least this share of its mean Jacobian everywhere


def quadratic_nodes_and_tets(linear: LinearMesh, surface: RoundSkin | None) -> tuple[Floats, Ints]:
    """Nodes (n, 3) and ten-node tetrahedra (m, 10), in VTK's order, of a linear mesh.

    The mid-side nodes of the skin's edges on the curved surface are projected onto it; where that would
    nearly invert an element its edges stay straight (mesh.quality counts them).
    """
    edges, of_tet = unique_edges(linear.tets)
    count = len(linear.points_mm)
    tets = np.hstack([linear.tets, count + of_tet])
    straight = linear.points_mm[edges].mean(axis=1)
    if surface is None:
        return np.vstack([linear.points_mm, straight]), tets
    curved = _skin_edges(linear, tets, surface) - count
    middle = straight.copy()
    middle[curved] = surface.project(straight[curved])
    _straighten(linear.points_mm, tets, middle, straight, curved)
    return np.vstack([linear.points_mm, middle]), tets


def _skin_edges(linear: LinearMesh, tets: Ints, surface: RoundSkin) -> Ints:
    """Numbers of the mid-side nodes of outer facets that lie on the surface."""
    owner, face = boundary_faces(linear.tets)
    facets = tets[owner[:, None], TET_FACES[face]]
    corner = linear.points_mm[facets[:, :3]]
    on_surface = surface.holds(corner.reshape(-1, 3)).reshape(-1, 3).all(axis=1)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.einsum("ij,ij->i", normal, surface.normals(corner.mean(axis=1)))
    return np.unique(facets[on_surface & (along > 0.5)][:, 3:])


def _straighten(points: Floats, tets: Ints, middle: Floats, straight: Floats, curved: Ints) -> None:
    """Straighten, in place, curved edges whose elements come near to inversion."""
    bent = np.zeros(len(middle), dtype=bool)
    bent[curved] = True
    while True:
        nodes = np.vstack([points, middle])
        touched = np.flatnonzero(bent[tets[:, 4:] - len(points)].any(axis=1))
        bad = touched[smallest_determinant_ratio(nodes[tets[touched]]) < LEAST_JACOBIAN_RATIO]
        if not len(bad):
            return
        undo = np.unique(tets[bad, 4:] - len(points))
        undo = undo[bent[undo]]
        middle[undo], bent[undo] = straight[undo], False


PLANE_TOLERANCE_MM = 1e-6


def named_facets(
    points_mm: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline
) -> dict[str, Ints]:
    """Facets (k, 6) by name, as in mesh.types.TetMesh."""
    neighbour = face_neighbours(tets[:, :4])
    facets = _outer_facets(points_mm, tets, region, names, stack, neighbour)
    if "film" in names:
        film = names.index("film")
        facets["film-bottom"] = facets_between_parts(tets, region, neighbour, names.index("medium2"), film)
        facets["film-top"] = facets_between_parts(tets, region, neighbour, film, names.index("medium1"))
    return facets


def _outer_facets(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: StackOutline, neighbour: Ints
) -> dict[str, Ints]:
    """Facets of the base, of the sides of each region and of the contact skin, by name."""
    owner, face = np.nonzero(neighbour < 0)
    outer = tets[owner[:, None], TET_FACES[face]]
    corner = points[outer[:, :3]]
    on_base = _on_plane(corner[..., 2], 0.0)
    on_x, on_y = _on_either_plane(corner[..., 0], stack.half_x), _on_either_plane(corner[..., 1], stack.half_y)
    on_side = on_x if stack.is_slice else on_x | on_y
    cut = on_y & stack.is_slice
    for axis in stack.planes:
        cut = cut | _on_plane(corner[..., axis], 0.0)
    result = {"contact": outer[~(on_base | on_side | cut)], "base": outer[on_base]}
    for number, name in enumerate(names):
        mine = outer[on_side & ~on_base & (region[owner] == number)]
        if len(mine):
            result[f"side-{name}"] = mine
    return result


def _on_plane(coordinate: Floats, value: float) -> NDArray[np.bool_]:
    """Whether the three corners of facets have this coordinate (k, 3); shape (k,)."""
    return np.asarray((np.abs(coordinate - value) < PLANE_TOLERANCE_MM).all(axis=1))


def _on_either_plane(coordinate: Floats, half: float) -> NDArray[np.bool_]:
    """Whether facets lie in the plane at plus or at minus half, from the coordinates of their corners (k, 3)."""
    return np.asarray(_on_plane(coordinate, half) | _on_plane(coordinate, -half))


def facets_between_parts(tets: Ints, region: Ints, neighbour: Ints, lower: int, upper: int) -> Ints:
    """Facets (k, 6) between a part and the next above it, normal up."""
    other = np.where(neighbour >= 0, region[neighbour], -1)
    owner, face = np.nonzero((region[:, None] == lower) & (other == upper))
    return np.asarray(tets[owner[:, None], TET_FACES[face]])


def quadratic_mesh(linear: LinearMesh, segment: Segment, options: MeshOptions, planes: Planes = ()) -> TetMesh:
    """The mesh with mid-side nodes, facets and twins. MeshingError when an element is inverted."""
    is_slice = segment.section == "plane-strain"
    thickness_mm = options.contact_element_size_mm if is_slice else segment.width_mm
    stack = stack_outline(segment, slice_mm=thickness_mm, planes=planes)
    points, tets = quadratic_nodes_and_tets(linear, curved_surface(stack))
    twin = node_twins(points) if is_slice else np.arange(len(points), dtype=np.int64)
    facets = named_facets(points, tets, linear.region, linear.region_names, stack)
    result = TetMesh(points, tets, linear.region, linear.region_names, facets, twin, thickness_mm, planes)
    refuse_inverted(result)
    return result
