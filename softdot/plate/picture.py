"""The picture of a plate: seen from above, its sizes beside it."""

from pathlib import Path
from textwrap import shorten
from typing import Any

import numpy as np

from export.printability.surface import surface_of
from export.view import INK, DrawnBody, View, picture_box, picture_page, render, save_png
from softdot.plate.build import BuiltPlate

VIEW = View(0.0, 50.0)
TOP_IN, ROW_IN = 0.8, 0.4
"""Of the column of sizes: its distance from the upper edge of the page, and its pitch."""
MOST_LINES = 4
KIND_TITLES = {"text": "Braille plate", "dot": "Single dot", "height-series": "Dots that grow", "tip": "Indenter tip"}


def draw_plate(built: BuiltPlate, path: Path) -> None:
    """Write the picture of a plate as PNG. InputError without OpenGL."""
    import pyvista

    surface = surface_of(built.plate.part.solid)
    box = picture_box(VIEW.flat(np.asarray(surface.vertices)))
    red, green, blue = (round(255 * value) for value in built.plate.part.colour)
    body = DrawnBody(pyvista.wrap(surface), f"#{red:02x}{green:02x}{blue:02x}")
    sizes = _sizes(built)
    least_height_in = TOP_IN + len(sizes) * ROW_IN
    figure, axes, pixels_per_mm = picture_page(box, _title(built), least_height_in)
    axes.imshow(render([body], VIEW, box, pixels_per_mm), extent=box, aspect="equal")
    if built.translation is not None:
        lines = built.translation.lines[:MOST_LINES]
        size = 14 if len(lines) <= 2 else 28 / len(lines)  # they stand in the lower margin
        middle, below = (box[0] + box[1]) / 2, box[2] - 0.03 * (box[1] - box[0])
        axes.text(
            middle, below, "\n".join(lines), fontsize=size, color=INK, ha="center", va="top", multialignment="left"
        )
    _write_sizes(figure, sizes)
    save_png(figure, path)


def _title(built: BuiltPlate) -> str:
    text = shorten(built.request.text or "", 26, placeholder="…")
    return f"{KIND_TITLES[built.request.kind]}{f' “{text}”' if text else ''}, {built.sizes.standard}"


def _sizes(built: BuiltPlate) -> list[tuple[str, str]]:
    """Names of sizes and their values in mm."""
    plate, first = built.plate, built.plate.dots[0]
    heights = sorted({dot.height_mm for dot in plate.dots})
    known = {name: size.value_mm for name, size in built.sizes.known.items() if name.endswith("pitch_mm")}
    rows = [
        ("plate", " × ".join(f"{size:.4g}" for size in plate.size_mm)),
        ("dot diameter", f"{first.base_diameter_mm:g}"),
        ("dot height", " to ".join(f"{height:g}" for height in dict.fromkeys((heights[0], heights[-1])))),
    ]
    if built.translation is not None:
        rows += [(name.removesuffix("_mm").replace("_", " "), f"{value:g}") for name, value in known.items()]
    return rows


def _write_sizes(figure: Any, sizes: list[tuple[str, str]]) -> None:
    """Write sizes in a column at the right of the picture."""
    height_in = figure.get_figheight()
    for number, (name, value) in enumerate(sizes):
        above = 1 - (TOP_IN + number * ROW_IN) / height_in
        figure.text(0.75, above, f"{name}\n{value} mm", fontsize=9, color=INK, va="top", linespacing=1.3)
