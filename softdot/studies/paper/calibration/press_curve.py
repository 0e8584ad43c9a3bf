"""Force and voltage of a press against depth."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from foundation.arrays import Floats


@dataclass(frozen=True)
class PressCurve:
    """Load steps (s,) from rest: depth, force and open-circuit voltage; capacitance of the film."""

    depth_mm: Floats
    force_N: Floats
    voltage_V: Floats
    capacitance_pF: float

    def force_at(self, depth_mm: float | Floats) -> Floats:
        """Force in N at depths of any shape."""
        return _extend(self._force, self.depth_mm[-1], np.asarray(depth_mm))

    def voltage_at(self, depth_mm: float | Floats) -> Floats:
        """Open-circuit voltage in V at depths of any shape."""
        return _extend(self._voltage, self.depth_mm[-1], np.asarray(depth_mm))

    def scale(self, force: float, voltage: float) -> "PressCurve":
        """The curve with force and voltage times a factor each."""
        return replace(self, force_N=force * self.force_N, voltage_V=voltage * self.voltage_V)

    @cached_property
    def _force(self) -> CubicSpline:
        """The force in N as a spline over the depth in mm."""
        return CubicSpline(self.depth_mm, self.force_N)

    @cached_property
    def _voltage(self) -> CubicSpline:
        """The voltage in V as a spline over the depth in mm."""
        return CubicSpline(self.depth_mm, self.voltage_V)


def _extend(curve: CubicSpline, last_mm: float, asked: Floats) -> Floats:
    """Values of a cubic spline, since leakage asks for smooth slopes, and beyond the last step of the tangent there."""
    beyond = np.maximum(asked - last_mm, 0.0)
    return np.asarray(curve(np.minimum(asked, last_mm)) + beyond * curve(last_mm, 1))
