"""Which design parameters put designs in the right order: rank correlation over samples, fit and held-out halves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.beyond.designs import papers_variables, sample
from softdot.studies.paper.beyond.predictors import clamped_voltage_V, columns, free_voltage_V, papers_parameters
from softdot.studies.paper.beyond.trials import BOUNDARIES, DesignTrial, solve_trials
from softdot.studies.paper.segment import Boundary

SLICE_MESH = {"element_size_mm": 0.4, "contact_element_size_mm": 0.2, "mesher": "layered"}
"""Within 2 % of the study's finer mesh on the paper's final design."""
COUNT_LOG2, SEEDS = 6, (1, 2)
FOUR, SEVEN = "the paper's four variables", "all seven variables"
CORRECTED, WITHOUT_FILM = "corrected", "corrected, film not stiff"
BOOTSTRAPS = 1000
START = {"tension_share": 0.2, "give": 0.5, "rest": 0.3}


@dataclass(frozen=True)
class Halves:
    """A sample, cut in two: what the constants are fitted to, and what never touched a fit."""

    fitted: Sequence[DesignTrial]
    held_out: Sequence[DesignTrial]


@dataclass(frozen=True)
class Ranking:
    """What was found."""

    samples: Mapping[str, Halves]
    asked: int
    """Designs asked for; the rest did not converge."""
    constants: Mapping[str, float]
    """tension_share, give, rest of the corrected parameters."""
    constants_without_film: Mapping[str, float]
    """give and rest fitted again without the film's membrane stiffness."""


def rank(progress: Progress, executor: Executor) -> Ranking:
    """Press two space-filling samples in cross-section and fit the corrected parameters to one half of each."""
    designs = {FOUR: papers_variables(COUNT_LOG2, SEEDS[0]), SEVEN: sample(COUNT_LOG2, SEEDS[1])}
    samples = {}
    for name, asked in designs.items():
        half = len(asked) // 2  # the halves of a Sobol sequence fill the space evenly too
        trials = solve_trials(asked, "plane-strain", SLICE_MESH, progress, executor)
        fitted = set(asked[:half])
        samples[name] = Halves(
            [trial for trial in trials if trial.design in fitted],
            [trial for trial in trials if trial.design not in fitted],
        )
    training = [trial for halves in samples.values() for trial in halves.fitted]
    return Ranking(samples, sum(map(len, designs.values())), fit(training, 1.0), fit(training, 0.0))


def fit(trials: Sequence[DesignTrial], film_stiffness: float) -> dict[str, float]:
    """Constants with the least squares of the logarithm of predicted over solved voltage."""
    from scipy.optimize import least_squares

    c = columns([trial.design for trial in trials])
    free, clamped = voltages(trials, "free"), voltages(trials, "clamped")

    def residuals(logarithms: Floats) -> Floats:
        tension_share, give, rest = np.exp(logarithms)
        predicted = [free_voltage_V(c, tension_share), clamped_voltage_V(c, give, rest, film_stiffness)]
        return np.asarray(np.log(np.concatenate(predicted) / np.concatenate([free, clamped])))

    best = np.exp(least_squares(residuals, np.log(list(START.values()))).x)
    return dict(zip(START, map(float, best), strict=True))


def voltages(trials: Sequence[DesignTrial], boundary: Boundary) -> Floats:
    """Open-circuit voltages (n,)."""
    presses = [trial.presses[BOUNDARIES.index(boundary)] for trial in trials]
    return np.array([press.voltage_V for press in presses])


def predicted_V(
    trials: Sequence[DesignTrial], boundary: Boundary, ranking: Ranking, film_stiffness: float = 1.0
) -> Floats:
    """Voltages (n,) by the corrected parameters."""
    c = columns([trial.design for trial in trials])
    constants = ranking.constants if film_stiffness else ranking.constants_without_film
    if boundary == "free":
        return free_voltage_V(c, constants["tension_share"])
    return clamped_voltage_V(c, constants["give"], constants["rest"], film_stiffness)


def correlations(ranking: Ranking, sample_name: str, boundary: Boundary) -> dict[str, float]:
    """Spearman's rank correlation with the solved voltage on the held-out half, for every parameter."""
    trials = ranking.samples[sample_name].held_out
    solved = voltages(trials, boundary)
    found = papers_parameters([trial.design for trial in trials])
    found[CORRECTED] = predicted_V(trials, boundary, ranking)
    if boundary == "clamped":
        found[WITHOUT_FILM] = predicted_V(trials, boundary, ranking, 0.0)
    return {name: spearman(values, solved) for name, values in found.items()}


def spearman(first: Floats, second: Floats) -> float:
    """Spearman's rank correlation of (n,) with (n,)."""
    from scipy.stats import spearmanr

    return float(spearmanr(first, second).statistic)


def interval(first: Floats, second: Floats) -> list[float]:
    """95 % interval of the rank correlation of pairs by the bootstrap."""
    from scipy.stats import rankdata

    random, count = np.random.default_rng(0), len(first)
    draws = random.integers(0, count, (BOOTSTRAPS, count))
    ranks = [rankdata(values[draws], axis=1) for values in (first, second)]
    a, b = (each - each.mean(axis=1, keepdims=True) for each in ranks)
    correlation = (a * b).sum(axis=1) / np.sqrt((a**2).sum(axis=1) * (b**2).sum(axis=1))
    return [float(value) for value in np.quantile(correlation, [0.025, 0.975])]


def scatter(trials: Sequence[DesignTrial], boundary: Boundary, ranking: Ranking, film_stiffness: float = 1.0) -> float:
    """Typical factor between predicted and solved voltage: exp of the rms of the logarithm of their ratio."""
    ratio = np.log(predicted_V(trials, boundary, ranking, film_stiffness) / voltages(trials, boundary))
    return float(np.exp(np.sqrt(np.mean(ratio**2))))
