"""The roles of an array's segments, inner, edge or corner, and the segment that stands for each."""

import numpy as np

from geometry.array.layout import ArrayLayout, SegmentPlace

ROLES = ("inner", "edge", "corner")
"""By the number of directions in which a segment is the last of its row or column."""


def role(layout: ArrayLayout, place: SegmentPlace) -> str:
    """Which of ROLES a segment has. In a single row or column the last segments are edges."""
    position = ((place.column, len(layout.centres(0))), (place.row, len(layout.centres(1))))
    return ROLES[sum(count > 1 and at in (1, count) for at, count in position)]


def representatives(layout: ArrayLayout) -> dict[str, int]:
    """Number of the segment nearest to the middle for each role that the array has."""
    found: dict[str, int] = {}
    for number in np.argsort([np.hypot(place.x_mm, place.y_mm) for place in layout.places], kind="stable"):
        found.setdefault(role(layout, layout.places[number]), int(number))
    return {name: found[name] for name in ROLES if name in found}


def middle(layout: ArrayLayout) -> SegmentPlace:
    """The segment nearest to the middle: an inner one where there is one."""
    return layout.places[next(iter(representatives(layout).values()))]
