"""The figures of the part beyond the paper."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from softdot.studies.paper.beyond.comparison import MESHERS
from softdot.studies.paper.beyond.elastic_sides import STIFFNESS_N_PER_MM3, WALLS, Curve
from softdot.studies.paper.beyond.ranking import CORRECTED, WITHOUT_FILM, Ranking, correlations, predicted_V, voltages
from softdot.studies.paper.beyond.search import FIRST_TRIALS, GOALS, Search
from softdot.studies.paper.beyond.trials import BOUNDARIES, DesignPress, DesignTrial
from softdot.studies.paper.drawing import CLAMPED, FREE, PAPER, SOFT, label, new_figure, save

SIDES = dict(zip(BOUNDARIES, (FREE, CLAMPED), strict=True))
SHADES = ("#26303a", "#c98a1b", "#7a4fa3")
NONE, RIGID = STIFFNESS_N_PER_MM3[0] / 30.0, STIFFNESS_N_PER_MM3[-1] * 30.0
"""Where the ends 0 and infinity are drawn on a logarithmic axis."""


def draw_curves(curves: Mapping[str, Curve], folder: Path) -> Path:
    """Voltage and force against the stiffness of the sides."""
    figure, panels = new_figure(2, height_in=4.0)
    for panel, (name, unit) in zip(panels, (("voltage_V", "V"), ("force_N", "N")), strict=True):
        for shade, (words, curve) in zip(SHADES, curves.items(), strict=True):
            values = [getattr(press, name) for press in curve.presses]
            panel.semilogx([NONE, *STIFFNESS_N_PER_MM3, RIGID], values, "-", color=shade, lw=1.8, label=words)
            panel.plot([NONE], values[:1], "o", color=FREE, ms=6)
            panel.plot([RIGID], values[-1:], "s", color=CLAMPED, ms=6)
        for stiffness in WALLS.values():
            panel.axvline(stiffness, color=SOFT, lw=0.8, ls=":")
        panel.set_xticks([NONE, 1.0, 1e2, 1e4, RIGID], ["free", "1", "100", "10⁴", "rigid"])
        panel.minorticks_off()
        panel.set_ylim(bottom=0.0)
        label(panel, "stiffness of the sides (N/mm³)", f"{name.split('_')[0]} at 0.3 mm ({unit})")
    panels[0].legend(frameon=False, fontsize=9, loc="upper left")
    return save(figure, folder, "free-to-clamped")


def draw_correlations(ranking: Ranking, folder: Path) -> Path:
    """Draw how well each parameter puts the held-out designs in order."""
    figure, panels = new_figure(2, height_in=4.2)
    for panel, sample in zip(panels, ranking.samples, strict=True):
        found = {side: correlations(ranking, sample, side) for side in BOUNDARIES}
        names = [*(name for name in found["free"] if name != CORRECTED), WITHOUT_FILM, CORRECTED]
        for shift, side in zip((-0.2, 0.2), BOUNDARIES, strict=True):
            heights = [abs(found[side].get(name, np.nan)) for name in names]
            drawn = panel.barh(np.arange(len(names)) + shift, heights, 0.38, color=SIDES[side], label=side)
            panel.bar_label(drawn, [f"{h:.2f}" if h == h else "" for h in heights], fontsize=8, padding=2)
        panel.set_yticks(range(len(names)), [name.replace(", ", ",\n") for name in names], fontsize=9)
        panel.invert_yaxis()
        panel.set_xlim(0.0, 1.15)
        panel.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0])
        label(panel, "absolute rank correlation", "", sample)
    panels[1].legend(frameon=False, fontsize=9, loc="upper right")
    return save(figure, folder, "rank-correlation")


def draw_predicted(ranking: Ranking, folder: Path) -> Path:
    """Predicted against solved voltage of the held-out designs."""
    figure, panels = new_figure(2, height_in=3.9)
    for panel, side in zip(panels, BOUNDARIES, strict=True):
        for marker, (name, halves) in zip("os", ranking.samples.items(), strict=True):
            solved, predicted = voltages(halves.held_out, side), predicted_V(halves.held_out, side, ranking)
            face = SIDES[side] if marker == "o" else "none"
            panel.loglog(solved, predicted, marker, ms=5, mfc=face, mec=SIDES[side], label=name)
        ends = np.array(panel.get_xlim())
        panel.plot(ends, ends, color=PAPER, lw=1)
        panel.plot(ends, 2 * ends, color=SOFT, lw=0.8, ls=":")
        panel.plot(ends, ends / 2, color=SOFT, lw=0.8, ls=":")
        label(panel, "solved voltage (V)", "predicted voltage (V)" if side == "free" else "", f"{side} sides")
    panels[0].legend(frameon=False, fontsize=9, loc="upper left")
    return save(figure, folder, "predicted-and-solved")


def draw_search(search: Search, folder: Path) -> Path:
    """Draw the designs that were tried, in order, and where they lie between free and clamped."""
    figure, panels = new_figure(2, height_in=4.0)
    _trajectory(panels[0], search)
    _plane(panels[1], search)
    return save(figure, folder, "design-search")


def _trajectory(panel: Any, search: Search) -> None:
    allowed = np.array([search.limits.allow(trial) for trial in search.trials])
    worse = np.array([trial.worse_V() for trial in search.trials])
    numbers = np.arange(1, len(worse) + 1)
    panel.plot(numbers[~allowed], worse[~allowed], "x", color=SOFT, ms=5, label="beyond a limit")
    panel.plot(numbers[allowed], worse[allowed], "o", color=FREE, ms=5, label="within the limits")
    panel.step(numbers, np.maximum.accumulate(np.where(allowed, worse, 0.0)), where="post", color=FREE, lw=1.2)
    panel.axhline(search.papers.worse_V(), color=CLAMPED, lw=1.2, ls="--", label="the paper's final design")
    panel.axvline(FIRST_TRIALS + 0.5, color=SOFT, lw=0.8, ls=":")
    panel.set_ylim(0.0, 2.5 * max(worse[allowed].max(initial=0.0), search.papers.worse_V()))
    label(panel, "design tried", "worse of the two voltages (V)", "open circuit, 3D")
    panel.legend(frameon=False, fontsize=9, loc="upper left")


def _plane(panel: Any, search: Search) -> None:
    """Free against clamped voltage; the worse one grows towards the upper right along the diagonal."""
    for trial in search.trials:
        inside = search.limits.allow(trial)
        panel.loglog(trial.free.voltage_V, trial.clamped.voltage_V, "o" if inside else "x", ms=5,
                     color=FREE if inside else SOFT)  # fmt: skip
    for goal, colour in zip(GOALS, SHADES[1:], strict=True):
        best = search.best(goal)
        panel.plot(best.free.voltage_V, best.clamped.voltage_V, "D", ms=9, mfc="none", mec=colour, mew=1.8,
                   label=f"best, {goal}")  # fmt: skip
    papers = search.papers
    panel.plot(papers.free.voltage_V, papers.clamped.voltage_V, "*", ms=12, color=CLAMPED, label="the paper's")
    ends = np.array([0.1, 100.0])
    panel.plot(ends, ends, color=PAPER, lw=0.8, ls=":")
    panel.set(xlim=(0.2, 60.0), ylim=(0.2, 200.0))
    label(panel, "free: voltage (V)", "clamped: voltage (V)")
    panel.legend(frameon=False, fontsize=9, loc="upper left")


def draw_final(compared: Mapping[str, Sequence[DesignTrial]], names: Sequence[str], folder: Path) -> Path:
    """Draw voltage, force and film stress of the compared designs, by both meshers."""
    figure, panels = new_figure(3, height_in=3.8, width_in=9.5)
    for panel, (name, words) in zip(
        panels,
        (("voltage_V", "voltage (V)"), ("force_N", "force (N)"), ("film_stress_MPa", "film stress (MPa)")),
        strict=True,
    ):
        for k, mesher in enumerate(MESHERS):
            for j, side in enumerate(BOUNDARIES):
                places = np.arange(len(names)) + 0.2 * (2 * j + k - 1.5)
                heights = [_number(trial.presses[j], name) for trial in compared[mesher]]
                panel.bar(places, heights, 0.18, color=SIDES[side], alpha=1.0 if k == 0 else 0.55,
                          label=f"{side}, {mesher}")  # fmt: skip
        panel.set_xticks(range(len(names)), names, fontsize=8)
        label(panel, "", words)
    panels[0].margins(y=0.5)
    panels[0].legend(frameon=False, fontsize=8, loc="upper left")
    return save(figure, folder, "design-comparison")


def _number(press: DesignPress, name: str) -> float:
    return float(getattr(press, name))
