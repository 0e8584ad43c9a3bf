"""FElupe's NeoHooke as a law for our displacement-only element: the same work at every point in both codes."""

from dataclasses import dataclass

import numba as nb
import numpy as np

from benchmarks.cube import SHEAR
from solve.materials.invariants import isochoric_stress
from solve.tensors import I_OF, J_OF, inverse

SOFT_BULK = 2.0 * SHEAR * 1.3 / (3.0 * (1.0 - 0.6))  # nu 0.3, where displacements alone do not lock


@nb.njit(parallel=True, cache=True)
def _add_volumetric(cauchy_green, bulk, stress, tangent):  # type: ignore[no-untyped-def]
    """Add S = K (J - 1) J C^-1 and its tangent (Holzapfel, Nonlinear Solid Mechanics, 2000, eqs. 6.91, 6.166)."""
    for n in nb.prange(len(stress)):
        ci = np.empty((3, 3))
        j = np.sqrt(inverse(cauchy_green[n], ci))
        p, slope = bulk * (j - 1.0) * j, bulk * (2.0 * j - 1.0) * j
        for v in range(6):
            a, b = I_OF[v], J_OF[v]
            stress[n, v] += p * ci[a, b]
            for w in range(6):
                c, d = I_OF[w], J_OF[w]
                odot = ci[a, c] * ci[b, d] + ci[a, d] * ci[b, c]
                tangent[n, v, w] += slope * ci[a, b] * ci[c, d] - p * odot


@dataclass(frozen=True)
class DisplacementLaw:
    """W = c10 (I1 - 3) + K/2 (J - 1)^2 without a pressure unknown."""

    c10: float
    bulk_modulus: float = SOFT_BULK
    compressible = True
    needs_energy = False

    def stress(self, cauchy_green: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3)."""
        stress, tangent = isochoric_stress(cauchy_green, np.array([self.c10, 0.0, 0.0, 0.0]))
        _add_volumetric(cauchy_green, self.bulk_modulus, stress, tangent)
        return stress, tangent
