"""Nuisances taken out of residual and sensitivities, so that they no longer show.

residual = tangent @ nuisance + white noise, nuisance ~ N(0, prior_sigma^2). The marginal covariance is 1 + T P T'; its
symmetric root is applied through the singular values of T P^(1/2) (Rasmussen and Williams, Gaussian Processes for
Machine Learning, 2006, appendix A.3). An infinite prior_sigma is the orthogonal projection, with the restricted
likelihood (Harville, Biometrika 61 (1974) 383).
"""

import numpy as np

from foundation.arrays import Floats


def orthonormal_basis(columns: Floats) -> Floats:
    """Orthonormal basis (n, r) of the span of columns (n, k); columns of any length count alike."""
    length = np.linalg.norm(columns, axis=0)
    unit = columns[:, length > 0.0] / length[length > 0.0]
    basis, spread, _ = np.linalg.svd(unit, full_matrices=False)
    return np.asarray(basis[:, spread > np.finfo(float).eps * max(columns.shape)])


class Marginal:
    """A map that whitens signals by the covariance of noise and nuisances together.

    free : (n, f) orthonormal directions that are lost to nuisances without a prior. degrees : n - f, the number of
    directions that are left. log_scale : half the logarithm of the determinant of the covariance in those directions.
    """

    def __init__(self, tangent: Floats, prior_sigma: Floats) -> None:
        """Prepare the map. tangent : (n, p) whitened sensitivities to the nuisances.

        prior_sigma : (p,), inf for a free nuisance.
        """
        unbounded = np.isinf(prior_sigma)
        self.free = orthonormal_basis(tangent[:, unbounded])
        self.degrees: int = len(tangent) - self.free.shape[1]
        bounded = self._without_free(tangent[:, ~unbounded] * prior_sigma[~unbounded])
        self._directions, spread, _ = np.linalg.svd(bounded, full_matrices=False)
        self._shrink = 1.0 / np.sqrt(1.0 + spread**2) - 1.0
        self.log_scale = 0.5 * float(np.log1p(spread**2).sum())

    def __call__(self, values: Floats) -> Floats:
        """Values (n,) or (n, k) in units of the marginal noise; a white residual comes out white but for `free`."""
        left = self._without_free(values)
        return np.asarray(left + self._directions @ (self._shrink * (self._directions.T @ left).T).T)

    def log_density(self, residual: Floats) -> float:
        """Natural logarithm of the marginal normal density of a residual (n,), in the directions that are left."""
        white = self(residual)
        return -0.5 * (float(white @ white) + self.degrees * float(np.log(2.0 * np.pi))) - self.log_scale

    def _without_free(self, values: Floats) -> Floats:
        return np.asarray(values - self.free @ (self.free.T @ values))
