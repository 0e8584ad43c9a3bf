"""Homogeneous deformations of a coupon, and what a tester reads of them.

With the second Piola-Kirchhoff stress T = S + p J C^-1, p = K (J - 1) (S the whole stress and p = 0 for a foam):
    tension, compression : F = diag(l, m, m), nominal stress l T11, lateral faces free: T22 = 0; unknown ln l, ln J
    shear                : F = 1 + g e1 x e2 between plates at a fixed distance: J = 1, p without effect on the
                           nominal shear stress S12 + g S22; unknown g
(Holzapfel, Nonlinear Solid Mechanics, 2000, chapters 3 and 6.)
"""

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from diagnose.signals.recording import Specimen
from foundation.arrays import Floats


@dataclass(frozen=True)
class TesterReading:
    """Reading of a tester, with derivatives: force (t,) in N, travel (t,) in mm and lateral stress (t, k) in MPa.

    ..._stress (t, ..., 6) : by the stress S; ..._unknown (t, ..., m) : by the unknowns at fixed S.
    """

    force: Floats
    force_stress: Floats
    force_unknown: Floats
    travel: Floats
    travel_unknown: Floats
    lateral: Floats
    lateral_stress: Floats
    lateral_unknown: Floats


class Kinematics(Protocol):
    """A family of homogeneous deformations with m unknowns.

    lateral : at constant volume a principal stretch across is that along the load to the power of -lateral.
    """

    lateral: ClassVar[float]

    @property
    def length_mm(self) -> float:
        """Length that divides the travel: gauge length, or thickness of a layer."""

    @property
    def area_mm2(self) -> float:
        """Area on which the force acts, undeformed."""

    def initial_unknowns(self, travel_mm: Floats, poisson_ratio: float) -> Floats:
        """Unknowns (t, m) near those at a travel (t,) in mm, from which an iteration starts."""

    def principal_stretch(self, unknown: Floats) -> float:
        """Principal stretch along the load at the unknowns (m,) of one sample."""

    def cauchy_green(self, unknown: Floats) -> Floats:
        """Right Cauchy-Green tensor C (t, 3, 3) at unknowns (t, m)."""

    def strain_derivatives(self, unknown: Floats) -> Floats:
        """Derivative (t, 6, m) of the Green-Lagrange strain, with engineering shears, by the unknowns (t, m)."""

    def tester_reading(self, unknown: Floats, stress: Floats, bulk_modulus: float) -> TesterReading:
        """Force, travel and lateral stress at unknowns (t, m) and stress S (t, 6); bulk_modulus 0 for a foam."""


@dataclass(frozen=True)
class Uniaxial:
    """Tension or compression with free sides.

    sign : 1 in tension, -1 in compression; travel and force are positive in both.
    """

    lateral: ClassVar[float] = 0.5
    sign: float
    length_mm: float
    area_mm2: float

    def initial_unknowns(self, travel_mm: Floats, poisson_ratio: float) -> Floats:
        """Unknowns ln l and ln J (t, 2): the volume of rubber hardly changes, whatever the stretch."""
        along = np.log(np.maximum(1.0 + self.sign * travel_mm / self.length_mm, 0.05))
        return np.column_stack([along, (1.0 - 2.0 * poisson_ratio) * along])

    def principal_stretch(self, unknown: Floats) -> float:
        """Stretch l along the load."""
        return float(np.exp(unknown[0]))

    def cauchy_green(self, unknown: Floats) -> Floats:
        """Tensor C = diag(l^2, m^2, m^2), m^2 = J / l."""
        c = np.zeros((len(unknown), 3, 3))
        c[:, 0, 0] = np.exp(2.0 * unknown[:, 0])
        c[:, 1, 1] = c[:, 2, 2] = np.exp(unknown[:, 1] - unknown[:, 0])
        return c

    def strain_derivatives(self, unknown: Floats) -> Floats:
        """Derivatives dE11 = l^2 d ln l, dE22 = dE33 = m^2 (d ln J - d ln l) / 2."""
        rates, across = np.zeros((len(unknown), 6, 2)), np.exp(unknown[:, 1] - unknown[:, 0])
        rates[:, 0, 0] = np.exp(2.0 * unknown[:, 0])
        rates[:, 1:3, 0], rates[:, 1:3, 1] = -0.5 * across[:, None], 0.5 * across[:, None]
        return rates

    def tester_reading(self, unknown: Floats, stress: Floats, bulk_modulus: float) -> TesterReading:
        """Nominal stress l S11 + p J / l and lateral stress m^2 S22 + p J (Kirchhoff's), p = K (J - 1), as read."""
        count, along, jacobian = len(unknown), np.exp(unknown[:, 0]), np.exp(unknown[:, 1])
        across_2 = jacobian / along
        volumetric = bulk_modulus * (jacobian - 1.0) * jacobian
        volumetric_by = bulk_modulus * (2.0 * jacobian - 1.0) * jacobian
        force_stress, lateral_stress = np.zeros((count, 6)), np.zeros((count, 1, 6))
        force_stress[:, 0], lateral_stress[:, 0, 1] = along, across_2
        lateral = across_2 * stress[:, 1]
        factor = self.sign * self.area_mm2
        return TesterReading(
            force=factor * (along * stress[:, 0] + volumetric / along),
            force_stress=factor * force_stress,
            force_unknown=factor * np.column_stack([along * stress[:, 0] - volumetric / along, volumetric_by / along]),
            travel=self.sign * self.length_mm * (along - 1.0),
            travel_unknown=np.column_stack([self.sign * self.length_mm * along, np.zeros(count)]),
            lateral=(lateral + volumetric)[:, None],
            lateral_stress=lateral_stress,
            lateral_unknown=np.column_stack([-lateral, lateral + volumetric_by])[:, None, :],
        )


@dataclass(frozen=True)
class SimpleShear:
    """A layer between plates that slide at a fixed distance."""

    lateral: ClassVar[float] = 1.0
    length_mm: float
    area_mm2: float

    def initial_unknowns(self, travel_mm: Floats, poisson_ratio: float) -> Floats:
        """Amount of shear g (t, 1)."""
        return np.asarray(travel_mm / self.length_mm)[:, None]

    def principal_stretch(self, unknown: Floats) -> float:
        """The larger of l and 1 / l, where g = l - 1 / l."""
        return float(0.5 * unknown[0] + np.sqrt(1.0 + 0.25 * unknown[0] ** 2))

    def cauchy_green(self, unknown: Floats) -> Floats:
        """Tensor with C11 = 1, C12 = g, C22 = 1 + g^2."""
        c = np.tile(np.eye(3), (len(unknown), 1, 1))
        c[:, 0, 1] = c[:, 1, 0] = unknown[:, 0]
        c[:, 1, 1] += unknown[:, 0] ** 2
        return c

    def strain_derivatives(self, unknown: Floats) -> Floats:
        """Derivatives dE22 = g dg, 2 dE12 = dg."""
        rates = np.zeros((len(unknown), 6, 1))
        rates[:, 1, 0], rates[:, 3, 0] = unknown[:, 0], 1.0
        return rates

    def tester_reading(self, unknown: Floats, stress: Floats, bulk_modulus: float) -> TesterReading:
        """Nominal shear stress S12 + g S22, as read."""
        shear, count = unknown[:, 0], len(unknown)
        force_stress = np.zeros((count, 6))
        force_stress[:, 3], force_stress[:, 1] = 1.0, shear
        return TesterReading(
            force=self.area_mm2 * (stress[:, 3] + shear * stress[:, 1]),
            force_stress=self.area_mm2 * force_stress,
            force_unknown=self.area_mm2 * stress[:, 1:2],
            travel=self.length_mm * shear,
            travel_unknown=np.full((count, 1), self.length_mm),
            lateral=np.zeros((count, 0)),
            lateral_stress=np.zeros((count, 0, 6)),
            lateral_unknown=np.zeros((count, 0, 1)),
        )


def coupon_kinematics(specimen: Specimen) -> Kinematics:
    """Kinematics of a coupon by its kind."""
    if specimen.kind == "shear":
        return SimpleShear(specimen.gauge_mm, specimen.area_mm2)
    return Uniaxial(1.0 if specimen.kind == "tension" else -1.0, specimen.gauge_mm, specimen.area_mm2)
