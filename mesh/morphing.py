"""A mesh moved to a segment of slightly other sizes."""

from dataclasses import replace

import numpy as np

from geometry.parameters import Segment
from geometry.stack import layers
from mesh.types import TetMesh


def morphed_mesh(tet_mesh: TetMesh, old: Segment, new: Segment) -> TetMesh:
    """The mesh with nodes moved linearly within each layer and with length and width; for small changes of the sizes.

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
