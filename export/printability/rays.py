"""Straight rays through a surface: where does each of them meet it first?"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
OFF_THE_SURFACE_MM = 1e-4
"""Rays start this far from their point, so that they do not meet the facet that they leave."""


class Rays:
    """VTK's static cell locator over the triangles of a trimesh.Trimesh."""

    def __init__(self, surface: Any) -> None:
        import pyvista
        from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

        self._grid = pyvista.wrap(surface)
        self._locator = vtkStaticCellLocator()
        self._locator.SetDataSet(self._grid)
        self._locator.BuildLocator()

    def first_hits(self, points: Floats, directions: Floats, reach_mm: float) -> tuple[Floats, Ints]:
        """Distance (n,) from each point (n, 3) along its unit direction (n, 3) and the triangle met (n,).

        Infinite and -1 where nothing is met within reach_mm.
        """
        from vtkmodules.vtkCommonCore import mutable

        distance = np.full(len(points), np.inf)
        face = np.full(len(points), -1)
        # VTK writes its answer into these; its stubs know plain numbers only
        where: Any = mutable(0.0)
        cell: Any = mutable(0)
        sub: Any = mutable(0)
        at, local = [0.0] * 3, [0.0] * 3
        starts = points + OFF_THE_SURFACE_MM * directions
        ends = points + reach_mm * directions
        for k, (start, end) in enumerate(zip(starts.tolist(), ends.tolist(), strict=True)):
            if self._locator.IntersectWithLine(start, end, 1e-9, where, at, local, sub, cell):
                distance[k] = OFF_THE_SURFACE_MM + float(where) * (reach_mm - OFF_THE_SURFACE_MM)
                face[k] = int(cell)
        return distance, face
