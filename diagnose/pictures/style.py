"""Colours, size and frame of all pictures of a diagnosis."""

from pathlib import Path
from typing import Any

RECORDED, BEFORE, AFTER, FULL, SOFT = "#26303a", "#b5263b", "#2f7a4d", "#d08a00", "#8a949e"
"""Colours: what was recorded, your simulation, with what was left out, by the full model, what matters less."""
CLOSEST = "#3a6ea8"
"""Colour of an explanation that is not named."""
WIDTH_IN, DPI = 8.0, 130


def new_figure(rows: int, columns: int, height_in: float, **subplots: Any) -> tuple[Any, Any]:
    """A figure and its panels (rows, columns)."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    engine = ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.05)
    figure = Figure(figsize=(WIDTH_IN, height_in), dpi=DPI, facecolor="white", layout=engine)
    panels = figure.subplots(rows, columns, squeeze=False, **subplots)
    for panel in panels.flat:
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelsize=9)
    return figure, panels


def save(figure: Any, path: Path) -> Path:
    """Write a figure as PNG and return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path
