"""SVG files of flat patterns in millimetres, with named layers."""

from pathlib import Path
from xml.etree import ElementTree as Xml

from export.cut_files.style import STYLES, size_text
from foundation.files import write_whole_text
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, LayerName, Outline, Stroke
from geometry.polygons import Point

DIMENSION_ROOM_MM = 8.0
"""Room around the pattern, for dimensions."""
TEXT_HEIGHT_MM = 0.8
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"


class SvgSheet:
    """The page of an SVG file; y of the pattern runs up, y of the file down."""

    def __init__(self, pattern: FlatPattern) -> None:
        xs, ys = zip(*pattern.points, strict=True)
        self.left, self.top = min(xs) - DIMENSION_ROOM_MM, max(ys) + DIMENSION_ROOM_MM
        width, height = max(xs) + DIMENSION_ROOM_MM - self.left, self.top - min(ys) + DIMENSION_ROOM_MM
        self.root = Xml.Element(
            "svg",
            {
                "xmlns": "http://www.w3.org/2000/svg", "xmlns:inkscape": INKSCAPE, "width": f"{_number_text(width)}mm",
                "height": f"{_number_text(height)}mm", "viewBox": f"0 0 {_number_text(width)} {_number_text(height)}",
            },
        )  # fmt: skip
        Xml.SubElement(self.root, "title").text = pattern.title
        self.groups = {name: self._group(name) for name in STYLES}

    def _group(self, name: LayerName) -> Xml.Element:
        style = STYLES[name]
        attributes = {
            "id": name, "inkscape:label": name, "inkscape:groupmode": "layer", "fill": "none",
            "stroke": "#{:02x}{:02x}{:02x}".format(*style.colour), "stroke-width": _number_text(style.weight / 200),
        }  # fmt: skip
        return Xml.SubElement(self.root, "g", attributes)

    def at(self, point: Point) -> Point:
        """A point of the pattern in the axes of the page."""
        return point[0] - self.left, self.top - point[1]

    def path(self, layer: LayerName, points: tuple[Point, ...], close: bool) -> None:
        """Add a polygon or an open line."""
        corners = " L ".join("{} {}".format(*map(_number_text, self.at(p))) for p in points)
        Xml.SubElement(self.groups[layer], "path", {"d": f"M {corners}{' Z' if close else ''}"})

    def circle(self, circle: Circle) -> None:
        """Add a circle."""
        x, y = map(_number_text, self.at(circle.center))
        Xml.SubElement(self.groups[circle.layer], "circle", {"cx": x, "cy": y, "r": _number_text(circle.radius)})

    def words(self, layer: LayerName, place: Point, text: str, height: float, upright: bool = False) -> None:
        """Add text centred at a place; upright: read from the right."""
        x, y = map(_number_text, self.at(place))
        attributes = {
            "x": x, "y": y, "font-size": _number_text(1.35 * height), "font-family": "sans-serif",
            "text-anchor": "middle", "dominant-baseline": "central", "stroke": "none",
            "fill": self.groups[layer].get("stroke", ""),
        }  # fmt: skip
        if upright:
            attributes["transform"] = f"rotate(-90 {x} {y})"
        Xml.SubElement(self.groups[layer], "text", attributes).text = text


def write_svg(pattern: FlatPattern, path: Path) -> None:
    """Write a pattern at its size, in millimetres."""
    sheet = SvgSheet(pattern)
    for one in (*pattern.cuts, *pattern.marks):
        if isinstance(one, Circle):
            sheet.circle(one)
        elif isinstance(one, Label):
            sheet.words(one.layer, one.place, one.text, one.height, one.upright)
        else:
            sheet.path(one.layer, one.points, close=isinstance(one, Outline))
    for size in pattern.dimensions:
        _draw_dimension(sheet, size)
    Xml.indent(sheet.root)
    write_whole_text(path, Xml.tostring(sheet.root, encoding="unicode", xml_declaration=True) + "\n")


def _draw_dimension(sheet: SvgSheet, size: Dimension) -> None:
    """Add two extension lines, the dimension line with oblique strokes, and the size."""
    up = (0.0, 1.0) if size.along == "x" else (1.0, 0.0)
    line = [_moved_point(size.start, up, size.shift)]
    line.append((size.end[0], line[0][1]) if size.along == "x" else (line[0][0], size.end[1]))
    for point, foot in zip((size.start, size.end), line, strict=True):
        sheet.path("DIMENSION", (point, foot), close=False)
        tick = Stroke("DIMENSION", ((foot[0] - 0.2, foot[1] - 0.2), (foot[0] + 0.2, foot[1] + 0.2)))
        sheet.path(tick.layer, tick.points, close=False)
    sheet.path("DIMENSION", (line[0], line[1]), close=False)
    middle = ((line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2)
    beside = _moved_point(middle, (0.0, 1.0) if size.along == "x" else (-1.0, 0.0), 0.75 * TEXT_HEIGHT_MM)
    sheet.words("DIMENSION", beside, size_text(size.length_mm), TEXT_HEIGHT_MM, upright=size.along == "y")


def _moved_point(point: Point, way: Point, distance: float) -> Point:
    """The point moved by a distance along a unit vector."""
    return point[0] + distance * way[0], point[1] + distance * way[1]


def _number_text(value: float) -> str:
    return f"{value:.5f}".rstrip("0").rstrip(".")
