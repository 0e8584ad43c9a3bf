"""One quantity of a family over its designs, at every load step, with an interval from presses that were left out."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats
from softdot.families.gradient_process import GradientProcess, Scales

LEVEL = 0.95
"""Share of designs whose whole course is to be within the interval."""
LARGEST_LOG_RATIO = 1e3
"""Largest over least value of a step whose logarithm is taken."""
LEAST_SHARE = 0.5
"""Deviation that is added everywhere, over the median of that of presses left out: an error of the contact, which moves
over the mesh from node to node, remains near a press too (as in the conformal regression of Papadopoulos, Vovk and
Gammerman, J. Artif. Intell. Res. 40, 2011).
"""
MOST_AT_ONCE = 2048
"""Designs that are answered at once, so that they fit into memory."""
STEADY = 1e-10
"""Relative difference up to which a step is the same for all designs."""


class QuantityCourse(NamedTuple):
    """Value, low and high end of the interval, each (q, s), and slopes (q, d, s) by the place."""

    value: Floats
    low: Floats
    high: Floats
    slopes: Floats


@dataclass(frozen=True)
class Forms:
    """How each step (s,) is modelled. sign : of its logarithm, 0 where it is not taken; size : unit of a plain step;
    moving : not the same for all designs.
    """

    sign: Floats
    size: Floats
    moving: NDArray[np.bool_]

    @classmethod
    def of(cls, values: Floats) -> "Forms":
        """Those of the values (n, s) of presses."""
        size = np.abs(values).max(axis=0)
        least = np.abs(values).min(axis=0)
        one_sign = (np.sign(values) == np.sign(values[0])).all(axis=0) & (least > 0.0)
        sign = np.where(
            one_sign & (size < LARGEST_LOG_RATIO * np.where(least > 0.0, least, 1.0)), np.sign(values[0]), 0.0
        )
        moving = np.ptp(values, axis=0) > STEADY * size
        return cls(sign, np.where(size > 0.0, size, 1.0), moving)

    def modelled(self, values: Floats) -> Floats:
        """What is modelled of values (n, s)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.sign != 0.0, np.log(values * self.sign), values / self.size)

    def modelled_slopes(self, values: Floats, slopes: Floats) -> Floats:
        """Slopes (n, d, s) of what is modelled, from those of values (n, s)."""
        over = np.where(self.sign != 0.0, values, self.size)
        return np.asarray(slopes / over[:, None, :])

    def value(self, modelled: Floats) -> Floats:
        """Values (q, s) again."""
        with np.errstate(over="ignore"):
            return np.where(self.sign != 0.0, self.sign * np.exp(modelled), modelled * self.size)


class FamilyQuantity:
    """A quantity from its values (n, s) and slopes (n, d, s), None without, at places (n, d).

    scores (n,) : of each press left out, its largest error over the deviation of any step. factor : of the deviation,
    so that the interval holds for whole courses left out. scales, start : as of GradientProcess.
    """

    def __init__(
        self,
        places: Floats,
        values: Floats,
        slopes: Floats | None,
        scales: Scales | None = None,
        start: Scales | None = None,
    ) -> None:
        self.places, self.values, self.slopes = places, values, slopes
        self.forms = Forms.of(values)
        self._moving = np.flatnonzero(self.forms.moving)
        self.process: GradientProcess | None = None
        self.scores, self.floor = np.zeros(0), np.zeros(0)
        if len(self._moving):
            modelled = self.forms.modelled(values)[:, self._moving]
            sloped = None
            if slopes is not None:
                sloped = self.forms.modelled_slopes(values, slopes)[:, :, self._moving]
            self.process = GradientProcess(places, modelled, sloped, scales, start)
            left = self.process.left_out()
            self.floor = LEAST_SHARE * np.median(left.deviation, axis=0)
            self.scores = (np.abs(left.error) / np.maximum(left.deviation + self.floor, 1e-12)).max(axis=1)
        self.factor = conformal_factor(self.scores)

    def course(self, places: Floats) -> QuantityCourse:
        """Value, interval and slopes at places (q, d)."""
        parts = [self._course(places[start : start + MOST_AT_ONCE]) for start in range(0, len(places), MOST_AT_ONCE)]
        return parts[0] if len(parts) == 1 else QuantityCourse(*map(np.concatenate, zip(*parts, strict=True)))

    def _course(self, places: Floats) -> QuantityCourse:
        steps = self.values.shape[1]
        modelled = np.repeat(self.forms.modelled(self.values[:1]), len(places), axis=0)
        spread, slopes = np.zeros((len(places), steps)), np.zeros((len(places), places.shape[1], steps))
        if self.process is not None:
            found = self.process.predict(places)
            modelled[:, self._moving], slopes[:, :, self._moving] = found.mean, found.slopes
            spread[:, self._moving] = self.factor * (found.deviation + self.floor)
        value = self.forms.value(modelled)
        ends = [self.forms.value(modelled - spread), self.forms.value(modelled + spread)]
        over = np.where(self.forms.sign != 0.0, value, self.forms.size)
        return QuantityCourse(value, np.minimum(*ends), np.maximum(*ends), slopes * over[:, None, :])

    def course_values(self, places: Floats) -> Floats:
        """Values (q, s) alone at places (q, d)."""
        modelled = np.repeat(self.forms.modelled(self.values[:1]), len(places), axis=0)
        if self.process is not None:
            modelled[:, self._moving] = self.process.mean(places)
        return self.forms.value(modelled)

    def relative_deviation(self, places: Floats) -> Floats:
        """Deviation (q,) of the last step, over its value or its size; not yet times factor."""
        if self.process is None or not self.forms.moving[-1]:
            return np.zeros(len(places))
        return np.asarray(self.process.deviation(places)[:, -1] + self.floor[-1])

    def relative_errors(self, places: Floats, values: Floats) -> Floats:
        """Errors (q, s) of the value at places (q, d), over the values (q, s) of presses; 0 where those are zero."""
        off = np.abs(self.course_values(places) - values)
        return np.asarray(off / np.where(values != 0.0, np.abs(values), np.inf))


def conformal_factor(scores: Floats, level: float = LEVEL) -> float:
    """What the score of a further press stays below with a probability of level, from the scores (n,) of n.

    The quantile of a sample of n that a further one exceeds with the asked probability (Vovk, Gammerman and Shafer,
    Algorithmic learning in a random world, 2005), the largest where the sample is too small for it. With the largest
    score of a course it holds for the course as a whole (Diquigiovanni, Fontana and Vantini, J. Multivar. Anal. 189,
    2022, 104879).

    >>> conformal_factor(np.arange(1.0, 40.0))
    38.0
    """
    if not scores.size:
        return 1.0
    count = len(scores)
    share = min(np.ceil(level * (count + 1)) / count, 1.0)
    return float(np.quantile(scores, share, method="inverted_cdf"))
