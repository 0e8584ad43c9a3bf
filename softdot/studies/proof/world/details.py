"""What no rig file states and every rig has a little of: with it, no recording obeys any model exactly.

The stage is not quite where its encoder says, the surface gives way at the first touch, the tester has some play, the
amplifier drifts, and the mains hum faintly. Sizes are drawn for each specimen up to those below, which are what a
careful laboratory lives with; none is a mechanism that a diagnosis should name.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from softdot.studies.proof.world.arrays import Floats

JITTER_MM, JITTER_HZ = 5e-4, (0.3, 6.0)
SOFTNESS_MM = 2e-3
PLAY, PLAY_MM = 3e-3, 0.02
DRIFT = 2e-3
HUM, MAINS_HZ = 5e-4, 50.0
TONES = 5


@dataclass(frozen=True)
class Details:
    """Flaws of a rig. sizes : (5,) of jitter, softness, play, drift and hum, each a share of the largest. seed : of
    phases.
    """

    sizes: tuple[float, ...]
    seed: int

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        """Draw flaws between a third of the largest and the largest."""
        return cls(tuple(rng.uniform(1.0 / 3.0, 1.0, 5).tolist()), int(rng.integers(2**32)))

    def path(self, time: Floats, stage: Floats, run: int) -> Floats:
        """Place of the surface (t,) when the encoder says stage (t,): jitter, then the softness of the first touch."""
        rng = np.random.default_rng([self.seed, run])
        tones, phases = rng.uniform(*JITTER_HZ, TONES), rng.uniform(0.0, 2.0 * np.pi, TONES)
        waves = np.sin(2.0 * np.pi * np.outer(time, tones) + phases).sum(axis=1) * np.sqrt(2.0 / TONES)
        moved, soft = stage + self.sizes[0] * JITTER_MM * waves, self.sizes[1] * SOFTNESS_MM
        return np.asarray(np.where(moved > 0.0, moved - soft * -np.expm1(-np.maximum(moved, 0.0) / soft), moved))

    def force(self, stage: Floats, force: Floats) -> Floats:
        """Force (t,) that the load cell passes on: larger on the way down than on the way up."""
        play = np.zeros(len(stage))
        for n in range(1, len(stage)):
            play[n] = np.clip(play[n - 1] + (stage[n] - stage[n - 1]) / PLAY_MM, -1.0, 1.0)
        return np.asarray(force * (1.0 + self.sizes[2] * PLAY * play))

    def voltage(self, time: Floats, voltage: Floats, peak_V: float, run: int) -> Floats:
        """Voltage (t,) with drift over the run and hum, relative to the largest voltage of the rig."""
        rng = np.random.default_rng([self.seed, run, 1])
        drift = self.sizes[3] * DRIFT * float(rng.standard_normal()) * time / time[-1]
        hum = self.sizes[4] * HUM * np.sin(2.0 * np.pi * MAINS_HZ * time + float(rng.uniform(0.0, 2.0 * np.pi)))
        return np.asarray(voltage + peak_V * (drift + hum))
