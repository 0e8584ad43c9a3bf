"""The mesh that passes from the mesher to the solver and to the exporters."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class TetMesh:
    """One conforming mesh of quadratic tetrahedra, labelled by part.

    points_mm : (n, 3) float. Corner nodes and mid-side nodes.
    tets : (m, 10) int. VTK order of the quadratic tetrahedron (type 24):
        corners 0-3, then mid-sides of edges 01, 12, 02, 03, 13, 23. Positive volume.
    region : (m,) int. Index into region_names.
    region_names : names of the parts that exist, e.g. ("medium2", "film", "medium1", "effector").
    facets : name -> (k, 6) int. Quadratic triangles (VTK type 22: corners, then mid-sides 01, 12, 20),
        normal pointing out of the solid (for film facets: up). Names:
        "contact"  outer surface that the dot can touch (effector skin but its sides, bare top of medium 1)
        "base"     bottom of medium 2
        "side-<region>"  the x faces (and the y faces when solid) of that region, where it has one
        "film-bottom", "film-top"  the two faces of the film
    twin : (n,) int. For each node the node that stands for it: itself, except in a plane-strain slice, where
        all nodes of equal (x, z) share one, so that nothing varies over y.
    thickness_mm : size in y of what is meshed (the slice's thickness when plane strain, else width_mm).
    """

    points_mm: Floats
    tets: Ints
    region: Ints
    region_names: tuple[str, ...]
    facets: dict[str, Ints]
    twin: Ints
    thickness_mm: float

    def region_tets(self, name: str) -> Ints:
        """Indices of the tetrahedra of one part, shape (k,)."""
        return np.flatnonzero(self.region == self.region_names.index(name))
