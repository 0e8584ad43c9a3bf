"""Friction of a guide or a seal that the force sensor carries beside the specimen: Prandtl's elastic-plastic sliders.

Of one with Coulomb's force F_c and the travel d at which it slips after it was at rest,
    f_n = f_(n-1) + F_c (u_n - u_(n-1)) / d, at most F_c either way:
the stop operator. Several side by side are the Prandtl-Ishlinskii model of hysteresis without rate (Visintin,
Differential Models of Hysteresis, 1994, chapter III).
"""

from dataclasses import dataclass

import numba as nb
import numpy as np

from foundation.arrays import Floats
from solve.added import Added, Motion


@dataclass(frozen=True)
class GuideFriction(Added):
    """Coulomb's forces of sliders side by side, and the travel at which each slips after it was at rest."""

    forces_N: tuple[float, ...] = ()
    presliding_mm: tuple[float, ...] = ()
    follows_time = True

    @property
    def is_off(self) -> bool:
        """Whether no slider has a force."""
        return not any(self.forces_N)

    def force_N(self, motion: Motion) -> Floats:
        """Force (t,) in N of the sliders against the motion of the sensor."""
        return self.sliding_force_N(motion.path_mm)

    def sliding_force_N(self, path_mm: Floats) -> Floats:
        """Force (t,) in N against motion along a path (t,) in mm, none at its first point."""
        path, total = np.ascontiguousarray(path_mm, dtype=np.float64), np.zeros(len(path_mm))
        for force, presliding in zip(self.forces_N, self.presliding_mm, strict=True):
            total += _slider_force(path, force, force / presliding)
        return total


@nb.njit(cache=True)
def _slider_force(path, limit, stiffness):  # type: ignore[no-untyped-def]
    """Force (t,) of one slider along a path (t,), with the most that it carries and its stiffness."""
    force = np.zeros_like(path)
    for n in range(1, len(path)):
        moved = force[n - 1] + stiffness * (path[n] - path[n - 1])
        force[n] = min(max(moved, -limit), limit)
    return force
