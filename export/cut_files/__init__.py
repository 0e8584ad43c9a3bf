"""All cut files of a kit and their pictures: DXF (R2010) and SVG in millimetres, with named layers."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree as Xml

from geometry.files import whole_folder, write_whole_text
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, LayerName, Outline, Point, Stroke, compensated


class Style(NamedTuple):
    """purpose : one phrase. colour : red, green, blue from 0 to 255. weight : of its lines, 0.01 mm."""

    purpose: str
    colour: tuple[int, int, int]
    weight: int


STYLES: dict[LayerName, Style] = {
    "CUT": Style("cut through; the kerf is compensated", (210, 30, 30), 18),
    "ELECTRODE-TOP": Style("edge of the metal on the face towards the dot", (200, 120, 0), 13),
    "ELECTRODE-BOTTOM": Style("edge of the metal on the other face, seen from above", (30, 90, 190), 13),
    "ENGRAVE": Style("marks, to be engraved or written", (40, 130, 60), 9),
    "DIMENSION": Style("sizes of the finished part; not to be cut", (110, 110, 110), 5),
}


def size_text(length_mm: float) -> str:
    """A size for a drawing, to a hundredth of a millimetre."""
    return f"{length_mm:.2f}".rstrip("0").rstrip(".")


ROOM_MM = 8.0
"""Around the pattern, for dimensions."""
TEXT_MM = 0.8
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"


class Sheet:
    """The page; y of the pattern runs up, y of the file down."""

    def __init__(self, pattern: FlatPattern) -> None:
        xs, ys = zip(*pattern.points, strict=True)
        self.left, self.top = min(xs) - ROOM_MM, max(ys) + ROOM_MM
        width, height = max(xs) + ROOM_MM - self.left, self.top - min(ys) + ROOM_MM
        self.root = Xml.Element(
            "svg",
            {
                "xmlns": "http://www.w3.org/2000/svg", "xmlns:inkscape": INKSCAPE, "width": f"{_text(width)}mm",
                "height": f"{_text(height)}mm", "viewBox": f"0 0 {_text(width)} {_text(height)}",
            },
        )  # fmt: skip
        Xml.SubElement(self.root, "title").text = pattern.title
        self.groups = {name: self._group(name) for name in STYLES}

    def _group(self, name: LayerName) -> Xml.Element:
        style = STYLES[name]
        attributes = {
            "id": name, "inkscape:label": name, "inkscape:groupmode": "layer", "fill": "none",
            "stroke": "#{:02x}{:02x}{:02x}".format(*style.colour), "stroke-width": _text(style.weight / 200),
        }  # fmt: skip
        return Xml.SubElement(self.root, "g", attributes)

    def at(self, point: Point) -> Point:
        """A point of the pattern on the page."""
        return point[0] - self.left, self.top - point[1]

    def path(self, layer: LayerName, points: tuple[Point, ...], close: bool) -> None:
        """A polygon or an open line."""
        corners = " L ".join("{} {}".format(*map(_text, self.at(p))) for p in points)
        Xml.SubElement(self.groups[layer], "path", {"d": f"M {corners}{' Z' if close else ''}"})

    def circle(self, circle: Circle) -> None:
        """A circle."""
        x, y = map(_text, self.at(circle.center))
        Xml.SubElement(self.groups[circle.layer], "circle", {"cx": x, "cy": y, "r": _text(circle.radius)})

    def words(self, layer: LayerName, place: Point, text: str, height: float, upright: bool = False) -> None:
        """Text centred at a place; upright: read from the right."""
        x, y = map(_text, self.at(place))
        attributes = {
            "x": x, "y": y, "font-size": _text(1.35 * height), "font-family": "sans-serif", "text-anchor": "middle",
            "dominant-baseline": "central", "stroke": "none", "fill": self.groups[layer].get("stroke", ""),
        }  # fmt: skip
        if upright:
            attributes["transform"] = f"rotate(-90 {x} {y})"
        Xml.SubElement(self.groups[layer], "text", attributes).text = text


def write_svg(pattern: FlatPattern, path: Path) -> None:
    """Write a pattern as it is, in millimetres."""
    sheet = Sheet(pattern)
    for one in (*pattern.cuts, *pattern.marks):
        if isinstance(one, Circle):
            sheet.circle(one)
        elif isinstance(one, Label):
            sheet.words(one.layer, one.place, one.text, one.height, one.upright)
        else:
            sheet.path(one.layer, one.points, close=isinstance(one, Outline))
    for size in pattern.dimensions:
        _dimension(sheet, size)
    Xml.indent(sheet.root)
    write_whole_text(path, Xml.tostring(sheet.root, encoding="unicode", xml_declaration=True) + "\n")


def _dimension(sheet: Sheet, size: Dimension) -> None:
    """Two extension lines, the dimension line with oblique strokes, and the size."""
    up = (0.0, 1.0) if size.along == "x" else (1.0, 0.0)
    line = [_moved(size.start, up, size.shift)]
    line.append((size.end[0], line[0][1]) if size.along == "x" else (line[0][0], size.end[1]))
    for point, foot in zip((size.start, size.end), line, strict=True):
        sheet.path("DIMENSION", (point, foot), close=False)
        tick = Stroke("DIMENSION", ((foot[0] - 0.2, foot[1] - 0.2), (foot[0] + 0.2, foot[1] + 0.2)))
        sheet.path(tick.layer, tick.points, close=False)
    sheet.path("DIMENSION", (line[0], line[1]), close=False)
    middle = ((line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2)
    beside = _moved(middle, (0.0, 1.0) if size.along == "x" else (-1.0, 0.0), 0.75 * TEXT_MM)
    sheet.words("DIMENSION", beside, size_text(size.length_mm), TEXT_MM, upright=size.along == "y")


def _moved(point: Point, way: Point, distance: float) -> Point:
    return point[0] + distance * way[0], point[1] + distance * way[1]


def _text(value: float) -> str:
    return f"{value:.5f}".rstrip("0").rstrip(".")


ARROW_MM = 0.5


def write_dxf(pattern: FlatPattern, path: Path) -> None:
    """Write a pattern as it is, in millimetres; the file says so in $INSUNITS."""
    from ezdxf.filemanagement import new

    document = new("R2010", setup=["linetypes", "styles"], units=4)  # 4: millimetres
    for name, style in STYLES.items():
        layer = document.layers.add(name)
        layer.rgb = style.colour
        layer.description = style.purpose
        layer.dxf.lineweight = style.weight
    _dimension_style(document)
    space = document.modelspace()
    for one in (*pattern.cuts, *pattern.marks):
        _add(space, one)
    for size in pattern.dimensions:
        _add_dimension(space, size)
    document.saveas(path)


def _add(space: Any, one: Outline | Circle | Stroke | Label) -> None:
    attributes = {"layer": one.layer}
    if isinstance(one, Circle):
        space.add_circle(one.center, one.radius, dxfattribs=attributes)
    elif isinstance(one, Label):
        from ezdxf.enums import TextEntityAlignment

        text = space.add_text(one.text, height=one.height, rotation=90 if one.upright else 0, dxfattribs=attributes)
        text.set_placement(one.place, align=TextEntityAlignment.MIDDLE_CENTER)
    else:
        space.add_lwpolyline(one.points, close=isinstance(one, Outline), dxfattribs=attributes)


def _dimension_style(document: Any) -> None:
    style = document.dimstyles.new("KIT")
    style.set_arrows(blk="", ldrblk="")
    style.dxf.dimtxt, style.dxf.dimasz = TEXT_MM, ARROW_MM
    style.dxf.dimexo, style.dxf.dimexe, style.dxf.dimgap = 0.2, 0.3, 0.2
    style.dxf.dimtad, style.dxf.dimdec, style.dxf.dimzin = 1, 2, 8
    style.dxf.dimtih, style.dxf.dimtoh = 0, 0
    colour = 8  # grey
    style.dxf.dimclrd = style.dxf.dimclre = style.dxf.dimclrt = colour


def _add_dimension(space: Any, size: Dimension) -> None:
    along_x = size.along == "x"
    base = (size.start[0], size.start[1] + size.shift) if along_x else (size.start[0] + size.shift, size.start[1])
    space.add_linear_dim(
        base=base,
        p1=size.start,
        p2=size.end,
        angle=0 if along_x else 90,
        dimstyle="KIT",
        text=size_text(size.length_mm),
        dxfattribs={"layer": "DIMENSION"},
    ).render()


def write_cut_files(patterns: Sequence[FlatPattern], folder: Path) -> None:
    """Write <name>.dxf and <name>.svg of every pattern, kerf compensated; the folder appears whole or not at all."""
    with whole_folder(folder) as scratch:
        for pattern in patterns:
            cut = compensated(pattern)
            write_dxf(cut, scratch / f"{pattern.name}.dxf")
            write_svg(cut, scratch / f"{pattern.name}.svg")


def draw_cut_file(dxf: Path, picture: Path) -> None:
    """A PNG of what a DXF file holds, as a CAD program would show it."""
    from ezdxf.addons.drawing.config import BackgroundPolicy, ColorPolicy, Configuration
    from ezdxf.addons.drawing.frontend import Frontend
    from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
    from ezdxf.addons.drawing.properties import RenderContext
    from ezdxf.filemanagement import readfile
    from matplotlib.figure import Figure

    document = readfile(dxf)
    figure = Figure(figsize=(9.0, 5.0), dpi=200)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    settings = Configuration(
        background_policy=BackgroundPolicy.WHITE,
        color_policy=ColorPolicy.COLOR,
        min_lineweight=0.3,
        lineweight_scaling=3.0,
    )
    Frontend(RenderContext(document), MatplotlibBackend(axes), config=settings).draw_layout(document.modelspace())
    figure.savefig(picture, dpi=200, facecolor="white", bbox_inches="tight", pad_inches=0.1)
