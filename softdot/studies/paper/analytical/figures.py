"""Figures of the analytical part: the segment, the shares of softness, stretch against bending."""

from pathlib import Path
from typing import Any

from softdot.studies.paper.analytical.composite import bending_stiffness_Nm
from softdot.studies.paper.analytical.softness import shares
from softdot.studies.paper.analytical.stack import FILM, H1_MM, medium1
from softdot.studies.paper.analytical.tables import formula_values
from softdot.studies.paper.drawing import CLAMPED, FREE, LAYER_COLOURS, PAPER, SOFT, bars, label, new_figure, save

LAYERS = (
    ("medium2", "medium 2", 2.0),
    ("film", "film", 0.028),
    ("medium1", "medium 1", 0.8),
    ("effector", "effector", 1.0),
)
"""Key of its colour, name and height in mm, from the base upwards."""


def draw_segment(folder: Path) -> Path:
    """The stack under its dot, with free and with held sides, to scale."""
    figure, panels = new_figure(2, height_in=3.9)
    for panel, held in zip(panels, (False, True), strict=True):
        _stack(panel, held)
    return save(figure, folder, "segment")


def _stack(panel: Any, held: bool) -> None:
    from matplotlib.patches import Circle, Rectangle

    wall: dict[str, Any] = {"facecolor": SOFT, "hatch": "////", "edgecolor": PAPER, "lw": 0}
    bottom = 0.0
    for name, words, height in LAYERS:
        drawn = max(height, 0.05)  # the film would be a hairline
        panel.add_patch(Rectangle((-1.25, bottom), 2.5, drawn, facecolor=LAYER_COLOURS[name], edgecolor=PAPER, lw=0.6))
        where = (1.55, bottom + drawn / 2)
        panel.annotate(words, (1.25, where[1]), where, fontsize=10, va="center")
        if held and name != "medium2":
            for side in (-1.37, 1.25):
                panel.add_patch(Rectangle((side, bottom), 0.12, drawn, **wall))
        bottom += height
    panel.add_patch(Rectangle((-1.45, -0.15), 2.9, 0.15, **wall))
    panel.add_patch(Circle((0, bottom + 1.15), 1.15, facecolor="#d9dde1", edgecolor=PAPER, lw=0.8))
    panel.annotate("dot, pushed down\nby 0.3 mm", (0, bottom + 0.75), ha="center", fontsize=10)
    panel.annotate("", (0, bottom + 0.12), (0, bottom + 0.68), arrowprops={"arrowstyle": "->", "color": PAPER})
    panel.set(xlim=(-1.7, 2.9), ylim=(-0.2, bottom + 1.6), aspect="equal")
    words = "clamped: case holds the sides" if held else "free: only the base is fixed"
    panel.set_title(words, fontsize=11, loc="left")
    panel.axis("off")


def draw_shares(folder: Path) -> Path:
    """S_A and S_B against S_2 / S_1, the free cases marked."""
    import numpy as np

    figure, (panel,) = new_figure(height_in=3.3)
    ratio = np.geomspace(0.1, 1000.0, 200)
    share_a, share_b = np.array([shares(1.0, value) for value in ratio]).T
    panel.semilogx(ratio, share_a, color=FREE, lw=2, label="$S_A$, share of medium 1")
    panel.semilogx(ratio, share_b, color=CLAMPED, lw=2, label="$S_B$, share of medium 2")
    panel.axvspan(0.1, 10.0, color="#eef1f4", zorder=0)
    panel.text(1.0, 1.06, "both count", ha="center", fontsize=10, color=PAPER)
    panel.text(100.0, 1.06, "medium 1 alone", ha="center", fontsize=10, color=PAPER)
    for case, row in formula_values("table3").items():
        x = row["S2/S1"]
        panel.plot(x, shares(1.0, x)[0], "o", color=FREE)
        panel.annotate(case, (x, shares(1.0, x)[0]), (0, 7), textcoords="offset points", ha="center", fontsize=9)
    panel.set_ylim(0, 1.15)
    label(panel, "$S_2 / S_1$", "share of the deflection")
    panel.legend(frameon=False, fontsize=10, loc="center right")
    return save(figure, folder, "softness-shares")


def draw_stiffness(folder: Path) -> Path:
    """Stiffness in the plane and in bending, with and without the film."""
    figure, (plane, bending) = new_figure(2)
    names = ["film", *(f"{h1:g} mm" for h1 in H1_MM)]
    heights = [1e-3 * lamina.membrane_stiffness_N_per_m for lamina in (FILM, *map(medium1, H1_MM))]
    bars(plane, names, heights, [LAYER_COLOURS["film"], *[LAYER_COLOURS["medium1"]] * len(H1_MM)], "{:.3g}")
    label(plane, "film; medium 1 by its thickness", "stiffness in the plane E h (kN/m)", "stretching")
    ratios = [bending_stiffness_Nm([FILM, medium1(h)]) / medium1(h).own_bending_stiffness_Nm for h in H1_MM]
    bars(bending, names[1:], ratios, [SOFT] * len(H1_MM), "{:.2f}")
    bending.axhline(1.0, color=PAPER, lw=1, ls="--")
    label(bending, "thickness of medium 1", "bending stiffness with film / without", "bending")
    return save(figure, folder, "film-stiffness")
