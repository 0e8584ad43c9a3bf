"""Tables of the part beyond the paper."""

from collections.abc import Mapping, Sequence

from softdot.studies.paper.beyond.comparison import MODELS
from softdot.studies.paper.beyond.designs import PAPERS, Design
from softdot.studies.paper.beyond.elastic_sides import WALLS, Curve
from softdot.studies.paper.beyond.ranking import CORRECTED, WITHOUT_FILM, Ranking, correlations
from softdot.studies.paper.beyond.search import CABLE_PF
from softdot.studies.paper.beyond.trials import BOUNDARIES, DesignTrial
from softdot.studies.paper.section import Cell, PaperTable


def sides(curves: Mapping[str, Curve]) -> PaperTable:
    """Table of the voltages between free and clamped that cases of different materials would give."""
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
    """Table of every press of the comparison."""
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


def named_designs(optima: Sequence[Design], goals: Sequence[str]) -> dict[str, Design]:
    """Compared designs by their names."""
    return {"the paper's": PAPERS, **{f"best, {goal}": design for goal, design in zip(goals, optima, strict=True)}}


def _digits(value: float) -> float:
    return float(f"{value:.3g}")


def _two(value: float | None) -> float | None:
    return None if value is None else round(value, 2)
