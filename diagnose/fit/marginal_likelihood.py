"""The log-likelihood of whitened residuals once nuisances are integrated out, as inner products.

With columns T and prior deviations P the covariance is S = 1 + T P^2 T'. S^-1 = 1 - T A^-1 T', A = T'T + P^-2
(Rasmussen and Williams 2006, appendix A.3), so that only the small A is factorised.
"""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from foundation.arrays import Floats

SMALLEST_PRIOR = np.finfo(float).tiny ** 0.25  # whitened: its inverse square stays finite
RELATIVE_RIDGE = 1e-12  # relative to the square of a column's length: parallel columns without a prior


class Quadratic:
    """The quadratic form a' S^-1 b of vectors in the whitened space, with nuisances integrated out."""

    def __init__(self, columns: Floats, sigma: Floats) -> None:
        """Factorise the form. columns : (n, k) whitened. sigma : (k,) prior deviations, inf for none."""
        length = np.where(sigma > 0.0, np.linalg.norm(columns, axis=0), 0.0)
        self._scale = np.where(length > 0.0, length, 1.0)
        self.columns = columns / self._scale
        self.columns[:, length == 0.0] = 0.0
        prior = np.where(length > 0.0, 1.0 / np.maximum(sigma * self._scale, SMALLEST_PRIOR) ** 2 + RELATIVE_RIDGE, 1.0)
        gram = self.columns.T @ self.columns + np.diag(prior)
        self._factor = cho_factor(gram, lower=True)
        known = np.isfinite(sigma) & (length > 0.0)
        self.log_scale = float(np.log(np.diag(self._factor[0])).sum() + np.log((sigma * self._scale)[known]).sum())

    def inner_products(self, a: Floats, b: Floats) -> Floats:
        """Inner products (p, q) of columns (n, p) and (n, q)."""
        return np.asarray(a.T @ b - (self.columns.T @ a).T @ cho_solve(self._factor, self.columns.T @ b))

    def square(self, a: Floats) -> float:
        """Square a' S^-1 a of one vector (n,)."""
        along = self.columns.T @ a
        return float(a @ a - along @ cho_solve(self._factor, along))

    def mean(self, residual: Floats) -> Floats:
        """Posterior mean (k,) of the nuisances given a residual (n,)."""
        return np.asarray(cho_solve(self._factor, self.columns.T @ residual) / self._scale)

    def variances(self) -> Floats:
        """Posterior variances (k,) of the nuisances."""
        inverse = cho_solve(self._factor, np.eye(len(self._scale)))
        return np.asarray(np.diag(inverse) / self._scale**2)

    def apply_inverse(self, a: Floats) -> Floats:
        """Product S^-1 a with vectors (n,) or (n, q)."""
        return np.asarray(a - self.columns @ cho_solve(self._factor, self.columns.T @ a))
