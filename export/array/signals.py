"""Picture of a line under an array: voltages of the first cells, with the cells above."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from export.view import DPI, INK, save_png
from geometry.braille_cells import COLUMN_AND_ROW

CELLS_SHOWN = 16
RIGHT_COLOUR, WRONG_COLOUR = "#1f77b4", "#c0392b"


def draw_signals(signals: Mapping[str, Any], labels: Sequence[str], path: Path) -> None:
    """Draw the voltages of a reading and the cells that were read, and write a PNG.

    signals : time_s (t,), voltage_V (t, n), x_mm, cell_true, cell_read and read_time_s (c,).
    """
    from matplotlib.figure import Figure

    shown = slice(0, CELLS_SHOWN)
    passed = np.asarray(signals["read_time_s"])[shown]
    known = passed[np.isfinite(passed)]
    begin, end = (known[0], known[-1]) if len(known) else (signals["time_s"][0], signals["time_s"][-1])
    pitch = (end - begin) / max(1, len(known) - 1) or 0.5 * (signals["time_s"][-1] - signals["time_s"][0])
    low, high = begin - pitch, end + pitch
    inside = (signals["time_s"] >= low) & (signals["time_s"] <= high)
    time, voltage = signals["time_s"][inside], 1e3 * signals["voltage_V"][inside]
    count = voltage.shape[1]
    figure = Figure(figsize=(12.0, 2.0 + 0.85 * count), dpi=DPI, facecolor="white", layout="constrained")
    cells, *rows = figure.subplots(count + 1, 1, sharex=True, height_ratios=[1.2, *[1.0] * count])
    _draw_cells(cells, signals, shown, pitch)
    most = max(1e-6, 1.05 * float(np.abs(voltage).max(initial=0.0)))
    for axes, label, one in zip(rows, labels, voltage.T, strict=True):
        axes.plot(time, one, lw=0.8, color=INK)
        axes.set_ylim(-most, most)
        axes.set_ylabel(label.removeprefix("segment-"), fontsize=10, color=INK)
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    rows[-1].set_xlabel("time (s)", fontsize=11, color=INK)
    rows[-1].set_xlim(low, high)
    figure.supylabel("voltage (mV)", fontsize=11, color=INK)
    save_png(figure, path)


def _draw_cells(axes: Any, signals: Mapping[str, Any], shown: slice, pitch_s: float) -> None:
    """Draw discs where the read cells have dots; red where the true cell has none, a ring for one that was missed."""
    axes.set_axis_off()
    axes.set(ylim=(2.6, -0.6))
    rows = zip(signals["read_time_s"][shown], signals["cell_true"][shown], signals["cell_read"][shown], strict=True)
    for time, true, read in rows:
        for dot in range(1, 7):
            column, row = COLUMN_AND_ROW[dot]
            written = true < 0 or bool(true >> (dot - 1) & 1)
            found = read >= 0 and bool(read >> (dot - 1) & 1)
            if not found and (true < 0 or not written):
                continue
            colour = RIGHT_COLOUR if written else WRONG_COLOUR
            place = time + 0.3 * pitch_s * (column - 0.5)
            axes.plot([place], [row], "o", ms=6, mfc=colour if found else "none", mec=colour if found else WRONG_COLOUR)
