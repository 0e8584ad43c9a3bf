"""Yield of the film: von Mises plasticity with linear isotropic hardening, the elasticity may be orthotropic.

Green-Lagrange strain E = Ee + Ep (small elastic strain, any rotation), stress S = C Ee, equivalent plastic strain
kappa, yield function
    f = q - (sigma_y + H kappa) <= 0,    q = sqrt(3/2 dev S : dev S) = sqrt(3/2 S.P S),
associated flow dEp = dkappa 3/2 P S / q. Closest-point projection (Simo and Hughes, Computational Inelasticity,
1998, sec. 3.3 and 3.4): with L = 3/2 dkappa / q and the elastic trial strain Et,
    S = (C^-1 + L P)^-1 Et = sum_k v_k (v_k . Et) / (1 + L p_k),    P v_k = p_k C^-1 v_k,   v_k . C^-1 v_k = 1,
so that q(L) and one scalar equation per point remain. It is solved in the form, Y0 = sigma_y + H kappa_n,
    Y0 / q(L) + 2/3 H L - 1 = 0,
whose left side increases with L and is concave (1/q is a power mean, of exponent -2, of the 1 + L p_k): Newton's
iterates climb to the root from L = 0 without fail. For isotropic C it is linear in L: one step, the radial return.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
import scipy.linalg

from foundation.arrays import Floats
from solve.materials.inelastic import YIELD, Inelastic, Memory, StatedLaw, StressResponse

# S.P S = dev S : dev S for stresses 11, 22, 33, 12, 23, 13
DEVIATOR = np.diag([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
DEVIATOR[:3, :3] -= 1.0 / 3.0
MAX_ITERATIONS = 50  # Newton's; four or five do


def von_mises(stress: Floats) -> Floats:
    """Equivalent stress q (n,) of stresses (n, 6)."""
    normal, shear = stress[:, :3], stress[:, 3:]
    deviator = normal - normal.mean(axis=1, keepdims=True)
    q: Floats = np.sqrt(1.5 * (deviator**2).sum(axis=1) + 3.0 * (shear**2).sum(axis=1))
    return q


class Projection(NamedTuple):
    """Admissible stress (n, 6), consistent tangent dS/dEt (n, 6, 6), increment of the plastic strain (n, 6), new
    equivalent plastic strain (n,)."""

    stress: Floats
    tangent: Floats
    plastic_strain: Floats
    kappa: Floats


@dataclass(frozen=True)
class YieldLaw:
    """Von Mises yield with linear isotropic hardening. stiffness : (6, 6) positive definite, strains with engineering
    shears; yield_stress > 0, inf for none; hardening : H >= 0, the slope of the yield stress over kappa; all in one
    unit of stress. ValueError otherwise.
    """

    stiffness: Floats
    yield_stress: float
    hardening: float = 0.0

    def __post_init__(self) -> None:
        if not self.yield_stress > 0.0:
            raise ValueError(f"yield stress = {self.yield_stress:g}: must be above 0")
        if not 0.0 <= self.hardening < np.inf:
            raise ValueError(f"hardening modulus = {self.hardening:g}: must not be negative")
        if not np.linalg.eigvalsh(self.stiffness).min() > 0.0:
            raise ValueError("the stiffness must be positive definite")

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Eigenvalues p_k (6,) and eigenvectors v_k (6, 6), one a column, of P v = p C^-1 v."""
        p, v = scipy.linalg.eigh(DEVIATOR, np.linalg.inv(self.stiffness))
        p[0] = 0.0  # a pressure is no deviator; round-off would grow with its square
        return p, v

    def project(self, trial_strain: Floats, kappa: Floats) -> Projection:
        """Return to the yield surface from the elastic trial strain E - Ep (n, 6), at kappa (n,) of before.

        Points within it answer with C Et and C themselves. ArithmeticError for strains that are no numbers.
        """
        stress = trial_strain @ self.stiffness
        tangent = np.tile(self.stiffness, (len(stress), 1, 1))
        plastic_strain, new_kappa = np.zeros_like(stress), kappa.copy()
        strength = self.yield_stress + self.hardening * kappa
        beyond = np.flatnonzero(~(von_mises(stress) <= strength))
        if len(beyond):
            stress[beyond], tangent[beyond], plastic_strain[beyond], increment = self._return_to_surface(
                trial_strain[beyond], strength[beyond]
            )
            new_kappa[beyond] += increment
        return Projection(stress, tangent, plastic_strain, new_kappa)

    def _return_to_surface(self, trial_strain: Floats, strength: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Stress, tangent, plastic strain and increment of kappa at points beyond the strength Y0 (n,)."""
        p, v = self.modes
        multiplier, q = self._multiplier(trial_strain @ v, strength)
        weight = 1.0 / (1.0 + multiplier[:, None] * p)
        stress = (trial_strain @ v * weight) @ v.T
        flow = stress @ DEVIATOR
        tangent = (v * weight[:, None, :]) @ v.T
        # dS = A dE - A P S dL, and consistency dq = (2/3) H q^2 / Y0 dL
        spread = np.einsum("nvw,nw->nv", tangent, flow)
        divisor = np.einsum("nv,nv->n", flow, spread) + 4.0 / 9.0 * self.hardening * q**3 / strength
        tangent -= spread[:, :, None] * spread[:, None, :] / divisor[:, None, None]
        return stress, tangent, multiplier[:, None] * flow, multiplier * q / 1.5

    def _multiplier(self, amplitude: Floats, strength: Floats) -> tuple[Floats, Floats]:
        """Multiplier L (n,) and equivalent stress q (n,) for amplitudes v_k . Et (n, 6) and strengths Y0 (n,)."""
        p = self.modes[0]
        share = 1.5 * p * amplitude**2
        multiplier = np.zeros(len(share))
        for _ in range(MAX_ITERATIONS):
            a = 1.0 + multiplier[:, None] * p
            q = np.sqrt((share / a**2).sum(axis=1))
            slope = strength / q**3 * (share * p / a**3).sum(axis=1) + 2.0 / 3.0 * self.hardening
            residual = 1.0 - 2.0 / 3.0 * self.hardening * multiplier - strength / q
            multiplier = np.maximum(multiplier + residual / slope, 0.0)
            if (np.abs(residual) <= 1e-13).all():
                return multiplier, q
        raise ArithmeticError("the projection onto the yield surface of the film did not converge")


@dataclass(frozen=True)
class FilmPlasticity:
    """The yield as a law with memory: plastic strain and equivalent plastic strain at each point.

    law : the yield law, whose stiffness is the film's.
    """

    law: YieldLaw
    needs_energy = False

    def scale_moduli(self, factor: float) -> "FilmPlasticity":
        """The law with its moduli times a factor, for another unit of stress."""
        law = self.law
        return replace(self, law=YieldLaw(factor * law.stiffness, factor * law.yield_stress, factor * law.hardening))

    def start(self, points: int, components: int = 6) -> Memory:
        """Plastic strain (n, 6) and equivalent plastic strain (n,) at rest, which are zero."""
        return np.zeros((points, 6)), np.zeros(points)

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Admissible response to a stress that ignores the plastic strain."""
        plastic, kappa = memory
        trial = np.linalg.solve(self.law.stiffness, elastic.stress.T).T - plastic
        result = self.law.project(trial, kappa)
        return StressResponse(result.stress, result.tangent), (plastic + result.plastic_strain, result.kappa)

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """Zero: no rate enters the law."""
        return 0.0


@dataclass(frozen=True)
class Yield(StatedLaw):
    """Yield stress of the film and its linear isotropic hardening modulus."""

    stress_MPa: float
    hardening_MPa: float = 0.0
    words: ClassVar[str] = "yield of the film"
    order: ClassVar[float] = YIELD

    @property
    def is_off(self) -> bool:
        """Whether the film never yields."""
        return bool(np.isinf(self.stress_MPa))

    def around(self, elastic: Any, MPa: float) -> Inelastic:
        """The plasticity of a film with this stiffness."""
        return FilmPlasticity(YieldLaw(elastic.stiffness, MPa * self.stress_MPa, MPa * self.hardening_MPa))
