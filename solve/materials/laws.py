"""Isotropic hyperelastic laws of the media: W = W_iso(C) + p (J - 1) - p^2 / (2 K).

The volumetric part is the same for all laws: eliminating p gives K (J - 1)^2 / 2 (Holzapfel, Nonlinear Solid
Mechanics, 2000, ch. 6). A law states only the second Piola-Kirchhoff stress S = 2 dW_iso/dC and the material
tangent 4 d2W_iso/dC2, both as six-component (Voigt) arrays.
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from mesh.types import Floats
from solve.materials.isochoric import isochoric_stress
from solve.materials.parameters import Linear, Material, MooneyRivlin, NeoHookean, Yeoh
from solve.materials.voigt import to_voigt

IMPLEMENTED = frozenset({"neo-hookean", "linear", "mooney-rivlin", "yeoh", "piezoelectric-film"})


class MediumLaw(Protocol):
    """What the element needs of a medium."""

    @property
    def bulk_modulus(self) -> float:
        """K, in the unit of stress of the law."""

    @property
    def shear_modulus(self) -> float:
        """Small-strain shear modulus, same unit."""

    def scaled(self, factor: float) -> "MediumLaw":
        """The same law in another unit of stress."""

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""


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

    def scaled(self, factor: float) -> "InvariantLaw":
        """The same law in another unit of stress."""
        return InvariantLaw(*(factor * c for c in (self.c10, self.c01, self.c20, self.c30, self.bulk_modulus)))

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        return isochoric_stress(cauchy_green, np.array([self.c10, self.c01, self.c20, self.c30]))


@dataclass(frozen=True)
class LinearLaw:
    """W_iso = mu E' : E' with the deviator E' of the Green-Lagrange strain: Hooke's law for small strain."""

    shear_modulus: float
    bulk_modulus: float

    def scaled(self, factor: float) -> "LinearLaw":
        """The same law in another unit of stress."""
        return replace(
            self, shear_modulus=factor * self.shear_modulus, bulk_modulus=factor * self.bulk_modulus
        )

    def stress(self, cauchy_green: Floats) -> tuple[Floats, Floats]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        strain = to_voigt(0.5 * (cauchy_green - np.eye(3)), 2.0)
        tangent = self.shear_modulus * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
        tangent[:3, :3] -= self.shear_modulus * 2.0 / 3.0
        return strain @ tangent, np.broadcast_to(tangent, (len(strain), 6, 6))


def bulk_modulus(shear_modulus: float, poisson_ratio: float) -> float:
    """K = 2 G (1 + nu) / (3 (1 - 2 nu)), same unit as the shear modulus."""
    return 2.0 * shear_modulus * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))


def medium_law(material: Material) -> MediumLaw:
    """The law of a medium, in Pa. TypeError for a model that is no medium."""
    if isinstance(material, NeoHookean | Linear):
        shear = 1e6 * material.youngs_modulus_MPa / (2.0 * (1.0 + material.poisson_ratio))
        bulk = bulk_modulus(shear, material.poisson_ratio)
        if isinstance(material, Linear):
            return LinearLaw(shear, bulk)
        return InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk)
    if isinstance(material, MooneyRivlin):
        c10, c01, c20, c30 = 1e6 * material.c10_MPa, 1e6 * material.c01_MPa, 0.0, 0.0
    elif isinstance(material, Yeoh):
        c10, c01, c20, c30 = 1e6 * material.c10_MPa, 0.0, 1e6 * material.c20_MPa, 1e6 * material.c30_MPa
    else:
        raise TypeError(f"{material.model} is not a medium")
    return InvariantLaw(c10, c01, c20, c30, bulk_modulus(2.0 * (c10 + c01), material.poisson_ratio))
