"""Friction of a guide or a seal that the force sensor carries beside the specimen: Prandtl's elastic-plastic sliders.

Of one with Coulomb's force F_c and the travel d at which it slips after it was at rest,
    f_n = f_(n-1) + F_c (u_n - u_(n-1)) / d, at most F_c either way:
the stop operator of solve.stop_operator.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.added import Added, Motion
from solve.stop_operator import apply_stop


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
        sliders = zip(self.forces_N, self.presliding_mm, strict=True)
        each = (apply_stop(path_mm, force, force / presliding) for force, presliding in sliders)
        return np.asarray(sum(each, np.zeros(len(path_mm))))
