"""How one input changes a press."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from foundation.arrays import Floats


@dataclass(frozen=True)
class RigResponse:
    """Response of a press to one input. values (k,) of an input, ascending; ratios (k, 2) of force and voltage at full
    depth against the assumed one.
    """

    values: Floats
    ratios: Floats

    def at(self, value: float) -> Floats:
        """Ratios of force and voltage (2,) at a value, its logarithm interpolated; beyond the ends those of the end."""
        return np.asarray(np.exp(self._curve(np.clip(value, self.values[0], self.values[-1]))))

    @cached_property
    def _curve(self) -> PchipInterpolator:
        return PchipInterpolator(self.values, np.log(self.ratios))
