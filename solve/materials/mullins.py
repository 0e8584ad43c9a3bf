"""Stress softening of filled rubber (Mullins effect) after Ogden and Roxburgh.

    S = eta S0,      eta = 1 - (1/r) erf((W_max - W) / (m + beta W_max))
with the largest isochoric energy W_max that the point has seen; eta = 1 on the primary curve (Ogden and Roxburgh,
Proc. R. Soc. A 455, 1999, in the form with beta of Abaqus). With dW = S0 : dE the tangent below W_max is
    eta CC0 + d eta/dW S0 x S0,      d eta/dW = 2 exp(-z^2) / (sqrt(pi) r (m + beta W_max)).
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from scipy.special import erf

from foundation.arrays import Floats
from solve.materials.inelastic import SOFTENING, Memory, StatedLaw, StressResponse

ROUNDING = 1e-14  # energies below this part of the stiffness are rounding: strains below 1e-7


@dataclass(frozen=True)
class Softening(StatedLaw):
    """Stress softening after Ogden and Roxburgh. loss : 1/r, the largest relative loss of stress; energy : m, in the
    unit of stress; beta : without unit.
    """

    loss: float
    energy: float = 0.0
    beta: float = 0.3
    needs_energy = True
    words: ClassVar[str] = "stress softening"
    order: ClassVar[float] = SOFTENING

    @property
    def is_off(self) -> bool:
        """Whether no stress is lost."""
        return self.loss == 0.0

    def around(self, elastic: Any, MPa: float) -> "Softening":
        """The law in the solver's unit of stress."""
        return self.scale_moduli(MPa)

    def scale_moduli(self, factor: float) -> "Softening":
        """The law with its moduli times a factor, for another unit of stress."""
        return replace(self, energy=factor * self.energy)

    def start(self, points: int, components: int = 6) -> Memory:
        """The largest energy so far (n,), which is zero at rest."""
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
        """Zero: no rate enters the law."""
        return 0.0

    def _factor(self, energy: Floats, largest: Floats, rounding: Floats) -> tuple[Floats, Floats]:
        """Factors eta and d eta/dW, (n,) each. rounding : the least energy that differs from that of the undeformed
        point.
        """
        below = energy < largest
        width = np.maximum(self.energy + self.beta * largest, rounding)
        z = np.where(below, (largest - energy) / width, 0.0)
        slope = np.where(below, 2.0 / np.sqrt(np.pi) * self.loss * np.exp(-(z**2)) / width, 0.0)
        return 1.0 - self.loss * erf(z), slope
