"""How good a mesh is: angles, volumes and Jacobians.

The Jacobian of curved ten-node tetrahedra at sample points.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.arrays import Floats, Ints
from geometry.parameters import Segment
from mesh.outline import curved_surface, outline
from mesh.symmetry import PLANE_NAMES
from mesh.types import TET_EDGES, TET_FACES, MeshingError, TetMesh, boundary_faces

_INNER = (5 - np.sqrt(5)) / 20
# Corners, mid-sides, centroid and the four points of the rule of degree 2, in barycentric coordinates.
SAMPLES = np.vstack(
    [
        np.eye(4),
        [(np.eye(4)[a] + np.eye(4)[b]) / 2 for a, b in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))],
        np.full((1, 4), 0.25),
        np.full((4, 4), _INNER) + (1 - 4 * _INNER) * np.eye(4),
    ]
)
_GRADIENTS = np.vstack([-np.ones((1, 3)), np.eye(3)])


def shape_gradients(barycentric: Floats) -> Floats:
    """Reference gradients (q, 10, 3) of the quadratic shape functions at points (q, 4)."""
    lam, grad = barycentric[:, :, None], _GRADIENTS[None]
    corner = (4 * lam - 1) * grad
    edges = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    middle = np.stack([4 * (lam[:, a] * grad[:, b] + lam[:, b] * grad[:, a]) for a, b in edges], axis=1)
    return np.asarray(np.concatenate([corner, middle], axis=1))


def jacobians(nodes: Floats, barycentric: Floats = SAMPLES) -> Floats:
    """Jacobian matrices (m, q, 3, 3), columns dx/dxi, of elements with nodes (m, 10, 3)."""
    return np.asarray(np.einsum("mni,qnj->mqij", nodes, shape_gradients(barycentric), optimize=True))


def smallest_determinant_ratio(nodes: Floats) -> Floats:
    """Smallest over mean Jacobian determinant of each element (m,): 1 when straight, <= 0 when inverted."""
    if not len(nodes):
        return np.zeros(0)
    determinant = np.linalg.det(jacobians(nodes))
    mean = np.abs(determinant).mean(axis=1)
    return np.asarray(determinant.min(axis=1) / mean)


def scaled_jacobians(nodes: Floats) -> Floats:
    """Smallest scaled Jacobian of each element (m,): 1 for the regular tetrahedron.

    At each sample the tetrahedron spanned by the local tangents is rated as in P. M. Knupp, Algebraic mesh
    quality metrics (2001), and the Verdict library: sqrt(2) det / largest product of three edges at a corner.
    """
    tangent = np.moveaxis(jacobians(nodes), 3, 2)
    corners = np.concatenate([np.zeros_like(tangent[:, :, :1]), tangent], axis=2)
    length = np.linalg.norm(corners[:, :, :, None] - corners[:, :, None, :], axis=4)
    products = np.stack([np.prod([length[:, :, i, j] for j in range(4) if j != i], axis=0) for i in range(4)], axis=2)
    return np.asarray((np.sqrt(2) * np.linalg.det(tangent) / products.max(axis=2)).min(axis=1))


def volumes(nodes: Floats) -> Floats:
    """Volumes (m,) of curved elements: the determinant is cubic, the rule (Keast, 5 points) of degree 3."""
    points = np.vstack([np.full((1, 4), 0.25), np.full((4, 4), 1 / 6) + np.eye(4) / 3])
    weights = np.array([-4 / 5, *([9 / 20] * 4)]) / 6
    return np.asarray(np.linalg.det(jacobians(nodes, points)) @ weights)


@dataclass(frozen=True)
class Quality:
    """Quality of a mesh.

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


def measure(tet_mesh: TetMesh, segment: Segment) -> Quality:
    """Measure a mesh of a segment."""
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
    """Relative volume error of each part."""
    exact = outline(segment, slice_mm=tet_mesh.thickness_mm, planes=tet_mesh.planes).volumes()
    meshed = np.bincount(tet_mesh.region, weights=volumes(nodes), minlength=len(tet_mesh.region_names))
    return {n: float(meshed[i] / exact[n] - 1) for i, n in enumerate(tet_mesh.region_names)}


def _straight_edges(tet_mesh: TetMesh, segment: Segment) -> int:
    """Edges of skin facets on the curved surface whose mid-side node is off it."""
    surface = curved_surface(outline(segment, slice_mm=tet_mesh.thickness_mm))
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
