"""What is written around a view: rulers along the edges of the segment, names of its parts, a colour bar."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from export.view import INK, View
from mesh.types import Floats


def ruler(axes: Any, view: View, start_mm: Floats, end_mm: Floats, name: str, away: Floats) -> None:
    """Ticks in mm along the edge from start to end (3,), which run along one coordinate axis.

    away : (2,) direction on the picture in which ticks and numbers lie.
    """
    axis = int(np.abs(end_mm - start_mm).argmax())
    unit = np.asarray(away) / np.linalg.norm(away)
    mm = np.diff(axes.get_xlim())[0] / 100
    length = float(np.linalg.norm(np.diff(view.flat(np.stack([start_mm, end_mm])), axis=0)))
    for value in _round_values(start_mm[axis], end_mm[axis], most=length / (6.5 * mm)):
        place = start_mm.copy()
        place[axis] = value
        foot = view.flat(place[None])[0]
        tip, text = foot + 0.9 * mm * unit, foot + 3.0 * mm * unit
        axes.plot(*np.column_stack([foot, tip]), color=INK, lw=0.8, clip_on=False)
        axes.text(*text, f"{value:g}".replace("-", "\u2212"), fontsize=11, color=INK, ha="center", va="center")
    middle = view.flat((start_mm + end_mm)[None] / 2)[0] + 7.2 * mm * unit
    axes.text(*middle, f"{name} (mm)", fontsize=12, color=INK, ha="center", va="center")


def _round_values(low: float, high: float, most: float) -> list[float]:
    """Round numbers between low and high, about five, fewer where only ``most`` have room."""
    low, high = min(low, high), max(low, high)
    rough = (high - low) / min(4.0, max(most, 1.0))
    decade = 10.0 ** np.floor(np.log10(rough))
    step = next(decade * m for m in (1, 2, 2.5, 5, 10) if decade * m >= 0.8 * rough)
    first, last = np.ceil(low / step - 1e-6), np.floor(high / step + 1e-6)
    return [float(round(step * k, 9)) + 0.0 for k in np.arange(first, last + 1)]


def name_parts(axes: Any, names: Sequence[str], anchors: Floats, colours: Sequence[str], column_mm: float) -> None:
    """Names in a column at column_mm, joined by thin lines to their anchors (n, 2)."""
    order = np.argsort(anchors[:, 1])
    low, high = axes.get_ylim()
    heights = _spread_out(anchors[order, 1], 0.06 * (high - low))
    width = np.diff(axes.get_xlim())[0]
    for index, height in zip(order, heights, strict=True):
        x, y = anchors[index]
        bend = column_mm - 0.012 * width
        axes.plot([x, bend - 0.03 * width, bend], [y, height, height], color=INK, lw=0.7)
        axes.plot(x, y, "o", color=INK, ms=2.5)
        axes.plot(column_mm + 0.004 * width, height, "s", color=colours[index], ms=10, mec=INK, mew=0.5)
        axes.text(column_mm + 0.022 * width, height, names[index], fontsize=12, color=INK, va="center")


def _spread_out(heights: Floats, gap: float) -> Floats:
    """Heights (n,), rising, moved apart to at least gap while keeping near their places."""
    result = heights.astype(float)
    for _ in range(100):
        short = gap - np.diff(result)
        if (short <= 1e-9 * gap).all():
            break
        push = np.maximum(short, 0) / 2
        result[:-1] -= push
        result[1:] += push
    return result


def colour_bar(figure: Any, low: float, high: float, label: str, extend: str = "neither") -> None:
    """A colour bar of the common colour map at the right of the page."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar_axes = figure.add_axes((0.82, 0.2, 0.025, 0.55))
    bar = figure.colorbar(ScalarMappable(Normalize(low, high), COLOUR_MAP), cax=bar_axes, extend=extend)
    bar.set_label(label, fontsize=12, color=INK)
    bar.ax.tick_params(labelsize=11, colors=INK)


COLOUR_MAP = "viridis"
DIVERGING = "RdBu_r"
"""For signed quantities, white at zero."""
"""Even to the eye, readable in grey and by the colour-blind."""
