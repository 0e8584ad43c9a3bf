"""What a law answers at a quadrature point, and what a law with memory makes of it.

Finite-strain viscoelasticity: a Prony series on the second Piola-Kirchhoff stress.

Relative moduli g_i and relaxation times tau_i of the instantaneous elastic stress S0:
    S = (1 - sum g_i) S0 + sum Q_i,      dQ_i/dt + Q_i / tau_i = g_i dS0/dt
(Simo, Comput. Methods Appl. Mech. Eng. 60, 1987; Holzapfel, Nonlinear Solid Mechanics, 2000, eq. 6.261). For S0
linear over the step the update is exact,
    Q_i <- exp(-a) Q_i + g_i (1 - exp(-a)) / a (S0 - S0_old),      a = dt / tau_i,
hence second order in time (Simo and Hughes, Computational Inelasticity, 1998, eq. 10.3.12 ff.). On the isochoric
stress of rubber the volume stays elastic; of a foam the whole stress relaxes.

Stress softening of filled rubber (Mullins effect) after Ogden and Roxburgh.

    S = eta S0,      eta = 1 - (1/r) erf((W_max - W) / (m + beta W_max))
with the largest isochoric energy W_max that the point has seen; eta = 1 on the primary curve (Ogden and Roxburgh,
Proc. R. Soc. A 455, 1999, in the form with beta of Abaqus). With dW = S0 : dE the tangent below W_max is
    eta CC0 + d eta/dW S0 x S0,      d eta/dW = 2 exp(-z^2) / (sqrt(pi) r (m + beta W_max)).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numba as nb
import numpy as np
from scipy.special import erf

from geometry.arrays import Floats

Memory = tuple[Floats, ...]  # arrays whose first axis counts the quadrature points


@dataclass(frozen=True)
class StressResponse:
    """Second Piola-Kirchhoff stress (n, 6), tangent (n, 6, 6) and strain energy (n,) at n quadrature points.

    energy is None where no law asks for it; cauchy_green : C (n, 3, 3) of a medium, None of a film or a bond.
    """

    stress: Floats
    tangent: Floats
    energy: Floats | None = None
    cauchy_green: Floats | None = None


class Inelastic(Protocol):
    """A law with memory that acts on the response of an elastic one."""

    @property
    def needs_energy(self) -> bool:
        """Whether Response.energy is read."""

    def start(self, points: int, components: int = 6) -> Memory:
        """Memory of n quadrature points at rest; components : of a stress, or of a bond's jump."""

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Response and memory at the end of a time step (s)."""

    def scaled(self, factor: float) -> "Inelastic":
        """The law with its moduli times a factor, for another unit of stress."""

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """Error of the time integration in a step, relative to the largest stress; 0 for a law without rates."""


def at_rest(laws: Sequence[Inelastic], points: int, components: int = 6) -> tuple[Memory, ...]:
    """Memories of laws that act one after the other."""
    return tuple(law.start(points, components) for law in laws)


def respond(
    laws: Sequence[Inelastic], elastic: StressResponse, memories: Sequence[Memory], time_step: float
) -> tuple[StressResponse, tuple[Memory, ...]]:
    """Each law on the response of the one before: the last response, and the new memories."""
    response, new = elastic, []
    for law, memory in zip(laws, memories, strict=True):
        response, now = law.update(response, memory, time_step)
        new.append(now)
    return response, tuple(new)


def time_error(
    laws: Sequence[Inelastic], old: Sequence[Memory], new: Sequence[Memory], time_step: float, after_kink: bool
) -> float:
    """The largest of their errors."""
    each = zip(laws, old, new, strict=True)
    return max((law.time_error(before, now, time_step, after_kink) for law, before, now in each), default=0.0)


@nb.vectorize(cache=True)  # type: ignore[no-untyped-call]
def mean_decay(a):  # type: ignore[no-untyped-def]
    """(1 - exp(-a)) / a, the mean of exp(-s) for s from 0 to a >= 0."""
    return -np.expm1(-a) / a if a > 0.0 else 1.0


@nb.vectorize(cache=True)  # type: ignore[no-untyped-call]
def branch_stress(branch, fade, gain, change):  # type: ignore[no-untyped-def]
    """Q at the end of a step: fade = exp(-a), gain = g (1 - exp(-a)) / a, change of the elastic stress."""
    return fade * branch + gain * change


@dataclass(frozen=True)
class Prony:
    """relative_moduli : g_i, sum below 1; relaxation_times : tau_i in s. No terms: elastic.

    linear : in the history of the elastic stress.
    """

    relative_moduli: tuple[float, ...]
    relaxation_times: tuple[float, ...]
    needs_energy = False
    linear = True

    def scaled(self, factor: float) -> "Prony":
        """The series itself: its moduli are relative."""
        return self

    def acting_on(self, shear_modulus: float) -> "Prony":
        """The series itself, whatever the shear modulus of the elastic law."""
        return self

    def start(self, points: int, components: int = 6) -> Memory:
        """Elastic stress at the last step (n, c), its rate, and the branch stresses (n, i, c)."""
        shape, branches = (points, components), len(self.relative_moduli)
        return np.zeros(shape), np.full(shape, np.nan), np.zeros((points, branches, components))

    def decay(self, time_step: float | Floats) -> tuple[Floats, Floats]:
        """exp(-a) and (1 - exp(-a)) / a of each branch, (i,), or (t, i) of steps (t,)."""
        a = np.asarray(time_step, np.float64)[..., None] / np.array(self.relaxation_times)
        return np.exp(-a), mean_decay(a)

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Relaxed response and the new memory."""
        old, _, branches = memory
        moduli = np.array(self.relative_moduli)
        fade, gain = self.decay(time_step)
        change = elastic.stress - old
        branches = branch_stress(branches, fade[:, None], (moduli * gain)[:, None], change[:, None, :])
        stress = (1.0 - moduli.sum()) * elastic.stress + branches.sum(axis=1)
        instant = 1.0 - moduli.sum() + float(moduli @ gain)
        rate = change / time_step if time_step > 0.0 else np.full_like(change, np.nan)
        return StressResponse(stress, instant * elastic.tangent), (elastic.stress, rate, branches)

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """Largest error of the branch stresses in this step, relative to the largest elastic stress.

        For S0 with a constant second derivative the linear update errs by g dt^2 S0'' / 12 when a << 1, less for
        larger a. The derivative comes from the rates of this step and the last; after a kink there is none yet.
        """
        bend = np.abs(new[1] - memory[1]) * time_step
        if after_kink or not np.isfinite(bend).all():
            return 0.0
        largest = max(float(np.abs(new[0]).max()), float(np.abs(memory[0]).max()), 1e-300)
        fade, _ = self.decay(time_step)
        weight = float(np.array(self.relative_moduli) @ (1.0 - fade))
        return weight * float(bend.max()) / 12.0 / largest


ROUNDING = 1e-14  # energies below this part of the stiffness are rounding: strains below 1e-7


@dataclass(frozen=True)
class Softening:
    """loss : 1/r, the largest relative loss of stress; energy : m, in the unit of stress; beta : without unit."""

    loss: float
    energy: float = 0.0
    beta: float = 0.3
    needs_energy = True

    def scaled(self, factor: float) -> "Softening":
        """The law with its moduli times a factor, for another unit of stress."""
        return replace(self, energy=factor * self.energy)

    def start(self, points: int, components: int = 6) -> Memory:
        """The largest energy so far (n,)."""
        return (np.zeros(points),)

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Softened response and the new largest energy."""
        assert elastic.energy is not None
        largest = np.maximum(memory[0], elastic.energy)
        factor, slope = self._factor(elastic.energy, largest, ROUNDING * elastic.tangent[:, 0, 0])
        stress = factor[:, None] * elastic.stress
        rank_one = elastic.stress[:, :, None] * elastic.stress[:, None, :]
        tangent = factor[:, None, None] * elastic.tangent + slope[:, None, None] * rank_one
        return replace(elastic, stress=stress, tangent=tangent), (largest,)

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """No rate enters."""
        return 0.0

    def _factor(self, energy: Floats, largest: Floats, rounding: Floats) -> tuple[Floats, Floats]:
        """eta and d eta/dW, (n,) each. rounding : the least energy that differs from that of the undeformed point."""
        below = energy < largest
        width = np.maximum(self.energy + self.beta * largest, rounding)
        z = np.where(below, (largest - energy) / width, 0.0)
        slope = np.where(below, 2.0 / np.sqrt(np.pi) * self.loss * np.exp(-(z**2)) / width, 0.0)
        return 1.0 - self.loss * erf(z), slope
