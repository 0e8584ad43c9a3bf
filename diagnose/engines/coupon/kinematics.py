"""Homogeneous deformations of a coupon, and what a tester reads of them.

With the second Piola-Kirchhoff stress T = S + p J C^-1, p = K (J - 1) (S the whole stress and p = 0 for a foam):
    tension, compression : F = diag(l, m, m), nominal stress l T11, lateral faces free: T33 = 0; unknown ln l, ln J
    planar, equibiaxial  : F = diag(l, 1, J / l) and diag(l, l, J / l^2), as before
    shear                : F = 1 + g e1 x e2 between plates at a fixed distance: J = 1, p without effect on the
                           nominal shear stress S12 + g S22; unknown g
(Holzapfel, Nonlinear Solid Mechanics, 2000, chapters 3 and 6.)
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

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
class Stretching:
    """Principal stretches along fixed axes, of which the third is free of stress.

    log_stretches : logarithms of the three stretches by ln l and ln J. sign : -1 in compression, where travel and force
    are positive too, else 1.
    """

    lateral: ClassVar[float]
    log_stretches: ClassVar[tuple[tuple[float, float], ...]]
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

    def _squares(self, unknown: Floats) -> Floats:
        """Squares (t, 3) of the principal stretches."""
        return np.asarray(np.exp(2.0 * unknown @ np.array(self.log_stretches).T))

    def cauchy_green(self, unknown: Floats) -> Floats:
        """Tensor C (t, 3, 3), diagonal."""
        c = np.zeros((len(unknown), 3, 3))
        c[:, range(3), range(3)] = self._squares(unknown)
        return c

    def strain_derivatives(self, unknown: Floats) -> Floats:
        """Derivatives dE = l^2 d ln l (t, 6, 2) of each principal stretch."""
        rates = np.zeros((len(unknown), 6, 2))
        rates[:, :3] = self._squares(unknown)[:, :, None] * np.array(self.log_stretches)
        return rates

    def tester_reading(self, unknown: Floats, stress: Floats, bulk_modulus: float) -> TesterReading:
        """Nominal stress l S11 + p J / l and free stress l3^2 S33 + p J (Kirchhoff's), p = K (J - 1), as read."""
        count, along, jacobian = len(unknown), np.exp(unknown[:, 0]), np.exp(unknown[:, 1])
        across_2, by = self._squares(unknown)[:, 2], self.log_stretches[2]
        volumetric = bulk_modulus * (jacobian - 1.0) * jacobian
        volumetric_by = bulk_modulus * (2.0 * jacobian - 1.0) * jacobian
        force_stress, lateral_stress = np.zeros((count, 6)), np.zeros((count, 1, 6))
        force_stress[:, 0], lateral_stress[:, 0, 2] = along, across_2
        lateral = across_2 * stress[:, 2]
        factor = self.sign * self.area_mm2
        return TesterReading(
            force=factor * (along * stress[:, 0] + volumetric / along),
            force_stress=factor * force_stress,
            force_unknown=factor * np.column_stack([along * stress[:, 0] - volumetric / along, volumetric_by / along]),
            travel=self.sign * self.length_mm * (along - 1.0),
            travel_unknown=np.column_stack([self.sign * self.length_mm * along, np.zeros(count)]),
            lateral=(lateral + volumetric)[:, None],
            lateral_stress=lateral_stress,
            lateral_unknown=np.column_stack([2.0 * by[0] * lateral, 2.0 * by[1] * lateral + volumetric_by])[:, None, :],
        )


class Uniaxial(Stretching):
    """Tension or compression with free sides."""

    lateral: ClassVar[float] = 0.5
    log_stretches = (1.0, 0.0), (-0.5, 0.5), (-0.5, 0.5)


class Planar(Stretching):
    """Tension of a sheet so wide that its width is kept, which is pure shear."""

    lateral: ClassVar[float] = 1.0
    log_stretches = (1.0, 0.0), (0.0, 0.0), (-1.0, 1.0)


class Equibiaxial(Stretching):
    """Tension of a sheet that is as large along both of its axes."""

    lateral: ClassVar[float] = 2.0
    log_stretches = (1.0, 0.0), (1.0, 0.0), (-2.0, 1.0)


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


STRETCHINGS: Mapping[str, type[Stretching]] = {
    "tension": Uniaxial, "compression": Uniaxial, "planar": Planar, "equibiaxial": Equibiaxial
}  # fmt: skip


def coupon_kinematics(kind: str, length_mm: float, area_mm2: float) -> Kinematics:
    """Kinematics of a coupon by its kind: shear, or one of STRETCHINGS."""
    if kind == "shear":
        return SimpleShear(length_mm, area_mm2)
    return STRETCHINGS[kind](-1.0 if kind == "compression" else 1.0, length_mm, area_mm2)
