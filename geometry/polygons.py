"""Plane polygons in mm: distances, common areas, areas, convex pieces."""

from collections.abc import Iterator, Sequence
from math import hypot

Point = tuple[float, float]


def polygon_gap_mm(one: Sequence[Point], other: Sequence[Point]) -> float:
    """Distance in mm of two convex polygons.

    Where they touch or overlap it is their separation along a normal, zero or negative.
    """
    apart = _separation(one, other)
    if apart <= 0.0:
        return apart
    pairs = ((one, other), (other, one))
    return min(_distance_to_segment(p, a, b) for first, second in pairs for p in first for a, b in _edges(second))


def _edges(polygon: Sequence[Point]) -> Iterator[tuple[Point, Point]]:
    return zip(polygon, (*polygon[1:], polygon[0]), strict=True)


def _separation(one: Sequence[Point], other: Sequence[Point]) -> float:
    """Largest separation of two convex polygons along a normal of their edges; negative where they overlap."""
    found = -float("inf")
    for first, second in ((one, other), (other, one)):
        for a, b in _edges(first):
            length = hypot(b[0] - a[0], b[1] - a[1])
            n = ((b[1] - a[1]) / length, (a[0] - b[0]) / length)
            reach = max(n[0] * p[0] + n[1] * p[1] for p in first)
            found = max(found, min(n[0] * p[0] + n[1] * p[1] for p in second) - reach)
    return found


def _distance_to_segment(p: Point, a: Point, b: Point) -> float:
    """Distance of a point from the line segment between two others."""
    along = (b[0] - a[0], b[1] - a[1])
    share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2)
    share = min(max(share, 0.0), 1.0)
    return hypot(p[0] - a[0] - share * along[0], p[1] - a[1] - share * along[1])


def shared_area_mm2(one: Sequence[Point], other: Sequence[Point]) -> float:
    """Area common to two convex, counter-clockwise polygons (Sutherland and Hodgman, 1974)."""
    kept = list(one)
    for a, b in zip(other, (*other[1:], other[0]), strict=True):
        kept = _clip_left(kept, a, b)
    after = [*kept[1:], *kept[:1]]
    return abs(sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(kept, after, strict=True))) / 2


def _clip_left(polygon: list[Point], a: Point, b: Point) -> list[Point]:
    """The part of a polygon to the left of the line from a to b."""

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


def bounding_rectangle(polygon: Sequence[Point]) -> tuple[float, float, float, float]:
    """Least and largest x, then y, of the corners."""
    x, y = zip(*polygon, strict=True)
    return (min(x), max(x), min(y), max(y))


def signed_area_mm2(polygon: Sequence[Point]) -> float:
    """Area inside a polygon, negative for a clockwise one, by the shoelace formula."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in _edges(polygon)) / 2


def crossing_edges(polygon: Sequence[Point]) -> tuple[int, int] | None:
    """Numbers of two edges that meet although they are no neighbours; None where the line does not cross itself."""
    every = list(_edges(polygon))
    for first in range(len(every)):
        for second in range(first + 2, len(every)):
            if (first or second < len(every) - 1) and _meet(every[first], every[second]):
                return first, second
    return None


def convex_pieces(polygon: Sequence[Point]) -> tuple[tuple[Point, ...], ...]:
    """Convex pieces of a simple counter-clockwise polygon: itself, or the ears that are cut off (Meisters, 1975)."""
    left, found = list(polygon), list[tuple[Point, ...]]()
    if all(turning(*corner) >= 0.0 for corner in _corners(left)):
        return (tuple(left),)
    while len(left) > 2:
        corners = list(_corners(left))
        flat = next((k for k, corner in enumerate(corners) if turning(*corner) == 0.0), None)
        at = flat if flat is not None else next(k for k, corner in enumerate(corners) if _is_ear(corner, left))
        found += [corners[at]] if flat is None else []
        del left[at]
    return tuple(found)


def _corners(polygon: Sequence[Point]) -> Iterator[tuple[Point, Point, Point]]:
    """Every corner between the one before and the one after it."""
    return zip([polygon[-1], *polygon[:-1]], polygon, [*polygon[1:], polygon[0]], strict=True)


def turning(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a triangle, positive for a turn to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_ear(corner: tuple[Point, Point, Point], polygon: Sequence[Point]) -> bool:
    """Whether the triangle at a corner lies within the polygon."""
    a, b, c = corner
    others = (p for p in polygon if p not in corner)
    return turning(a, b, c) > 0.0 and not any(
        min(turning(a, b, p), turning(b, c, p), turning(c, a, p)) >= 0.0 for p in others
    )


def _meet(one: tuple[Point, Point], other: tuple[Point, Point]) -> bool:
    """Whether two line segments share a point."""
    (a, b), (c, d) = one, other
    turns = turning(a, b, c), turning(a, b, d), turning(c, d, a), turning(c, d, b)
    if all(each == 0.0 for each in turns):  # on one line
        return all(max(min(a[k], b[k]), min(c[k], d[k])) <= min(max(a[k], b[k]), max(c[k], d[k])) for k in (0, 1))
    return turns[0] * turns[1] <= 0.0 and turns[2] * turns[3] <= 0.0
