"""How the figures of the study are drawn: colours, sizes, axes."""

from pathlib import Path
from typing import Any

FREE, CLAMPED, PAPER, SOFT = "#33658a", "#b5263b", "#26303a", "#8a949e"
"""Colours: free sides, clamped sides, the paper's own values, what matters less."""
LAYER_COLOURS = {"effector": "#e7cfa3", "medium1": "#9dbf9e", "film": "#b5263b", "medium2": "#b9cfe0"}
WIDTH_IN, HEIGHT_IN, DPI = 8.0, 3.6, 130


def new_figure(columns: int = 1, height_in: float = HEIGHT_IN, width_in: float = WIDTH_IN) -> tuple[Any, list[Any]]:
    """A figure and its axes, side by side."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    engine = ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.08)
    figure = Figure(figsize=(width_in, height_in), dpi=DPI, facecolor="white", layout=engine)
    panels = list(figure.subplots(1, columns, squeeze=False)[0])
    for panel in panels:
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelsize=10)
    return figure, panels


def label(panel: Any, below: str, beside: str, title: str = "") -> None:
    """Axis labels, and a title at the left."""
    panel.set_xlabel(below, fontsize=11)
    panel.set_ylabel(beside, fontsize=11)
    if title:
        panel.set_title(title, fontsize=11, loc="left")


def bars(panel: Any, names: list[str], heights: list[float], colours: list[str], text: str = "{:.3g}") -> None:
    """Bars with their value on top and room above it."""
    drawn = panel.bar(names, heights, color=colours, width=0.62)
    panel.bar_label(drawn, [text.format(height) for height in heights], fontsize=9, padding=2)
    panel.margins(y=0.18)


def save(figure: Any, folder: Path, name: str) -> Path:
    """Write folder/figures/name.png and return its path."""
    path = folder / "figures" / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path
