"""The range of p over all unknown inputs at once, and which of them makes it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc, rankdata

from foundation.arrays import Floats
from softdot.studies.paper.calibration.factor import PIECES, Factor, factors
from softdot.studies.paper.calibration.inputs import INPUTS
from softdot.studies.paper.calibration.solved import Rig

SAMPLE_EXPONENT = 9
"""2^9 quasi-random samples."""
QUANTILES = (0.05, 0.5, 0.95)


@dataclass(frozen=True)
class Ranges:
    """Results of n samples. shares : (n, k) where in its range each of the k inputs stands, 0 to 1."""

    shares: Floats
    factors: Mapping[str, tuple[Factor, ...]]
    """Case -> one factor a sample."""

    def p(self, case: str) -> Floats:
        """Calibration factor p of every sample (n,)."""
        return np.array([factor.p for factor in self.factors[case]])

    def ratio(self) -> Floats:
        """Ratio (n,) of p of case II to that of case I, both with the same inputs."""
        return self.p("II") / self.p("I")

    def pieces(self, case: str) -> dict[str, Floats]:
        """Piece -> its factor in every sample (n,)."""
        return {piece: np.array([factor.pieces[piece] for factor in self.factors[case]]) for piece in PIECES}

    def drivers(self, case: str) -> dict[str, float]:
        """Input -> square of its rank correlation with p: the part of the spread that it explains alone."""
        target = rankdata(self.p(case))
        columns = zip(INPUTS, self.shares.T, strict=True)
        return {name: float(np.corrcoef(rankdata(column), target)[0, 1]) ** 2 for name, column in columns}


def ranges(rig: Rig, exponent: int = SAMPLE_EXPONENT) -> Ranges:
    """Sobol's quasi-random samples of all inputs, 2^exponent, each evenly over its range."""
    sampler = qmc.Sobol(len(INPUTS), seed=0)
    shares = np.asarray(sampler.random_base2(exponent))
    found = [
        factors(rig, {name: entry.at(share) for (name, entry), share in zip(INPUTS.items(), row, strict=True)})
        for row in shares
    ]
    return Ranges(shares, {case: tuple(each[case] for each in found) for case in rig})


def quantiles(values: Floats) -> tuple[float, float, float]:
    """5 %, median and 95 % of samples (n,)."""
    low, middle, high = np.quantile(values, QUANTILES)
    return float(low), float(middle), float(high)
