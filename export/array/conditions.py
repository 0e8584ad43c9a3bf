"""Picture of a study of reading: errors against each condition, with the limit."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from export.view import DPI, INK, save_png

MOST_COLUMNS = 3
UNIT_TEXTS = {"mm_per_s": "mm/s", "mm": "mm", "mV": "mV", "deg": "°", "N": "N", "um": "µm", "Hz": "Hz", "s": "s"}


def draw_conditions(
    curves: Mapping[str, Sequence[tuple[float, float, float, float]]],
    accuracy: float,
    limits: Mapping[str, float | None],
    path: Path,
) -> None:
    """Draw the characters not read, in %, over each condition, and write a PNG.

    curves : name of the condition -> rows of its value, the share of characters read, and both ends of its interval.
    accuracy : the share that is asked for. limits : name -> the value up to which it is reached, or None.
    """
    from matplotlib.figure import Figure

    lines = -(-len(curves) // MOST_COLUMNS)
    figure = Figure(figsize=(12.0, 3.2 * lines), dpi=DPI, facecolor="white", layout="constrained")
    cells = figure.subplots(lines, MOST_COLUMNS, squeeze=False).flat
    for axes, (name, rows) in zip(cells, curves.items(), strict=False):
        value, share, low, high = np.array(rows).reshape(-1, 4).T
        error = 100.0 * (1.0 - share)
        bars = np.maximum(100.0 * np.array([high - share, share - low]), 0.0)
        axes.errorbar(value, error, yerr=bars, fmt="o-", ms=4, lw=1.4, color=INK, ecolor="#9aa5b1")
        axes.axhline(100.0 * (1.0 - accuracy), color="#c0392b", lw=1.0, ls="--")
        if limits.get(name) is not None:
            axes.axvline(limits[name], color="#2a7f62", lw=1.2)
        axes.set_xlabel(_axis_label(name), fontsize=11, color=INK)
        axes.set_ylabel("characters not read (%)", fontsize=10, color=INK)
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
        top = max(10.0, 1.1 * float(error.max(initial=0.0)))
        axes.set_ylim(-0.03 * top, top)
    for axes in list(figure.axes)[len(curves) :]:
        axes.set_axis_off()
    save_png(figure, path)


def _axis_label(name: str) -> str:
    """Label of an axis, such as speed (mm/s) for speed_mm_per_s."""
    for ending, unit in UNIT_TEXTS.items():
        if name.endswith(f"_{ending}"):
            return f"{name.removesuffix(f'_{ending}').replace('_', ' ')} ({unit})"
    return name.replace("_", " ")
