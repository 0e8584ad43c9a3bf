"""Mirror symmetry: a half or a quarter of a segment is meshed and stands for the whole.

Planes are named by their axis: 0 is the plane x = 0, 1 the plane y = 0. The side where that coordinate is positive is
meshed. Nodes in a plane belong to both sides.
"""

from dataclasses import dataclass, replace

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from mesh.types import UPSIDE_DOWN, Planes, TetMesh

PLANE_NAMES = ("x = 0", "y = 0")
IN_PLANE_MM = 1e-7
MIRRORED_TET_NODES = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
"""Order of the ten nodes of a reflected tetrahedron in which its volume is positive again."""


def in_plane(points_mm: Floats, axis: int) -> Bools:
    """Whether points (n, 3) lie in the mirror plane of an axis; shape (n,)."""
    return np.asarray(np.abs(points_mm[:, axis]) < IN_PLANE_MM)


@dataclass(frozen=True)
class MirroredMesh:
    """A meshed part with its mirror images, and for each node and tetrahedron that of which it is the image.

    node (n,), tet (m,) : numbers in the part. node_sign (n, 3), tet_sign (m, 3) : -1 for reflected components of a
    vector there.
    """

    tet_mesh: TetMesh
    node: Ints
    node_sign: Floats
    tet: Ints
    tet_sign: Floats

    def tensors(self, values: Floats) -> Floats:
        """Symmetric tensors (m, 3, 3) of all tetrahedra from those of the tetrahedra of the part."""
        return np.asarray(values[self.tet] * self.tet_sign[:, :, None] * self.tet_sign[:, None, :])


def mirrored_mesh(part: TetMesh, axes: Planes | None = None) -> MirroredMesh:
    """The mesh mirrored about the planes of some axes, by default about all of its own. ValueError for another axis.

    Axis by axis the images of nodes, tetrahedra and facets follow what they are images of, in its order; the local
    nodes of a tetrahedron are in the order MIRRORED, those of a facet UPSIDE_DOWN.
    """
    axes = part.planes if axes is None else axes
    if not set(axes) <= set(part.planes):
        raise ValueError(f"axes = {axes}: the mesh ends at the planes of {part.planes}")
    nodes, tets = len(part.points_mm), len(part.tets)
    result = MirroredMesh(part, np.arange(nodes), np.ones((nodes, 3)), np.arange(tets), np.ones((tets, 3)))
    for axis in axes:
        result = _mirror_about(result, axis)
    return result


def _mirror_about(old: MirroredMesh, axis: int) -> MirroredMesh:
    half, sign = old.tet_mesh, np.ones(3)
    sign[axis] = -1.0
    count, new = len(half.points_mm), np.flatnonzero(~in_plane(half.points_mm, axis))
    image = np.arange(count)
    image[new] = count + np.arange(len(new))
    facets = {name: np.vstack([own, image[own][:, UPSIDE_DOWN]]) for name, own in half.facets.items()}
    whole = replace(
        half,
        points_mm=np.vstack([half.points_mm, half.points_mm[new] * sign]),
        tets=np.vstack([half.tets, image[half.tets][:, MIRRORED_TET_NODES]]),
        region=np.tile(half.region, 2),
        facets=facets,
        twin=np.concatenate([half.twin, image[half.twin[new]]]),
        planes=tuple(other for other in half.planes if other != axis),
    )
    return MirroredMesh(
        whole,
        np.concatenate([old.node, old.node[new]]),
        np.vstack([old.node_sign, old.node_sign[new] * sign]),
        np.tile(old.tet, 2),
        np.vstack([old.tet_sign, old.tet_sign * sign]),
    )
