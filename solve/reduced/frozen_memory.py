"""A memory that does not fade: the state of a viscoelastic layer at one moment, held while the dot moves.

The Prony series of solve.materials.prony, S = (1 - sum g_i) S0 + sum Q_i, is the elastic stress less an overstress,
    S = S0 - M,      M = sum (g_i S0 - Q_i),
and M is all that a layer remembers. Pressing with M held fixed shows what the segment does at that memory.
"""

from dataclasses import dataclass

import numpy as np

from solve.materials.inelastic import Memory, StressResponse
from solve.materials.prony import Prony


@dataclass(frozen=True)
class Frozen(Prony):
    """S = S0 - M; the memory carries the elastic stress S0 of the last state and M, (n, 6) each (a bond: (n, 4)).

    layer : whose it is.
    """

    relative_moduli: tuple[float, ...] = ()
    relaxation_times: tuple[float, ...] = ()
    layer: str = ""

    def start(self, points: int, components: int = 6) -> Memory:
        """Memory at rest, where nothing is remembered."""
        return np.zeros((points, components)), np.zeros((points, components))

    def update(self, elastic: StressResponse, memory: Memory, time_step: float) -> tuple[StressResponse, Memory]:
        """Response with the memory M, which stays."""
        return StressResponse(elastic.stress - memory[1], elastic.tangent), (elastic.stress, memory[1])

    def time_error(self, memory: Memory, new: Memory, time_step: float, after_kink: bool) -> float:
        """Zero: no time passes."""
        return 0.0
