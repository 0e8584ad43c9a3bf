"""The film's yield as a law with memory: plastic strain and equivalent plastic strain at each point."""

from dataclasses import dataclass, replace

import numpy as np

from solve.materials.film_yield import YieldLaw
from solve.materials.response import Memory, Response


@dataclass(frozen=True)
class FilmPlasticity:
    """law : the yield law, whose stiffness is the film's."""

    law: YieldLaw
    needs_energy = False

    def scaled(self, factor: float) -> "FilmPlasticity":
        """The same law in another unit of stress."""
        law = self.law
        return replace(self, law=YieldLaw(factor * law.stiffness, factor * law.yield_stress, factor * law.hardening))

    def start(self, points: int) -> Memory:
        """Plastic strain (n, 6) and equivalent plastic strain (n,)."""
        return np.zeros((points, 6)), np.zeros(points)

    def update(self, elastic: Response, memory: Memory, time_step: float) -> tuple[Response, Memory]:
        """Admissible response to a stress that ignores the plastic strain."""
        plastic, kappa = memory
        trial = np.linalg.solve(self.law.stiffness, elastic.stress.T).T - plastic
        result = self.law.project(trial, kappa)
        return Response(result.stress, result.tangent), (plastic + result.plastic_strain, result.kappa)
