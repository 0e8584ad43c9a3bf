"""Ten-node tetrahedra whose mid-side nodes lie on the true curved surface."""

import numpy as np

from mesh.jacobian import smallest_determinant_ratio
from mesh.linear import LinearMesh
from mesh.surfaces import RoundSurface
from mesh.topology import TET_FACES, boundary_faces, unique_edges
from mesh.types import Floats, Ints

FLATTEST = 0.1  # a curved element keeps at least this share of its mean Jacobian everywhere


def quadratic(linear: LinearMesh, surface: RoundSurface | None) -> tuple[Floats, Ints]:
    """Nodes (n, 3) and tetrahedra (m, 10) in VTK's order.

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


def _skin_edges(linear: LinearMesh, tets: Ints, surface: RoundSurface) -> Ints:
    """Mid-side nodes of the edges of outer facets that lie on the surface."""
    owner, face = boundary_faces(linear.tets)
    facets = tets[owner[:, None], TET_FACES[face]]
    corner = linear.points_mm[facets[:, :3]]
    on_surface = surface.holds(corner.reshape(-1, 3)).reshape(-1, 3).all(axis=1)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.einsum("ij,ij->i", normal, surface.normals(corner.mean(axis=1)))
    return np.unique(facets[on_surface & (along > 0.5)][:, 3:])


def _straighten(points: Floats, tets: Ints, middle: Floats, straight: Floats, curved: Ints) -> None:
    """Undo, in place, the curving of edges whose elements come near to inversion."""
    bent = np.zeros(len(middle), dtype=bool)
    bent[curved] = True
    while True:
        nodes = np.vstack([points, middle])
        touched = np.flatnonzero(bent[tets[:, 4:] - len(points)].any(axis=1))
        bad = touched[smallest_determinant_ratio(nodes[tets[touched]]) < FLATTEST]
        if not len(bad):
            return
        undo = np.unique(tets[bad, 4:] - len(points))
        undo = undo[bent[undo]]
        middle[undo], bent[undo] = straight[undo], False
