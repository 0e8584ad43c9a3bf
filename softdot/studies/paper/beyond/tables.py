"""Tables of this part.

The figures of this part.

Statements of the paper, and about it, that these presses decide.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from softdot.studies.paper.beyond.designs import BOUNDARIES, PAPERS, Design, DesignPress, DesignTrial
from softdot.studies.paper.beyond.ranking import (
    CORRECTED,
    WITHOUT_FILM,
    Ranking,
    correlations,
    interval,
    predicted_V,
    scatter,
    voltages,
)
from softdot.studies.paper.beyond.search import (
    CABLE_PF,
    FIRST,
    GOALS,
    MESHERS,
    MODELS,
    STIFFNESS_N_PER_MM3,
    WALLS,
    Beyond,
    Curve,
    Search,
    beats,
)
from softdot.studies.paper.published import Boundary
from softdot.studies.paper.section import CLAMPED, FREE, PAPER, SOFT, Cell, Claim, PaperTable, label, new_figure, save


def sides(curves: Mapping[str, Curve]) -> PaperTable:
    """What cases of different materials would give."""
    rows: list[list[Cell]] = []
    for name, curve in curves.items():
        between = [_digits(curve.voltage_at_V(stiffness)) for stiffness in WALLS.values()]
        rows.append([name, _digits(curve.free.voltage_V), *between, _digits(curve.clamped.voltage_V)])
    return PaperTable(
        "sides",
        "Voltage (V) between free and clamped, cross-section, open circuit",
        ["segment", "free", *(f"{words} ({stiffness:.3g} N/mm³)" for words, stiffness in WALLS.items()), "clamped"],
        rows,
        "The stiffness of a wall is its modulus over its thickness.",
    )


def ranks(ranking: Ranking) -> PaperTable:
    """Rank correlations on the held-out halves."""
    columns = [(sample, side) for sample in ranking.samples for side in BOUNDARIES]
    found = [correlations(ranking, *column) for column in columns]
    names = [*(name for name in found[0] if name != CORRECTED), WITHOUT_FILM, CORRECTED]
    return PaperTable(
        "rank-correlations",
        "Spearman's rank correlation with the solved voltage, on designs that no constant was fitted to",
        ["parameter", *(f"{side}, {sample}" for sample, side in columns)],
        [[name, *(_two(each.get(name)) for each in found)] for name in names],
        "1: the parameter puts all designs in the right order; −1: in the reverse order; 0: it says nothing. S_A and "
        "S_B have the correlation of S₂/S₁, but for the sign. S_1 + S_2 is the denominator of Eq. (7), used there for "
        "something else.",
    )


def designs(named: Mapping[str, Design]) -> PaperTable:
    """The designs that are compared."""
    rows: list[list[Cell]] = [
        [name, d.h1_mm, d.e1_MPa, d.h2_mm, d.e2_MPa, d.effector_height_mm, d.effector_MPa, d.film_um]
        for name, d in named.items()
    ]
    heads = ["h₁ (mm)", "E₁ (MPa)", "h₂ (mm)", "E₂ (MPa)", "effector height (mm)", "effector E (MPa)", "film (µm)"]
    return PaperTable("designs", "Designs", ["design", *heads], rows)


def final(compared: Mapping[str, Sequence[DesignTrial]], names: Sequence[str]) -> PaperTable:
    """Every press of the comparison."""
    rows: list[list[Cell]] = []
    for model in MODELS:
        for name, trial in zip(names, compared[model], strict=True):
            for side, press in zip(BOUNDARIES, trial.presses, strict=True):
                numbers = (
                    press.voltage_V, press.voltage_behind_V(CABLE_PF), press.charge_pC, press.force_N,
                    press.film_stress_MPa,
                )  # fmt: skip
                rows.append([model, name, side, *map(_digits, numbers)])
    return PaperTable(
        "design-comparison",
        "The designs at 0.3 mm on finer meshes",
        [
            "model", "design", "sides", "open-circuit voltage (V)", f"voltage behind {CABLE_PF:g} pF (V)",
            "charge (pC)", "force (N)", "largest film stress (MPa)",
        ],
        rows,
        "pytetwild and layered: 2.5 × 2.5 mm under a round dot, two meshers, the same element sizes. Cross-section: "
        "the paper's reading, 16 mm wide under a ridge, in which the search never looked.",
    )  # fmt: skip


def named(optima: Sequence[Design], goals: Sequence[str]) -> dict[str, Design]:
    """Names of the compared designs."""
    return {"the paper's": PAPERS, **{f"best, {goal}": design for goal, design in zip(goals, optima, strict=True)}}


def _digits(value: float) -> float:
    return float(f"{value:.3g}")


def _two(value: float | None) -> float | None:
    return None if value is None else round(value, 2)


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
    """How well each parameter puts the held-out designs in order."""
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
    """What was tried, in order, and where it lies between free and clamped."""
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
    panel.axvline(FIRST + 0.5, color=SOFT, lw=0.8, ls=":")
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
    """Voltage, force and film stress of the compared designs, by both meshers."""
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
        panel.set_xticks(range(len(names)), names, fontsize=9)
        label(panel, "", words)
    panels[0].margins(y=0.5)
    panels[0].legend(frameon=False, fontsize=8, loc="upper left")
    return save(figure, folder, "design-comparison")


def _number(press: DesignPress, name: str) -> float:
    return float(getattr(press, name))


SUM = "S₁ + S₂"
"""No parameter of the paper; its Eq. (7) divides by it."""
PREDICTS = 0.8
"""Rank correlation from which on a parameter is said to predict: it explains two thirds of the order."""


def claims(study: Beyond) -> list[Claim]:
    """All of them."""
    return [
        _papers(study.ranking, "S₂/S₁", "free", "The ratio S₂/S₁ governs the free output"),
        _papers(study.ranking, "S₁b", "clamped", "The bending softness S₁b governs the clamped output"),
        *(_corrected(study.ranking, side) for side in ("free", "clamped")),
        _film(study.ranking),
        *(_better(study, mesher) for mesher in MESHERS),
    ]


def _papers(ranking: Ranking, name: str, side: Boundary, text: str) -> Claim:
    """A statement of the paper."""
    found = {sample: correlations(ranking, sample, side)[name] for sample in ranking.samples}
    evidence = f"Rank correlation on held-out designs: {_list(found)}."
    return Claim(text, min(map(abs, found.values())) >= PREDICTS, evidence)


def _corrected(ranking: Ranking, side: Boundary) -> Claim:
    """Better than every parameter of the paper, on every sample."""
    ours, best, total = {}, {}, {}
    for sample in ranking.samples:
        found = correlations(ranking, sample, side)
        ours[sample], total[sample] = found[CORRECTED], abs(found[SUM])
        others = {name: abs(value) for name, value in found.items() if name not in (CORRECTED, WITHOUT_FILM, SUM)}
        best[sample] = max(others.values())
    return Claim(
        f"The corrected parameter puts {side} designs in a better order than every parameter of the paper",
        all(ours[sample] > best[sample] for sample in ours),
        f"Held out: {_list(ours)}; best of the paper's: {_list(best)}; the plain sum S₁ + S₂: {_list(total)}. "
        f"{_intervals(ranking, side)}",
    )


def _intervals(ranking: Ranking, side: Boundary) -> str:
    words = []
    for halves in ranking.samples.values():
        low, high = interval(predicted_V(halves.held_out, side, ranking), voltages(halves.held_out, side))
        words.append(f"{low:.2f} to {high:.2f}")
    return f"95 % intervals of the corrected one: {', '.join(words)}."


def _film(ranking: Ranking) -> Claim:
    """Order and level with and without the membrane stiffness, each with constants of its own."""
    found = {sample: correlations(ranking, sample, "clamped") for sample in ranking.samples}
    with_film = {sample: each[CORRECTED] for sample, each in found.items()}
    without = {sample: each[WITHOUT_FILM] for sample, each in found.items()}
    factors = [
        {name: scatter(halves.held_out, "clamped", ranking, film) for name, halves in ranking.samples.items()}
        for film in (1.0, 0.0)
    ]
    return Claim(
        "The film's stiffness in its own plane may be left out of the parameters",
        all(factors[1][sample] <= factors[0][sample] for sample in found),
        f"Clamped, held out, rank correlation with it: {_list(with_film)}; without it, fitted again: {_list(without)}. "
        f"Typical factor to the solved voltage with it: {_list(factors[0])}; without it: {_list(factors[1])}.",
    )


def _better(study: Beyond, mesher: str) -> Claim:
    papers, best, *_ = study.compared[mesher]
    return Claim(
        "The design found gives more voltage than the paper's final design in the worse boundary, with no more film "
        "stress and no more force",
        beats(best, papers),
        f"{_numbers(best)} against {_numbers(papers)}.",
        f"true segment, {mesher}",
    )


def _numbers(trial: DesignTrial) -> str:
    return (
        f"{trial.worse_V():.3g} V ({trial.worse_V(CABLE_PF):.3g} V behind {CABLE_PF:g} pF), "
        f"{trial.film_stress_MPa:.3g} MPa, {trial.force_N:.3g} N"
    )


def _list(values: dict[str, float]) -> str:
    return ", ".join(f"{value:.2f} ({name})" for name, value in values.items())
