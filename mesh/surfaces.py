"""The curved surfaces of an effector: which nodes lie on them and how to put nodes there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesh.outline import Outline
from mesh.types import Floats


@dataclass(frozen=True)
class RoundSurface:
    """A sphere, or a circular cylinder along one axis.

    centre : (3,) mm; radius : mm; axes : (3,) 1.0 for coordinates that count, 0.0 along a cylinder's axis.
    low_mm : only what lies above this height belongs to the surface.
    """

    centre: Floats
    radius: float
    axes: Floats
    low_mm: float

    @property
    def foot_radius(self) -> float:
        """Radius of the circle in which the surface meets the plane of the foot."""
        return float(np.sqrt(self.radius**2 - (self.axes[2] * (self.low_mm - self.centre[2])) ** 2))

    def distance(self, points: Floats) -> Floats:
        """Signed distance (n,) of points (n, 3), positive outside."""
        return np.asarray(np.linalg.norm((points - self.centre) * self.axes, axis=1) - self.radius)

    def holds(self, points: Floats, tolerance: float = 1e-7) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie on the surface within tolerance in mm."""
        return (np.abs(self.distance(points)) < tolerance) & (points[:, 2] > self.low_mm - tolerance)

    def project(self, points: Floats) -> Floats:
        """The nearest points (n, 3) of the surface; points in the plane of the foot stay in it."""
        at_foot = np.abs(points[:, 2] - self.low_mm) < 1e-9
        axes = np.where(at_foot[:, None], self.axes * [1.0, 1.0, 0.0], self.axes)
        radius = np.where(at_foot, self.foot_radius, self.radius)
        away = (points - self.centre) * axes
        return np.asarray(points + away * (radius / np.linalg.norm(away, axis=1) - 1.0)[:, None])

    def normals(self, points: Floats) -> Floats:
        """Unit normals (n, 3), outward."""
        away = (points - self.centre) * self.axes
        return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True))


def curved_surface(stack: Outline) -> RoundSurface | None:
    """The curved part of the effector's skin, or None."""
    if stack.shape == "cylinder" and not stack.is_slice:
        return RoundSurface(np.zeros(3), stack.effector_half_x, np.array([1.0, 1.0, 0.0]), stack.medium1_top)
    if stack.shape == "dome":
        axes = np.array([1.0, 0.0 if stack.is_slice else 1.0, 1.0])
        centre = np.array([0.0, 0.0, stack.dome_centre_z])
        return RoundSurface(centre, stack.dome_radius, axes, stack.medium1_top)
    return None
