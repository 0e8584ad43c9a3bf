"""Ribbons of metal: a centre line with a width as cross-sections, and the order in which ribbons turn side by side.

Lengths are in millimetres; u points to the cable, v across it. Several ribbons that turn side by side keep their
order.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot

from geometry.fabrication.part import ROUNDING_MM
from geometry.polygons import Point

CrossSection = tuple[Point, Point]
"""Right and left edge of a ribbon, as seen along its way."""


def ribbon_sections(points: Sequence[Point], width: float) -> list[CrossSection]:
    """Cross-sections at the points of a centre line; mitred where it turns, so that the width stays."""
    ways = [_unit_direction(a, b) for a, b in pairwise(points)]
    before, after = [ways[0], *ways], [*ways, ways[-1]]
    return [_mitre_section(point, a, b, width / 2) for point, a, b in zip(points, before, after, strict=True)]


def _unit_direction(a: Point, b: Point) -> Point:
    length = hypot(b[0] - a[0], b[1] - a[1])
    return ((b[0] - a[0]) / length, (b[1] - a[1]) / length)


def _mitre_section(point: Point, a: Point, b: Point, half: float) -> CrossSection:
    """The cross-section at a point where the direction turns from a to b.

    It has half a width to either side along the bisector of both normals, longer by one over its cosine.
    """
    scale = half / (1.0 + a[0] * b[0] + a[1] * b[1])
    du, dv = scale * (a[1] + b[1]), -scale * (a[0] + b[0])
    return ((point[0] + du, point[1] + dv), (point[0] - du, point[1] - dv))


def quadrilaterals(sections: Sequence[CrossSection]) -> Iterator[tuple[Point, ...]]:
    """Convex pieces between neighbouring cross-sections, counter-clockwise; none where only the width steps."""
    for (right, left), (right_after, left_after) in pairwise(sections):
        forward = [b + d - a - c for a, b, c, d in zip(right, right_after, left, left_after, strict=True)]
        if hypot(*forward) > ROUNDING_MM:
            yield (right, right_after, left_after, left)


def squares(points: Sequence[Point], width: float) -> float:
    """Length over width of a ribbon, by which its resistance counts."""
    return length_mm(points) / width


def length_mm(points: Sequence[Point]) -> float:
    """Length in mm of a centre line."""
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points))


def turning_columns(before: Sequence[float], after: Sequence[float]) -> list[int | None]:
    """Column in which each ribbon turns from its v before to that after; None for one that goes straight on.

    before, after : strictly rising. Of ribbons that fall the lowest turns first, of those that rise the highest:
    what one passes on its way down has turned away already, so that no two cross (river routing of one layer).
    """
    found: list[int | None] = [None] * len(before)
    falling = [k for k, (a, b) in enumerate(zip(before, after, strict=True)) if b < a - ROUNDING_MM]
    rising = [k for k, (a, b) in enumerate(zip(before, after, strict=True)) if b > a + ROUNDING_MM]
    for order in (falling, rising[::-1]):
        for column, number in enumerate(order):
            found[number] = column
    return found


def column_count(before: Sequence[float], after: Sequence[float]) -> int:
    """Number of columns that turning_columns takes."""
    return max((column + 1 for column in turning_columns(before, after) if column is not None), default=0)


def turn_points(
    before: Sequence[float], after: Sequence[float], first_u: float, apart: float
) -> list[tuple[Point, ...]]:
    """The two points of each ribbon's turn, none for one that goes straight on; the first column lies at first_u."""
    return [
        () if column is None else ((first_u + column * apart, a), (first_u + column * apart, b))
        for column, a, b in zip(turning_columns(before, after), before, after, strict=True)
    ]
