"""Picture of a kernel: what one segment reads of a dot at every place, and the force that the dot takes."""

from pathlib import Path

import numpy as np

from export.view import DIVERGING, DPI, INK, save
from geometry.array.layout import ArrayLayout
from geometry.arrays import Floats

LEVELS = 21


def draw_kernel(
    layout: ArrayLayout, x_mm: Floats, y_mm: Floats, charge_pC: Floats, force_N: Floats, title: str, path: Path
) -> None:
    """Charge of one segment (a, b) and force (a, b) over the place of the dot, with the segments. Writes a PNG."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    figure = Figure(figsize=(9.0, 5.6), dpi=DPI, facecolor="white", layout="constrained")
    largest = float(np.abs(charge_pC).max())
    maps = (
        (f"Charge of {title}, pC", charge_pC, DIVERGING, np.linspace(-largest, largest, LEVELS)),
        ("Force, N", force_N, "viridis", np.linspace(0.0, float(force_N.max()), LEVELS)),
    )
    for axes, (name, values, colours, levels) in zip(figure.subplots(1, 2), maps, strict=True):
        image = axes.contourf(x_mm, y_mm, values.T, levels=levels, cmap=colours)
        for place in layout.places:
            corner = (place.x_mm - layout.size_mm[0] / 2, place.y_mm - layout.size_mm[1] / 2)
            axes.add_patch(Rectangle(corner, *layout.size_mm, fill=False, edgecolor=INK, lw=0.7))
        axes.set(aspect="equal", xlabel="x of the dot (mm)", ylabel="y of the dot (mm)")
        axes.set_title(name, fontsize=11, color=INK)
        figure.colorbar(image, ax=axes, shrink=0.85)
    save(figure, path)
