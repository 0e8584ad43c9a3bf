"""Columns of a slice's nodes moved to places in x at which something begins or ends, such as a delaminated patch."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from foundation.arrays import Floats, Ints
from mesh.types import TET_EDGES, TetMesh

LEAST_COLUMN_SHARE = 0.1
"""Least distance between a moved column and one that stays, as a share of the distance between two columns."""


def mesh_with_columns_at(
    tet_mesh: TetMesh, facets: Ints, places_mm: Sequence[float], kept_mm: Sequence[float]
) -> TetMesh:
    """The mesh of a slice, stretched in x so that corners of facets (k, 6) stand at each of the places.

    kept_mm : where corners stay, as below the sides of an effector. The ends of the facets stay too. A place that is
    nearer to one that stays, or to another place, than elements can be thin takes the corners there.
    """
    points = tet_mesh.points_mm.copy()
    corners, middles = np.unique(tet_mesh.tets[:, :4]), tet_mesh.tets[:, 4:]
    columns = np.unique(np.round(points[facets[:, :3], 0], 9))
    before, after = _column_moves(columns, places_mm, [columns[0], *kept_mm, columns[-1]])
    moved = np.zeros(len(points))
    moved[corners] = np.interp(points[corners, 0], before, after) - points[corners, 0]
    moved[middles] = moved[tet_mesh.tets[:, TET_EDGES]].mean(axis=2)  # edges stay straight, or as curved as they were
    points[:, 0] += moved
    return replace(tet_mesh, points_mm=points)


def _column_moves(columns: Floats, places: Sequence[float], kept: Sequence[float]) -> tuple[Floats, Floats]:
    """Columns in x that stay or move, ascending, and their new places, in mm."""
    goes = {place: place for place in np.round(kept, 9).tolist() if _is_between_ends(columns, place)}
    for place in places:
        width = float(np.diff(columns)[np.clip(np.searchsorted(columns, place) - 1, 0, len(columns) - 2)])
        if (
            not _is_between_ends(columns, place)
            or min(abs(place - there) for there in goes.values()) < LEAST_COLUMN_SHARE * width
        ):
            continue
        below = max(one for one, there in goes.items() if there < place)
        above = min(one for one, there in goes.items() if there > place)
        free = columns[(columns > below) & (columns < above)]
        if len(free):
            goes[float(free[np.abs(free - place).argmin()])] = float(place)
    order = sorted(goes)
    return np.array(order), np.array([goes[one] for one in order])


def _is_between_ends(columns: Floats, place: float) -> bool:
    return bool(columns[0] <= place <= columns[-1])
