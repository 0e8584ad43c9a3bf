"""The triangles of a build123d shape as arrays; its own method makes a Python object of each point."""

from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints


def triangulated(shape: Any, deflection_mm: float, angular_deflection: float) -> tuple[Floats, Ints]:
    """Points (n, 3) in mm and triangles (m, 3), counter-clockwise seen from outside, face by face.

    deflection_mm, angular_deflection : largest distance of a triangle from the true surface, and largest angle in
    radians between neighbours. Points on an edge are those of each of its faces. A shape that holds triangles at least
    as fine keeps them.
    """
    shape.mesh(deflection_mm, angular_deflection)
    points, triangles, count = list[Floats](), list[Ints](), 0
    for face in shape.faces():
        found, corners = _of_face(face.wrapped)
        points.append(found)
        triangles.append(corners + count)
        count += len(found)
    return np.concatenate(points), np.concatenate(triangles)


def _of_face(face: Any) -> tuple[Floats, Ints]:
    """Points and triangles of a TopoDS_Face."""
    from OCP.BRep import BRep_Tool  # type: ignore[import-untyped]
    from OCP.TopAbs import TopAbs_Orientation  # type: ignore[import-untyped]
    from OCP.TopLoc import TopLoc_Location  # type: ignore[import-untyped]

    place = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, place)
    move = place.Transformation()
    nodes = (found.Node(number) for number in range(1, found.NbNodes() + 1))
    moved = nodes if place.IsIdentity() else (node.Transformed(move) for node in nodes)
    points = np.array([node.Coord() for node in moved]).reshape(-1, 3)
    # one by one: to go through found.Triangles() takes ten times as long
    each = (found.Triangle(number).Get() for number in range(1, found.NbTriangles() + 1))
    corners = np.array([*each], dtype=np.int64) - 1
    if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
        corners = corners[:, [0, 2, 1]]
    return points, corners
