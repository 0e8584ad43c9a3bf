"""A linear Gaussian model in sums: residual = columns @ parameters + white noise, parameters ~ N(0, prior_sigma^2).

Sums over presses add, so that every leave-one-out fit costs one small factorisation (Bishop, Pattern Recognition and
Machine Learning, 2006, sections 3.3 and 3.5).
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from foundation.arrays import Floats


@dataclass(frozen=True)
class Sums:
    """Sums of a linear model with k columns, which add over presses.

    gram : (k, k) products of the columns with each other. moment : (k,) their products with the residual. square : sum
    of squares of the residual. samples : number of samples.
    """

    gram: Floats
    moment: Floats
    square: float
    samples: int

    @classmethod
    def from_columns(cls, columns: Floats, residual: Floats) -> Self:
        """Sums of whitened columns (n, k) and residual (n,)."""
        return cls(columns.T @ columns, columns.T @ residual, float(residual @ residual), len(residual))

    def __add__(self, other: "Sums") -> "Sums":
        return Sums(
            self.gram + other.gram, self.moment + other.moment, self.square + other.square, self.samples + other.samples
        )

    def log_evidence(self, prior_sigma: Floats) -> float:
        """Logarithm of the density of the residual with the parameters integrated out.

        prior_sigma : (k,), inf for a parameter without a prior: a flat one of density 1, which cancels in differences.
        ValueError where such a parameter leaves no trace.
        """
        free = np.isinf(prior_sigma)
        factor, scale = self._factor(prior_sigma)
        moment = scale * self.moment
        explained = float(moment @ cho_solve((factor, True), moment))
        log_scale = float(np.log(np.diag(factor)).sum())
        count = self.samples - int(free.sum())
        return -0.5 * (self.square - explained + count * float(np.log(2.0 * np.pi))) - log_scale

    def mean(self, prior_sigma: Floats) -> Floats:
        """Posterior mean (k,) of the parameters; prior_sigma and errors as in log_evidence."""
        factor, scale = self._factor(prior_sigma)
        return np.asarray(scale * cho_solve((factor, True), scale * self.moment))

    def _factor(self, prior_sigma: Floats) -> tuple[Floats, Floats]:
        """Cholesky factor (k, k) of 1 + D X'X D, and the diagonal (k,) of D; no 1 for a parameter without a prior."""
        free = np.isinf(prior_sigma)
        scale = np.where(free, 1.0, prior_sigma)
        precision = np.diag(np.where(free, 0.0, 1.0)) + scale[:, None] * self.gram * scale
        try:
            return np.tril(cho_factor(precision, lower=True)[0]), scale
        except np.linalg.LinAlgError:
            raise ValueError("a parameter without a prior is not determined by these presses") from None
