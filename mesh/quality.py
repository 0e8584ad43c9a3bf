"""Quality of a mesh: angles, volumes and Jacobians."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats, Ints
from geometry.parameters import Segment
from mesh.jacobian import jacobians, scaled_jacobians, volumes
from mesh.outline import curved_surface, stack_outline
from mesh.symmetry import PLANE_NAMES
from mesh.types import TET_EDGES, TET_FACES, MeshingError, TetMesh, boundary_faces


@dataclass(frozen=True)
class Quality:
    """Quality of a mesh. tetrahedra, nodes : their numbers.

    min_dihedral_deg : over all tetrahedra but the film's; film_min_dihedral_deg : over the film's.
    region_volume_error : relative error of each part's volume against the exact one.
    min_scaled_jacobian : over all tetrahedra but the film's, 1 for a regular tetrahedron.
    inverted : tetrahedra with a Jacobian <= 0 at any sample point.
    straight_edges : skin edges on a curved surface that stayed straight to keep an element valid.
    symmetry_planes : at which a half or a quarter of the segment ends, that stands for the whole.
    """

    tetrahedra: int
    nodes: int
    min_dihedral_deg: float
    film_min_dihedral_deg: float
    region_volume_error: dict[str, float]
    min_scaled_jacobian: float
    inverted: int
    straight_edges: int
    symmetry_planes: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain values for a summary."""
        return asdict(self)


def measure_quality(tet_mesh: TetMesh, segment: Segment) -> Quality:
    """Measure the quality of a mesh of a segment."""
    nodes = tet_mesh.points_mm[tet_mesh.tets]
    film = tet_mesh.region == tet_mesh.region_names.index("film")
    angle = dihedral_angles(nodes[:, :4]).min(axis=1)
    return Quality(
        tetrahedra=len(nodes),
        nodes=len(tet_mesh.points_mm),
        min_dihedral_deg=float(angle[~film].min()),
        film_min_dihedral_deg=float(angle[film].min()),
        region_volume_error=_volume_errors(tet_mesh, nodes, segment),
        min_scaled_jacobian=float(scaled_jacobians(nodes[~film]).min()),
        inverted=int((np.linalg.det(jacobians(nodes)) <= 0).any(axis=1).sum()),
        straight_edges=_straight_edges(tet_mesh, segment),
        symmetry_planes=tuple(PLANE_NAMES[axis] for axis in tet_mesh.planes),
    )


def refuse_inverted(tet_mesh: TetMesh) -> None:
    """Raise MeshingError when an element is inverted."""
    inverted = (np.linalg.det(jacobians(tet_mesh.points_mm[tet_mesh.tets])) <= 0).any(axis=1)
    if inverted.any():
        raise MeshingError(
            f"{inverted.sum()} of {len(inverted)} elements of the mesh are inverted: "
            "change mesh.element_size_mm or mesh.contact_element_size_mm a little"
        )


def dihedral_angles(corners: Floats) -> Floats:
    """Dihedral angles in degrees (m, 6) of straight tetrahedra (m, 4, 3), one per edge."""
    result = np.empty((len(corners), 6))
    for number, (i, j) in enumerate(TET_EDGES):
        k, other = (n for n in range(4) if n not in (i, j))
        along = corners[:, j] - corners[:, i]
        one = np.cross(along, corners[:, k] - corners[:, i])
        two = np.cross(along, corners[:, other] - corners[:, i])
        sine = np.linalg.norm(np.cross(one, two), axis=1)
        result[:, number] = np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", one, two)))
    return result


def _volume_errors(tet_mesh: TetMesh, nodes: Floats, segment: Segment) -> dict[str, float]:
    """Part -> relative error of its volume."""
    exact = stack_outline(segment, slice_mm=tet_mesh.thickness_mm, planes=tet_mesh.planes).volumes()
    meshed = np.bincount(tet_mesh.region, weights=volumes(nodes), minlength=len(tet_mesh.region_names))
    return {n: float(meshed[i] / exact[n] - 1) for i, n in enumerate(tet_mesh.region_names)}


def _straight_edges(tet_mesh: TetMesh, segment: Segment) -> int:
    """Number of edges of skin facets on the curved surface whose mid-side node is off it."""
    surface = curved_surface(stack_outline(segment, slice_mm=tet_mesh.thickness_mm))
    if surface is None:
        return 0
    facets = skin_facets(tet_mesh.points_mm, tet_mesh.tets, surface.holds(tet_mesh.points_mm))
    middle = np.unique(facets[:, 3:])
    return int((np.abs(surface.distance(tet_mesh.points_mm[middle])) > 1e-7).sum())


def skin_facets(points_mm: Floats, tets: Ints, on_surface: NDArray[np.bool_]) -> Ints:
    """Outer facets (k, 6) whose three corners lie on the surface and that are not flat lids."""
    owner, face = boundary_faces(tets)
    facets = tets[owner[:, None], TET_FACES[face]]
    facets = facets[on_surface[facets[:, :3]].all(axis=1)]
    return np.asarray(facets[np.ptp(points_mm[facets[:, :3], 2], axis=1) > 1e-7])
