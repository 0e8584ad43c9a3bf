"""DXF (R2010) of a flat pattern."""

from pathlib import Path
from typing import Any

from export.cut_files.layers import STYLES, size_text
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, Outline, Stroke

TEXT_MM, ARROW_MM = 0.8, 0.5


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
