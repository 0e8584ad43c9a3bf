"""Finite-strain viscoelasticity: a Prony series on the second Piola-Kirchhoff stress.

Relative moduli g_i and relaxation times tau_i of the instantaneous elastic stress S0:
    S = (1 - sum g_i) S0 + sum Q_i,      dQ_i/dt + Q_i / tau_i = g_i dS0/dt
(Simo, Comput. Methods Appl. Mech. Eng. 60, 1987; Holzapfel, Nonlinear Solid Mechanics, 2000, eq. 6.261). For S0
linear over the step the update is exact,
    Q_i <- exp(-a) Q_i + g_i (1 - exp(-a)) / a (S0 - S0_old),      a = dt / tau_i,
hence second order in time (Simo and Hughes, Computational Inelasticity, 1998, eq. 10.3.12 ff.). On the isochoric
stress of rubber the volume stays elastic; of a foam the whole stress relaxes.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numba as nb
import numpy as np

from foundation.arrays import Floats
from solve.decay import mean_decay
from solve.materials.inelastic import RELAXATION, Memory, StatedLaw, StressResponse


@nb.vectorize(cache=True)  # type: ignore[no-untyped-call]
def branch_stress(branch, fade, gain, change):  # type: ignore[no-untyped-def]
    """Q at the end of a step: fade = exp(-a), gain = g (1 - exp(-a)) / a, change of the elastic stress."""
    return fade * branch + gain * change


@dataclass(frozen=True)
class Prony(StatedLaw):
    """Relaxation as a Prony series. relative_moduli : g_i, sum below 1; relaxation_times : tau_i in s. No terms:
    elastic.
    """

    relative_moduli: tuple[float, ...]
    relaxation_times: tuple[float, ...]
    needs_energy = False
    words: ClassVar[str] = "relaxation"
    order: ClassVar[float] = RELAXATION
    linear = True

    @property
    def is_off(self) -> bool:
        """Whether nothing relaxes."""
        return sum(self.relative_moduli) == 0.0

    def scale_moduli(self, factor: float) -> "Prony":
        """The series itself: its moduli are relative."""
        return self

    def around(self, elastic: Any, MPa: float) -> "Prony":
        """The series itself, whatever the elastic law."""
        return self

    def start(self, points: int, components: int = 6) -> Memory:
        """Elastic stress at the last step (n, c), its rate, and the branch stresses (n, i, c)."""
        shape, branches = (points, components), len(self.relative_moduli)
        return np.zeros(shape), np.full(shape, np.nan), np.zeros((points, branches, components))

    def decay(self, time_step: float | Floats) -> tuple[Floats, Floats]:
        """Factors exp(-a) and (1 - exp(-a)) / a of each branch over a step in s, (i,), or (t, i) over steps (t,)."""
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
