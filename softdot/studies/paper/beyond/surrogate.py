"""A statistical stand-in for the solver: Gaussian processes of voltage, force and film stress over the designs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from softdot.bayesian_search import fit_process
from softdot.studies.paper.beyond.designs import Design, coordinates
from softdot.studies.paper.beyond.predictors import clamped_voltage_V, columns, free_voltage_V
from softdot.studies.paper.beyond.trials import DesignPress, DesignTrial

LEAST_V = 0.01
"""Voltages below are taken as this one, so that there is a logarithm; nobody wants such a design."""
OUTPUTS = 3
LENGTH, NOISE = (1.0, 3.0, 30.0), 2e-3
"""Over which the deviation from the trend changes, in standard deviations of the features: least, guess, largest.
Variance of what another mesh changes, over that between designs."""


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
        places = (features - self.middle) / self.spread
        presses = [[trial.presses[side] for trial in trials] for side in (0, 1)]
        self.processes = [
            [fit_process(places, target, LENGTH, NOISE) for target in np.log(_numbers(side)).T] for side in presses
        ]

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


def _numbers(presses: Sequence[DesignPress]) -> Floats:
    """Charge, force and film stress (n, 3)."""
    least = [LEAST_V * press.capacitance_pF for press in presses]
    return np.array(
        [
            [max(press.charge_pC, floor), press.force_N, press.film_stress_MPa]
            for press, floor in zip(presses, least, strict=True)
        ]
    )
