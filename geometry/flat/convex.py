"""Convex polygons: how far apart, and what two of them share."""

from collections.abc import Sequence
from math import hypot

from geometry.flat.pattern import Point


def gap_mm(one: Sequence[Point], other: Sequence[Point]) -> float:
    """Largest separation of two convex polygons along a normal of their edges; negative where they overlap."""
    found = -float("inf")
    for first, second in ((one, other), (other, one)):
        for a, b in zip(first, (*first[1:], first[0]), strict=True):
            length = hypot(b[0] - a[0], b[1] - a[1])
            n = ((b[1] - a[1]) / length, (a[0] - b[0]) / length)
            reach = max(n[0] * p[0] + n[1] * p[1] for p in first)
            found = max(found, min(n[0] * p[0] + n[1] * p[1] for p in second) - reach)
    return found


def shared_area_mm2(one: Sequence[Point], other: Sequence[Point]) -> float:
    """Area common to two convex, counter-clockwise polygons (Sutherland and Hodgman, 1974)."""
    kept = list(one)
    for a, b in zip(other, (*other[1:], other[0]), strict=True):
        kept = _left_of(kept, a, b)
    after = [*kept[1:], *kept[:1]]
    return abs(sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(kept, after, strict=True))) / 2


def _left_of(polygon: list[Point], a: Point, b: Point) -> list[Point]:
    """What of a polygon lies to the left of the line from a to b."""

    def side(p: Point) -> float:
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    kept: list[Point] = []
    for p, q in zip(polygon, [*polygon[1:], *polygon[:1]], strict=True):
        s, t = side(p), side(q)
        if s >= 0.0:
            kept.append(p)
        if s * t < 0.0:
            share = s / (s - t)
            kept.append((p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])))
    return kept
