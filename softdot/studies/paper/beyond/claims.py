"""Statements of the paper, and about it, that these presses decide."""

from softdot.studies.paper.beyond.comparison import MESHERS, beats
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
from softdot.studies.paper.beyond.search import CABLE_PF
from softdot.studies.paper.beyond.study import Beyond
from softdot.studies.paper.beyond.trials import DesignTrial
from softdot.studies.paper.section import Claim
from softdot.studies.paper.segment import Boundary

SUM = "S₁ + S₂"
"""No parameter of the paper; its Eq. (7) divides by it."""
PREDICTS = 0.8
"""Rank correlation from which on a parameter is said to predict: it explains two thirds of the order."""


def claims(study: Beyond) -> list[Claim]:
    """Claims of the study beyond the paper."""
    return [
        _papers(study.ranking, "S₂/S₁", "free", "The ratio S₂/S₁ governs the free output"),
        _papers(study.ranking, "S₁b", "clamped", "The bending softness S₁b governs the clamped output"),
        *(_corrected_claim(study.ranking, side) for side in ("free", "clamped")),
        _film(study.ranking),
        *(_better(study, mesher) for mesher in MESHERS),
    ]


def _papers(ranking: Ranking, name: str, side: Boundary, text: str) -> Claim:
    """A statement of the paper."""
    found = {sample: correlations(ranking, sample, side)[name] for sample in ranking.samples}
    evidence = f"Rank correlation on held-out designs: {_list(found)}."
    return Claim(text, min(map(abs, found.values())) >= PREDICTS, evidence)


def _corrected_claim(ranking: Ranking, side: Boundary) -> Claim:
    """Claim that the corrected parameter is better than every parameter of the paper, on every sample."""
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
