"""A statistical stand-in for the solver: Gaussian processes of voltage, force and film stress over the designs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from softdot.families.gradient_process import GradientProcess, Prior
from softdot.studies.paper.beyond.designs import Design, coordinates
from softdot.studies.paper.beyond.predictors import clamped_voltage_V, columns, free_voltage_V
from softdot.studies.paper.beyond.trials import DesignPress, DesignTrial

LEAST_V = 0.01
"""Voltages below are taken as this one, so that there is a logarithm; nobody wants such a design."""
OUTPUTS = 3
PRIOR = Prior(power=1, length=(1.0, 3.0, 30.0), trend=(1e-3, 1.0, 1e4), noise=(1e-6, 1e-2, 1e2))
"""Of features in standard deviations: a linear trend, and noise, which is what another mesh changes."""


@dataclass(frozen=True)
class Guess:
    """Draws of what a press would give. Each (boundaries, draws, n): free, clamped."""

    charge_pC: Floats
    force_N: Floats
    film_stress_MPa: Floats


class Surrogate:
    """A Gaussian process for each boundary, of the logarithms of the numbers of a press.

    Its features are the logarithms of the variables and of the two voltages by the corrected parameters: where
    there are few designs yet, those parameters carry the trend.
    """

    def __init__(self, trials: Sequence[DesignTrial], constants: dict[str, float]) -> None:
        self.constants = constants
        features = self._features([trial.design for trial in trials])
        self.middle, self.spread = features.mean(axis=0), features.std(axis=0)
        places = (features - self.middle) / self.spread
        presses = [[trial.presses[side] for trial in trials] for side in (0, 1)]
        self.processes = [GradientProcess(places, np.log(_numbers(side)), None, prior=PRIOR) for side in presses]

    def draw(self, designs: Sequence[Design], draws: int, seed: int) -> Guess:
        """Independent draws for each number; the same seed draws the same luck for every design."""
        luck = np.random.default_rng(seed).standard_normal((2, OUTPUTS, draws, 1))
        features = (self._features(designs) - self.middle) / self.spread
        told = [(process.mean(features), process.deviation(features)) for process in self.processes]
        mean, deviation = np.array(told).transpose(1, 0, 3, 2)[:, :, :, None]  # (boundaries, outputs, 1, n)
        found = np.exp(mean + luck * deviation)
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
