"""DXF files (R2010) of flat patterns in millimetres, with named layers, and pictures of them."""

from pathlib import Path
from typing import Any

from export.cut_files.style import STYLES, size_text
from export.cut_files.svg import TEXT_HEIGHT_MM
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, Outline, Stroke

ARROW_SIZE_MM = 0.5


def write_dxf(pattern: FlatPattern, path: Path) -> None:
    """Write a pattern at its size, in millimetres; the file says so in $INSUNITS."""
    from ezdxf.filemanagement import new

    document = new("R2010", setup=["linetypes", "styles"], units=4)  # 4: millimetres
    for name, style in STYLES.items():
        layer = document.layers.add(name)
        layer.rgb = style.colour
        layer.description = style.purpose
        layer.dxf.lineweight = style.weight
    _add_dimension_style(document)
    space = document.modelspace()
    for one in (*pattern.cuts, *pattern.marks):
        _add_entity(space, one)
    for size in pattern.dimensions:
        _add_dimension(space, size)
    document.saveas(path)


def _add_entity(space: Any, one: Outline | Circle | Stroke | Label) -> None:
    attributes = {"layer": one.layer}
    if isinstance(one, Circle):
        space.add_circle(one.center, one.radius, dxfattribs=attributes)
    elif isinstance(one, Label):
        from ezdxf.enums import TextEntityAlignment

        text = space.add_text(one.text, height=one.height, rotation=90 if one.upright else 0, dxfattribs=attributes)
        text.set_placement(one.place, align=TextEntityAlignment.MIDDLE_CENTER)
    else:
        space.add_lwpolyline(one.points, close=isinstance(one, Outline), dxfattribs=attributes)


def _add_dimension_style(document: Any) -> None:
    style = document.dimstyles.new("KIT")
    style.set_arrows(blk="", ldrblk="")
    style.dxf.dimtxt, style.dxf.dimasz = TEXT_HEIGHT_MM, ARROW_SIZE_MM
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


def draw_cut_file(dxf: Path, picture: Path) -> None:
    """Draw a DXF file as a CAD program would show it, and write a PNG."""
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
