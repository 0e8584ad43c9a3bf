"""Kerf compensation: where the middle of the cut runs so that the part comes out at its size."""

from dataclasses import replace
from math import hypot

from geometry.flat.pattern import Circle, FlatPattern, Outline, Point


def compensated(pattern: FlatPattern) -> FlatPattern:
    """The pattern with its cut lines moved by half a kerf into the waste; marks stay."""
    half = pattern.kerf_mm / 2
    return replace(pattern, cuts=tuple(_moved(cut, half) for cut in pattern.cuts))


def _moved(cut: Outline | Circle, distance: float) -> Outline | Circle:
    """Outer lines grow, holes shrink."""
    outwards = -distance if cut.hole else distance
    if isinstance(cut, Circle):
        return replace(cut, radius=cut.radius + outwards)
    return replace(cut, points=offset(cut.points, outwards))


def offset(points: tuple[Point, ...], distance: float) -> tuple[Point, ...]:
    """A counter-clockwise polygon with every edge moved outwards by the distance; corners stay sharp.

    For distances below the lengths of the edges.
    """
    before, after = (points[-1], *points[:-1]), (*points[1:], points[0])
    return tuple(_corner(a, b, c, distance) for a, b, c in zip(before, points, after, strict=True))


def _corner(a: Point, b: Point, c: Point, distance: float) -> Point:
    """b moved along the bisector: b + d (n1 + n2) / (1 + n1 . n2), with the outward normals of both edges."""
    n1, n2 = _normal(a, b), _normal(b, c)
    scale = distance / (1.0 + n1[0] * n2[0] + n1[1] * n2[1])
    return (b[0] + scale * (n1[0] + n2[0]), b[1] + scale * (n1[1] + n2[1]))


def _normal(a: Point, b: Point) -> Point:
    """Unit normal to the right of the way from a to b: outwards, where the polygon runs counter-clockwise."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = hypot(dx, dy)
    return (dy / length, -dx / length)
