"""Compressible foam (Ogden and Hill): the stress follows from the stretches alone, without a pressure.

    W = sum 2 mu / alpha^2 [l1^alpha + l2^alpha + l3^alpha - 3 + (J^(-alpha beta) - 1) / beta]
with beta = nu / (1 - 2 nu) (Storakers, J. Mech. Phys. Solids 34, 1986, p. 125). nu = 0 is the limit -alpha ln J of
the last term.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import exprel

from foundation.arrays import Floats
from solve.materials.principal_stretches import log_stretches, principal_stress


@dataclass(frozen=True)
class HyperfoamLaw:
    """One value a term: mu in the unit of stress, alpha not zero, beta above -1/3 (nu above -1)."""

    mu: tuple[float, ...]
    alpha: tuple[float, ...]
    beta: tuple[float, ...]

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus, the sum of mu."""
        return sum(self.mu)

    @property
    def bulk_modulus(self) -> float:
        """Small-strain bulk modulus, the sum of 2 mu (beta + 1/3)."""
        return sum(2.0 * m * (b + 1.0 / 3.0) for m, b in zip(self.mu, self.beta, strict=True))

    @property
    def compressible(self) -> bool:
        """True, as the law gives the whole stress and there is no unknown pressure."""
        return True

    def scale_moduli(self, factor: float) -> "HyperfoamLaw":
        """The law with its moduli times a factor, for another unit of stress."""
        return HyperfoamLaw(tuple(factor * m for m in self.mu), self.alpha, self.beta)

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """The whole S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        alpha = np.array(self.alpha)
        return principal_stress(cauchy_green, 2.0 * np.array(self.mu) / alpha, alpha, np.array(self.beta))

    def energy(self, cauchy_green: Floats) -> Floats:
        """The whole W (n,) at C (n, 3, 3)."""
        log = log_stretches(cauchy_green)
        dilation = log.sum(axis=1)
        energy = np.zeros(len(log))
        for m, a, b in zip(self.mu, self.alpha, self.beta, strict=True):
            # (exp(z) - 1) / beta with z = -alpha beta ln J, for beta = 0 too
            volumetric = -a * dilation * exprel(-a * b * dilation)
            energy += 2.0 * m / a**2 * (np.expm1(a * log).sum(axis=1) + volumetric)
        return energy
