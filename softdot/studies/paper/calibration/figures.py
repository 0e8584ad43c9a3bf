"""Pictures of p: its pieces, the two unknowns that decide, and the signal."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softdot.studies.paper.calibration.contours import RESISTANCES_MOHM, TIMES_S, grid, printed_factor
from softdot.studies.paper.calibration.factor import PIECES, charge_pC, dot_depth, factor
from softdot.studies.paper.calibration.inputs import INPUTS, Values, assumed_inputs
from softdot.studies.paper.calibration.ranges import Ranges, quantiles
from softdot.studies.paper.calibration.readout import chain, depth_fraction, recorded_V, times_s
from softdot.studies.paper.calibration.solved import FOAM, Rig, Solved
from softdot.studies.paper.drawing import CLAMPED, FREE, PAPER, SOFT, label, new_figure, save

COLOURS = {"I": FREE, "II": CLAMPED}
PIECE_COLOURS = dict(zip(PIECES, ("#33658a", "#9dbf9e", "#e7cfa3", "#b5263b", "#8a949e"), strict=True))
LEVELS = (10, 30, 100, 1000)


def title(solved: Solved) -> str:
    """A case for people."""
    return f"case {solved.case.name}: {solved.case.title} on sponge"


def draw_pieces(rig: Rig, spread: Ranges, folder: Path) -> Path:
    """A waterfall on a logarithmic axis: each piece starts where the one before it ended."""
    figure, panels = new_figure(2, height_in=4.2)
    for panel, (name, solved) in zip(panels, rig.items(), strict=True):
        _waterfall(panel, factor(solved, assumed_inputs()).pieces)
        low, middle, high = quantiles(spread.p(name))
        panel.plot([len(PIECES)] * 2, [low, high], color=SOFT, lw=9, alpha=0.6, solid_capstyle="butt")
        panel.plot(len(PIECES), middle, "_", color="white", ms=10, mew=2)
        panel.plot(len(PIECES), printed_factor(name), "D", color=PAPER, ms=7, mfc="white", mew=1.6, label="p printed")
        panel.set_xticks(range(len(PIECES) + 1), [*(piece.replace(" for ", "\nfor ") for piece in PIECES), "p"])
        panel.set_yscale("log")
        panel.set_ylim(0.3, 3000)
        panel.tick_params(axis="x", labelsize=9)
        panel.legend(frameon=False, fontsize=9, loc="upper left")
        label(panel, "", "product so far" if panel is panels[0] else "", title(solved))
    return save(figure, folder, "calibration-pieces")


def _waterfall(panel: Any, pieces: Mapping[str, float]) -> None:
    """One bar a piece, from the product before it to that after it, and the whole product."""
    product = 1.0
    for place, (piece, value) in enumerate(pieces.items()):
        after = product * value
        panel.bar(place, after - product, bottom=product, width=0.62, color=PIECE_COLOURS[piece])
        panel.plot([place - 0.31, place + 1.31], [after, after], color=SOFT, lw=0.8)
        _number(panel, place, max(product, after), f"× {value:.3g}")
        product = after
    panel.axhline(1.0, color=SOFT, lw=0.8)
    panel.plot([len(PIECES) - 0.31, len(PIECES) + 0.31], [product] * 2, color=PAPER, lw=2)
    panel.annotate(f"{product:.3g}", (len(PIECES) + 0.36, product), fontsize=9, va="center")


def _number(panel: Any, place: float, height: float, text: str) -> None:
    panel.annotate(text, (place, height), (0, 3), textcoords="offset points", ha="center", fontsize=9)


def draw_map(rig: Rig, folder: Path) -> Path:
    """Draw p over input resistance and press time, and where it is what the paper prints."""
    figure, panels = new_figure(2, height_in=4.0)
    resistances, times = np.geomspace(*RESISTANCES_MOHM, 24), np.array(TIMES_S)
    possible = INPUTS["resistance_MOhm"]
    for panel, (name, solved) in zip(panels, rig.items(), strict=True):
        found = grid(solved, resistances, times)
        lines = panel.contour(resistances, times, found, LEVELS, colors=SOFT, linewidths=0.9)
        panel.clabel(lines, fmt="%g", fontsize=9)
        panel.contour(resistances, times, found, [printed_factor(name)], colors=COLOURS[name], linewidths=2.6)
        panel.plot([], [], color=COLOURS[name], lw=2.6, label=f"p = {printed_factor(name):g}")
        panel.axvspan(possible.low, possible.high, color=SOFT, alpha=0.12, lw=0, label="R thought possible")
        panel.plot(
            assumed_inputs()["resistance_MOhm"],
            assumed_inputs()["press_time_s"],
            "o",
            color=PAPER,
            ms=6,
            label="assumed",
        )
        panel.set_xscale("log")
        panel.legend(fontsize=9, loc="lower right", framealpha=0.9)
        below, beside = "input resistance R (MΩ)", "press time T (s)" if panel is panels[0] else ""
        label(panel, below, beside, title(solved))
    return save(figure, folder, "calibration-map")


def draw_signal(rig: Rig, folder: Path) -> Path:
    """Film and gauge over one press, as in the paper's Fig. 2."""
    figure, panels = new_figure(2)
    values = assumed_inputs()
    for name, solved in rig.items():
        charge, reached = _press(solved, values)
        voltage = recorded_V(charge, solved.curves[FOAM].capacitance_pF, chain(values))
        panels[0].plot(times_s(), 1e3 * voltage, color=COLOURS[name], label=f"case {name}")
        panels[1].plot(times_s(), reached, color=COLOURS[name], label=f"case {name}")
    label(panels[0], "time (s)", "recorded voltage (mV)", "film, after the low-pass")
    label(panels[1], "time (s)", "depth (mm)", "strain gauge")
    panels[0].legend(frameon=False, fontsize=10)
    return save(figure, folder, "calibration-signal")


def _press(solved: Solved, values: Values) -> tuple[Any, Any]:
    """Charge and depth over one period."""
    real = solved.curve(FOAM, values)
    reached = dot_depth(real, solved.case.depth_mm, values)
    return charge_pC(real, reached, values["press_time_s"]), reached * depth_fraction(values["press_time_s"])


def draw_outputs(rig: Rig, folder: Path) -> Path:
    """Normalised output as in the paper's Figs. 3 and 4."""
    figure, panels = new_figure(2)
    found = {name: factor(solved, assumed_inputs()).outputs_V_per_mm for name, solved in rig.items()}
    for panel, place, scale, unit in ((panels[0], -1, 1e3, "mV/mm"), (panels[1], 0, 1.0, "V/mm")):
        heights = [scale * outputs[place] for outputs in found.values()]
        drawn = panel.bar([f"case {name}" for name in found], heights, color=list(COLOURS.values()), width=0.5)
        panel.bar_label(drawn, [f"{height:.3g}" for height in heights], fontsize=10, padding=2)
        panel.margins(y=0.15)
        label(panel, "", f"D = ΔV / u₂ ({unit})", "recorded (Fig. 3)" if place else "simulated (Fig. 4)")
    return save(figure, folder, "calibration-outputs")
