"""Isotropic hyperelastic laws of the media: W = W_iso(C) + p (J - 1) - p^2 / (2 K).

The volumetric part is the same for all laws: eliminating p gives K (J - 1)^2 / 2 (Holzapfel, Nonlinear Solid
Mechanics, 2000, ch. 6). A law states only W_iso, the second Piola-Kirchhoff stress S = 2 dW_iso/dC and the material
tangent 4 d2W_iso/dC2, both as six-component (Voigt) arrays. A compressible law (hyperfoam) states the whole W(C).
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from foundation.arrays import Floats
from solve.materials.invariants import Power, isochoric_energy, isochoric_stress
from solve.materials.principal_stretches import log_stretches, principal_stress
from solve.tensors import to_voigt


class MediumLaw(Protocol):
    """Law of a medium, as the element asks for it."""

    def __hash__(self) -> int:
        """Hash of the constants, by which answers of a law are kept."""

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus K in the law's unit of stress."""

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus in the law's unit of stress."""

    @property
    def compressible(self) -> bool:
        """True when stress and energy are whole; False when they are isochoric and the pressure is an unknown."""

    def scale_moduli(self, factor: float) -> "MediumLaw":
        """The law with its moduli times a factor, for another unit of stress."""

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""

    def energy(self, cauchy_green: Floats) -> Floats:
        """Strain energy (n,) per undeformed volume at C (n, 3, 3)."""


@dataclass(frozen=True)
class InvariantLaw:
    """W_iso = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3 + c01 (I2 - 3); invariants of J^(-2/3) C.

    Neo-Hookean: c10 = mu / 2. Mooney-Rivlin: c10, c01. Yeoh: c10, c20, c30.
    """

    c10: float
    c01: float
    c20: float
    c30: float
    bulk_modulus: float

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus."""
        return 2.0 * (self.c10 + self.c01)

    @property
    def compressible(self) -> bool:
        """False, as stress and energy are isochoric and the pressure is an unknown."""
        return False

    def scale_moduli(self, factor: float) -> "InvariantLaw":
        """The law with its moduli times a factor, for another unit of stress."""
        return InvariantLaw(*(factor * c for c in (self.c10, self.c01, self.c20, self.c30, self.bulk_modulus)))

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        return isochoric_stress(cauchy_green, np.array([self.c10, self.c01, self.c20, self.c30]))

    def energy(self, cauchy_green: Floats) -> Floats:
        """W_iso (n,) at C (n, 3, 3)."""
        return isochoric_energy(cauchy_green, np.array([self.c10, self.c01, self.c20, self.c30]))


@dataclass(frozen=True)
class KnowlesLaw:
    """W_iso = c10 / b [(1 + b / n (I1 - 3))^n - 1]; invariant of J^(-2/3) C.

    Knowles, Int. J. Fract. 13, 1977, p. 611. n = 1: neo-Hookean; n = 2: Yeoh's first two terms; an infinite n:
    c10 / b [exp(b (I1 - 3)) - 1], the exponential of Fung (1967) as Demiray (J. Biomech. 5, 1972) has it for rubber.
    """

    c10: float
    power: Power
    bulk_modulus: float

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus."""
        return 2.0 * self.c10

    @property
    def compressible(self) -> bool:
        """False, as stress and energy are isochoric and the pressure is an unknown."""
        return False

    def scale_moduli(self, factor: float) -> "KnowlesLaw":
        """The law with its moduli times a factor, for another unit of stress."""
        return replace(self, c10=factor * self.c10, bulk_modulus=factor * self.bulk_modulus)

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        return isochoric_stress(cauchy_green, np.array([self.c10, 0.0, 0.0, 0.0]), self.power)

    def energy(self, cauchy_green: Floats) -> Floats:
        """W_iso (n,) at C (n, 3, 3)."""
        return isochoric_energy(cauchy_green, np.array([self.c10, 0.0, 0.0, 0.0]), self.power)


@dataclass(frozen=True)
class OgdenLaw:
    """W_iso = sum mu/alpha (l1^alpha + l2^alpha + l3^alpha - 3) in the stretches over J^(1/3).

    Ogden, Proc. R. Soc. Lond. A 326, 1972, p. 565. One value of mu (unit of stress) and of alpha a term.
    """

    mu: tuple[float, ...]
    alpha: tuple[float, ...]
    bulk_modulus: float

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus, half the sum of mu alpha."""
        return 0.5 * float(np.dot(self.mu, self.alpha))

    @property
    def compressible(self) -> bool:
        """False, as stress and energy are isochoric and the pressure is an unknown."""
        return False

    def scale_moduli(self, factor: float) -> "OgdenLaw":
        """The law with its moduli times a factor, for another unit of stress."""
        return OgdenLaw(tuple(factor * m for m in self.mu), self.alpha, factor * self.bulk_modulus)

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        return principal_stress(cauchy_green, np.array(self.mu), np.array(self.alpha))

    def energy(self, cauchy_green: Floats) -> Floats:
        """W_iso (n,) at C (n, 3, 3)."""
        log = log_stretches(cauchy_green)
        log -= log.mean(axis=1, keepdims=True)
        energy = np.zeros(len(log))
        for m, a in zip(self.mu, self.alpha, strict=True):
            if a != 0.0:  # the term vanishes with alpha: the logarithms sum to zero
                energy += m / a * np.expm1(a * log).sum(axis=1)
        return energy


@dataclass(frozen=True)
class LinearLaw:
    """W_iso = mu E' : E' with the deviator E' of the Green-Lagrange strain: Hooke's law for small strain."""

    shear_modulus: float
    bulk_modulus: float

    @property
    def compressible(self) -> bool:
        """False, as stress and energy are isochoric and the pressure is an unknown."""
        return False

    def scale_moduli(self, factor: float) -> "LinearLaw":
        """The law with its moduli times a factor, for another unit of stress."""
        return replace(self, shear_modulus=factor * self.shear_modulus, bulk_modulus=factor * self.bulk_modulus)

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        strain = to_voigt(0.5 * (cauchy_green - np.eye(3)), 2.0)
        tangent = self.shear_modulus * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
        tangent[:3, :3] -= self.shear_modulus * 2.0 / 3.0
        return strain @ tangent, np.broadcast_to(tangent, (len(strain), 6, 6))

    def energy(self, cauchy_green: Floats) -> Floats:
        """W_iso (n,) at C (n, 3, 3)."""
        strain = 0.5 * (cauchy_green - np.eye(3))
        trace = np.trace(strain, axis1=1, axis2=2)
        energy: Floats = self.shear_modulus * (np.einsum("nij,nij->n", strain, strain) - trace**2 / 3.0)
        return energy


def bulk_modulus(shear_modulus: float, poisson_ratio: float) -> float:
    """K = 2 G (1 + nu) / (3 (1 - 2 nu)), same unit as the shear modulus."""
    return 2.0 * shear_modulus * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))
