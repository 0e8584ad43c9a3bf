"""A segment that is its own mirror image: a quarter of the mesh, and the whole mirrored from it.

A press in the middle is then symmetric to round-off, and a code that can hold symmetry planes solves the same
discrete problem on a quarter of the unknowns.
"""

from pathlib import Path

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.layered import layered_mesh
from mesh.options import MeshOptions
from mesh.quadratic import quadratic_mesh
from mesh.types import TET_FACES, LinearMesh, TetMesh, boundary_faces, orient_tets, signed_volumes, without_unused


def quarter(stack: Segment, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """The part of the layered mesh at x >= 0, y >= 0."""
    whole = layered_mesh(stack, dot, options)
    inside = (whole.points_mm[whole.tets][..., :2] > -1e-9).all(axis=(1, 2))
    part = without_unused(LinearMesh(whole.points_mm, whole.tets[inside], whole.region[inside], whole.region_names))
    volumes = (signed_volumes(mesh.points_mm, mesh.tets).sum() for mesh in (part, whole))
    np.testing.assert_allclose(4 * next(volumes), next(volumes))  # no tetrahedron crosses a plane
    return part


def mirrored(part: LinearMesh, stack: Segment, options: MeshOptions) -> TetMesh:
    """The whole segment from a quarter of it."""
    points, tets, region = part.points_mm, part.tets, part.region
    for axis in (0, 1):
        image = points * np.where(np.arange(3) == axis, -1.0, 1.0)
        points, tets = np.vstack([points, image]), np.vstack([tets, tets + len(points)])
        region = np.tile(region, 2)
    _, first, number = np.unique(np.round(points * 1e7), axis=0, return_index=True, return_inverse=True)
    tets = number.ravel()[tets]
    whole = LinearMesh(points[first], orient_tets(points[first], tets), region, part.region_names)
    return quadratic_mesh(whole, stack, options)


def save_case(path: Path, part: LinearMesh, stack: Segment, **constants: object) -> None:
    """A quarter with its named facets, and constants, for a program that knows nothing of this project."""
    facets = _named(part, stack)
    np.savez(
        path,
        points=part.points_mm,
        tets=part.tets,
        region=part.region,
        region_names=part.region_names,
        held=np.array(stack.held_layers, str),
        facet_names=list(facets),
        **{f"facet:{name}": nodes for name, nodes in facets.items()},
        **constants,
    )


def _named(part: LinearMesh, stack: Segment) -> dict[str, Ints]:
    """Outer facets (k, 3): base, contact, the held sides, and the two planes of symmetry."""
    owner, face = boundary_faces(part.tets)
    outer = part.tets[owner[:, None], TET_FACES[face, :3]]
    corner = part.points_mm[outer]

    def on(axis: int, value: float) -> Floats:
        return (np.abs(corner[..., axis] - value) < 1e-6).all(axis=1)

    side = on(0, stack.length_mm / 2) | on(1, stack.width_mm / 2)
    sides = {f"side-{name}": outer[side & (part.region[owner] == k)] for k, name in enumerate(part.region_names)}
    top = part.points_mm[:, 2].max()
    planes = {"base": on(2, 0.0), "contact": on(2, top), "plane-x": on(0, 0.0), "plane-y": on(1, 0.0)}
    return {**sides, **{name: outer[where] for name, where in planes.items()}}
