"""Which design parameters put designs in the right order: rank correlation over samples, fit and held-out halves.

A statistical stand-in for the solver: Gaussian processes of voltage, force and film stress over the designs.
"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.executor import Executor
from softdot.console import Progress
from softdot.studies.paper.beyond.designs import (
    BOUNDARIES,
    Design,
    DesignPress,
    DesignTrial,
    clamped_voltage_V,
    columns,
    coordinates,
    free_voltage_V,
    papers_parameters,
    papers_variables,
    sample,
    solve_trials,
)
from softdot.studies.paper.published import Boundary

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


LEAST_V = 0.01
"""Voltages below are taken as this one, so that there is a logarithm; nobody wants such a design."""
OUTPUTS = 3
NOISE = 2e-3
"""Variance of what another mesh changes, over that between designs."""


@dataclass(frozen=True)
class Guess:
    """Draws of what a press would give. Each (boundaries, draws, n): free, clamped."""

    charge_pC: Floats
    force_N: Floats
    film_stress_MPa: Floats


class Surrogate:
    """One Gaussian process for the logarithm of each number of a press.

    Its features are the logarithms of the variables and of the two voltages by the corrected parameters: where
    there are few designs yet, those parameters carry the trend.
    """

    def __init__(self, trials: Sequence[DesignTrial], constants: dict[str, float]) -> None:
        self.constants = constants
        features = self._features([trial.design for trial in trials])
        self.middle, self.spread = features.mean(axis=0), features.std(axis=0)
        presses = [[trial.presses[side] for trial in trials] for side in (0, 1)]
        self.processes = [[self._fitted(features, target) for target in np.log(_numbers(side)).T] for side in presses]

    def draw(self, designs: Sequence[Design], draws: int, seed: int) -> Guess:
        """Independent draws for each number; the same seed draws the same luck for every design."""
        luck = np.random.default_rng(seed).standard_normal((2, OUTPUTS, draws, 1))
        features = (self._features(designs) - self.middle) / self.spread
        found = np.empty((2, OUTPUTS, draws, len(designs)))
        for side, processes in enumerate(self.processes):
            for output, process in enumerate(processes):
                mean, deviation = process.predict(features, return_std=True)
                found[side, output] = np.exp(mean + luck[side, output] * deviation)
        return Guess(found[:, 0], found[:, 1], found[:, 2])

    def _features(self, designs: Sequence[Design]) -> Floats:
        c, k = columns(designs), self.constants
        trends = [free_voltage_V(c, k["tension_share"]), clamped_voltage_V(c, k["give"], k["rest"])]
        return np.column_stack([coordinates(designs), np.log(trends).T])

    def _fitted(self, features: Floats, target: Floats) -> Any:
        """A linear trend, a smooth deviation from it, and the noise of the meshes."""
        from sklearn.exceptions import ConvergenceWarning
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import ConstantKernel, DotProduct, Matern, WhiteKernel

        trend = ConstantKernel(0.1, (1e-4, 1e2)) * DotProduct(1.0, "fixed")
        deviation = ConstantKernel(0.1, (1e-4, 1e2)) * Matern(3.0, (1.0, 30.0), nu=2.5)
        process = GaussianProcessRegressor(trend + deviation + WhiteKernel(NOISE, "fixed"), normalize_y=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConvergenceWarning)  # a scale at its bound is an answer too
            return process.fit((features - self.middle) / self.spread, target)


def _numbers(presses: Sequence[DesignPress]) -> Floats:
    """Charge, force and film stress (n, 3)."""
    least = [LEAST_V * press.capacitance_pF for press in presses]
    return np.array(
        [
            [max(press.charge_pC, floor), press.force_N, press.film_stress_MPa]
            for press, floor in zip(presses, least, strict=True)
        ]
    )
