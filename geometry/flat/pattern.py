"""A flat pattern: closed lines on named layers, with the dimensions that a bench needs; kerf compensation."""

from dataclasses import dataclass, replace
from math import cos, hypot, pi, radians, sin
from typing import Literal

from geometry.polygons import Point

LayerName = Literal["CUT", "ELECTRODE-TOP", "ELECTRODE-BOTTOM", "ENGRAVE", "DIMENSION"]


@dataclass(frozen=True)
class Outline:
    """A closed polygon, counter-clockwise around material, on a layer. hole : material lies outside it."""

    layer: LayerName
    points: tuple[Point, ...]
    hole: bool = False

    @property
    def length_mm(self) -> float:
        """Length in mm of the closed line."""
        after = (*self.points[1:], self.points[0])
        return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in zip(self.points, after, strict=True))

    @property
    def area_mm2(self) -> float:
        """Area in mm2 inside the line, by the shoelace formula."""
        after = (*self.points[1:], self.points[0])
        return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(self.points, after, strict=True))) / 2


@dataclass(frozen=True)
class Circle:
    """A circle on a layer. hole : material lies outside it."""

    layer: LayerName
    center: Point
    radius: float
    hole: bool = True

    @property
    def length_mm(self) -> float:
        """Circumference in mm."""
        return 2 * pi * self.radius

    @property
    def area_mm2(self) -> float:
        """Area in mm2 inside the circle."""
        return pi * self.radius**2


@dataclass(frozen=True)
class Stroke:
    """An open line, to be engraved."""

    layer: LayerName
    points: tuple[Point, ...]


@dataclass(frozen=True)
class Label:
    """Text on the pattern, centred at a point; height in mm; upright: read from the right."""

    layer: LayerName
    place: Point
    text: str
    height: float = 1.0
    upright: bool = False


@dataclass(frozen=True)
class Dimension:
    """A size of the finished part: between two points, along x, along y or a diameter through them.

    shift : distance of the dimension line, upwards for x and to the right for y; negative for the other side.
    """

    start: Point
    end: Point
    along: Literal["x", "y"]
    shift: float

    @property
    def length_mm(self) -> float:
        """The stated size in mm."""
        axis = 0 if self.along == "x" else 1
        return abs(self.end[axis] - self.start[axis])


@dataclass(frozen=True)
class FlatPattern:
    """One thing to cut.

    name : of the files; title, material, instruction : for people. thickness_mm : of the sheet.
    count : how many for the whole array.
    cuts : closed lines on CUT at their finished size; marks : everything else.
    kerf_mm : width of the cut. Written cut lines lie half of it outside of the part.
    """

    name: str
    title: str
    material: str
    thickness_mm: float
    count: int
    instruction: str
    cuts: tuple[Outline | Circle, ...]
    marks: tuple[Outline | Stroke | Label, ...] = ()
    dimensions: tuple[Dimension, ...] = ()
    kerf_mm: float = 0.0

    @property
    def points(self) -> list[Point]:
        """Points that span the pattern."""
        found: list[Point] = []
        for one in (*self.cuts, *self.marks):
            if isinstance(one, Circle):
                found += [(one.center[0] + s * one.radius, one.center[1] + s * one.radius) for s in (-1.0, 1.0)]
            else:
                found += [one.place] if isinstance(one, Label) else one.points
        return found

    @property
    def on_panel(self) -> bool:
        """Whether the pattern lies on a panel with registration holes."""
        return sum(isinstance(cut, Circle) and cut.hole for cut in self.cuts) > 1

    @property
    def size_mm(self) -> Point:
        """Size in mm, x and y, of the sheet that the pattern needs, cuts included."""
        xs, ys = zip(*self.points, strict=True)
        return (max(xs) - min(xs) + self.kerf_mm, max(ys) - min(ys) + self.kerf_mm)


def rectangle(layer: LayerName, x: tuple[float, float], y: tuple[float, float], hole: bool = False) -> Outline:
    """A rectangle from its intervals in x and y."""
    return Outline(layer, ((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])), hole)


def rotated_pattern(pattern: FlatPattern, angle_deg: float) -> FlatPattern:
    """The pattern rotated about the origin by a multiple of 90 degrees."""
    quarter = round(angle_deg / 90.0) % 4
    return replace(
        pattern,
        cuts=tuple(_rotated_cut(cut, quarter) for cut in pattern.cuts),
        marks=tuple(_rotated_mark(mark, quarter) for mark in pattern.marks),
        dimensions=tuple(_rotated_dimension(one, quarter) for one in pattern.dimensions),
    )


def arrow(layer: LayerName, middle: Point, angle_deg: float, length: float) -> Stroke:
    """A double-headed arrow, which shows a direction without a sense."""
    c, s = cos(radians(angle_deg)), sin(radians(angle_deg))

    def at(u: float, v: float) -> Point:
        return (middle[0] + u * c - v * s, middle[1] + u * s + v * c)

    half, head = length / 2, length / 8
    left = (at(-half + head, head), at(-half, 0.0), at(-half + head, -head), at(-half, 0.0))
    right = (at(half, 0.0), at(half - head, head), at(half, 0.0), at(half - head, -head))
    return Stroke(layer, (*left, *right))


def _rotated_point(point: Point, quarter: int) -> Point:
    x, y = point
    return ((x, y), (-y, x), (-x, -y), (y, -x))[quarter]


def _rotated_cut(cut: Outline | Circle, quarter: int) -> Outline | Circle:
    if isinstance(cut, Circle):
        return replace(cut, center=_rotated_point(cut.center, quarter))
    return replace(cut, points=tuple(_rotated_point(p, quarter) for p in cut.points))


def _rotated_mark(mark: Outline | Stroke | Label, quarter: int) -> Outline | Stroke | Label:
    if isinstance(mark, Label):
        return replace(mark, place=_rotated_point(mark.place, quarter), upright=mark.upright ^ bool(quarter % 2))
    return replace(mark, points=tuple(_rotated_point(p, quarter) for p in mark.points))


def _rotated_dimension(one: Dimension, quarter: int) -> Dimension:
    """A rotated dimension, from left to right or upwards; the side on which its line lies turns too."""
    along, shift = one.along, one.shift
    if quarter % 2:
        along = "y" if along == "x" else "x"
    up = (0.0, shift) if one.along == "x" else (shift, 0.0)
    moved = _rotated_point(up, quarter)
    ends = (_rotated_point(one.start, quarter), _rotated_point(one.end, quarter))
    start, end = sorted(ends, key=lambda point: point[0 if along == "x" else 1])
    return Dimension(start, end, along, moved[1] if along == "x" else moved[0])


def kerf_compensated_pattern(pattern: FlatPattern) -> FlatPattern:
    """The pattern with its cut lines moved by half a kerf into the waste; marks stay."""
    half = pattern.kerf_mm / 2
    return replace(pattern, cuts=tuple(_offset_cut(cut, half) for cut in pattern.cuts))


def _offset_cut(cut: Outline | Circle, distance: float) -> Outline | Circle:
    """A cut line moved into the waste: outer lines grow, holes shrink."""
    outwards = -distance if cut.hole else distance
    if isinstance(cut, Circle):
        return replace(cut, radius=cut.radius + outwards)
    return replace(cut, points=offset_polygon(cut.points, outwards))


def offset_polygon(points: tuple[Point, ...], distance: float) -> tuple[Point, ...]:
    """A counter-clockwise polygon with every edge moved outwards by the distance; corners stay sharp.

    For distances below the lengths of the edges.
    """
    before, after = (points[-1], *points[:-1]), (*points[1:], points[0])
    return tuple(_offset_corner(a, b, c, distance) for a, b, c in zip(before, points, after, strict=True))


def _offset_corner(a: Point, b: Point, c: Point, distance: float) -> Point:
    """Corner b moved along the bisector: b + d (n1 + n2) / (1 + n1 . n2), with the outward normals of both edges."""
    n1, n2 = _normal(a, b), _normal(b, c)
    scale = distance / (1.0 + n1[0] * n2[0] + n1[1] * n2[1])
    return (b[0] + scale * (n1[0] + n2[0]), b[1] + scale * (n1[1] + n2[1]))


def _normal(a: Point, b: Point) -> Point:
    """Unit normal to the right of the way from a to b: outwards, where the polygon runs counter-clockwise."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = hypot(dx, dy)
    return (dy / length, -dx / length)
