"""Pictures of an array's answer: matrix of crosstalk, maps for each pressed segment, growth with depth, kernel."""

from collections.abc import Sequence
from math import ceil, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from export.view import DIVERGING, DPI, INK, save_png
from foundation.arrays import Floats
from geometry.array.layout import ArrayLayout

MOST_LABELLED = 20
"""Most segments for which the matrix has room for numbers and labels."""
MOST_COLUMNS, WIDE_RATIO, MAP_SIZE_IN = 3, 1.5, 4.0
"""Most maps side by side; length over width of an array above which maps lie one below the other; size of a map."""
FULL_SCALE_PERCENT, TICKS_PERCENT = 100.0, (-100, -10, -1, 0, 1, 10, 100)
DARK_PERCENT = 7.0
"""Crosstalk above which colours are so dark that numbers on them are white."""
LINEAR_PERCENT = 1.0
"""Below this colours are linear, above logarithmic: a neighbour's tenth and a far segment's hundredth both show."""
KERNEL_LEVELS = 21
"""Number of levels between the colours of a kernel."""


def draw_matrix(labels: Sequence[str], crosstalk_percent: Floats, path: Path) -> None:
    """Draw the crosstalk (n, n) in % of the pressed segment's voltage, one row for each, and write a PNG."""
    from matplotlib.figure import Figure

    count = len(labels)
    side = min(12.0, 3.2 + 0.62 * count)
    figure = Figure(figsize=(side + 1.2, side), dpi=DPI, facecolor="white", layout="constrained")
    axes = figure.subplots()
    image = axes.imshow(crosstalk_percent, cmap=DIVERGING, norm=_colour_norm())
    if count <= MOST_LABELLED:
        short = [label.removeprefix("segment-") for label in labels]
        axes.set_xticks(range(count), short, fontsize=10, rotation=90 if count > 8 else 0)
        axes.set_yticks(range(count), short, fontsize=10)
        size = 9 if count < 9 else 7
        for (i, j), share in np.ndenumerate(crosstalk_percent):
            colour = "white" if abs(share) > DARK_PERCENT else INK
            axes.text(j, i, _percent_text(share), ha="center", va="center", fontsize=size, color=colour)
    axes.set_xlabel("segment that is read", fontsize=12, color=INK)
    axes.set_ylabel("segment that is pressed", fontsize=12, color=INK)
    axes.set_title("Crosstalk in % of the pressed segment's voltage", fontsize=13, color=INK)
    _draw_colour_bar(figure, image, axes, shrink=0.8)
    save_png(figure, path)


def draw_maps(layout: ArrayLayout, pressed: Sequence[int], crosstalk_percent: Floats, path: Path) -> None:
    """Draw the array from above, once for each pressed segment, and write a PNG.

    Electrodes are coloured by what they read, crosstalk_percent (n, n).
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle

    half_x, half_y = layout.half_mm
    columns = 1 if half_x > WIDE_RATIO * half_y else min(MOST_COLUMNS, ceil(sqrt(len(pressed))))
    lines = -(-len(pressed) // columns)
    wide = MAP_SIZE_IN * min(1.0, half_x / half_y) if columns > 1 else 2 * MAP_SIZE_IN
    size = (max(columns * wide + 1.0, MAP_SIZE_IN + 1.0), lines * (wide * half_y / half_x + 0.75) + 1.2)
    figure = Figure(figsize=size, dpi=DPI, facecolor="white", layout="constrained")
    cells = figure.subplots(lines, columns, squeeze=False)
    norm, x_size, y_size = _colour_norm(), *layout.size_mm
    for cell in cells.flat:
        cell.set_axis_off()
    image: Any = None
    for cell, number in zip(cells.flat, pressed, strict=False):
        cell.set_axis_on()
        cell.set_facecolor("#eef1f4")
        for place, share in zip(layout.places, crosstalk_percent[number], strict=True):
            corner = (place.x_mm - x_size / 2, place.y_mm - y_size / 2)
            image = _colour_mapping(norm)
            cell.add_patch(Rectangle(corner, x_size, y_size, facecolor=image.to_rgba(share), edgecolor=INK, lw=0.7))
            cell.text(place.x_mm, place.y_mm + 0.3 * y_size, f"{_percent_text(share)} %", ha="center", va="center",
                      fontsize=9, color="white" if abs(share) > DARK_PERCENT else INK)  # fmt: skip
        at = layout.places[number]
        cell.add_patch(Circle((at.x_mm, at.y_mm), 0.13 * min(x_size, y_size), facecolor=INK))
        cell.set(xlim=(-half_x, half_x), ylim=(-half_y, half_y), aspect="equal")
        cell.set_title(at.label, fontsize=11, color=INK)
        cell.tick_params(labelsize=9)
    for cell in cells[-1]:
        cell.set_xlabel("x (mm)", fontsize=10, color=INK)
    for line in cells:
        line[0].set_ylabel("y (mm)", fontsize=10, color=INK)
    _draw_colour_bar(figure, image, list(cells.flat), location="bottom", aspect=30)
    save_png(figure, path)


def draw_growth(
    names: Sequence[str], depth_mm: Floats, force_N: Floats, own_V: Floats, neighbour_percent: Floats, path: Path
) -> None:
    """Draw the voltage of pressed segments over depth and force, and their strongest neighbour's, and write a PNG.

    names (n,); depth_mm, force_N, own_V and neighbour_percent, the neighbour's share of that voltage, (n, s).
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.6), dpi=DPI, facecolor="white", layout="constrained")
    voltage, force, share = figure.subplots(1, 3)
    for i, name in enumerate(names):
        voltage.plot(depth_mm[i], own_V[i], "o-", ms=4, lw=1.6, label=name)
        force.plot(force_N[i], own_V[i], "o-", ms=4, lw=1.6)
        share.plot(depth_mm[i, 1:], neighbour_percent[i, 1:], "o-", ms=4, lw=1.6)
    voltage.set(xlabel="indentation (mm)", ylabel="voltage of the pressed segment (V)")
    force.set(xlabel="force (N)", ylabel="voltage of the pressed segment (V)")
    share.set(xlabel="indentation (mm)", ylabel="strongest neighbour (% of it)")
    voltage.legend(frameon=False, fontsize=10)
    for axes in (voltage, force, share):
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]), top=axes.get_ylim()[1] * 1.05)
    save_png(figure, path)


def draw_kernel(
    layout: ArrayLayout, x_mm: Floats, y_mm: Floats, charge_pC: Floats, force_N: Floats, title: str, path: Path
) -> None:
    """Draw the charge of one segment and the force, each (a, b) over the place of the dot, and write a PNG."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    figure = Figure(figsize=(9.0, 5.6), dpi=DPI, facecolor="white", layout="constrained")
    largest = float(np.abs(charge_pC).max())
    maps = (
        (f"Charge of {title}, pC", charge_pC, DIVERGING, np.linspace(-largest, largest, KERNEL_LEVELS)),
        ("Force, N", force_N, "viridis", np.linspace(0.0, float(force_N.max()), KERNEL_LEVELS)),
    )
    for axes, (name, values, colours, levels) in zip(figure.subplots(1, 2), maps, strict=True):
        image = axes.contourf(x_mm, y_mm, values.T, levels=levels, cmap=colours)
        for place in layout.places:
            corner = (place.x_mm - layout.size_mm[0] / 2, place.y_mm - layout.size_mm[1] / 2)
            axes.add_patch(Rectangle(corner, *layout.size_mm, fill=False, edgecolor=INK, lw=0.7))
        axes.set(aspect="equal", xlabel="x of the dot (mm)", ylabel="y of the dot (mm)")
        axes.set_title(name, fontsize=11, color=INK)
        figure.colorbar(image, ax=axes, shrink=0.85)
    save_png(figure, path)


def _colour_norm() -> Any:
    from matplotlib.colors import SymLogNorm

    return SymLogNorm(LINEAR_PERCENT, linscale=0.6, vmin=-FULL_SCALE_PERCENT, vmax=FULL_SCALE_PERCENT, base=10)


def _colour_mapping(norm: Any) -> Any:
    from matplotlib.cm import ScalarMappable

    return ScalarMappable(norm, DIVERGING)


def _draw_colour_bar(figure: Any, image: Any, axes: Any, **how: Any) -> None:
    bar = figure.colorbar(image, ax=axes, ticks=list(TICKS_PERCENT), **how)
    bar.set_ticklabels([f"{tick}".replace("-", "−") for tick in TICKS_PERCENT])
    bar.set_label("% of the pressed segment's voltage", fontsize=10, color=INK)


def _percent_text(value: float) -> str:
    """A percentage of at most three digits: 100, 13.1, -0.40."""
    if not np.isfinite(value):
        return "–"
    digits = 0 if abs(value) >= 99.95 else 1 if abs(value) >= 9.95 else 2
    return f"{value:.{digits}f}".replace("-", "−") if round(abs(value), 2) else "0"
