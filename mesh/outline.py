"""Heights, sizes and curved surfaces of a segment that every part of the mesher needs, with closed-form volumes."""

from dataclasses import dataclass
from math import acos, pi, sqrt
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.types import Planes

EffectorShape = Literal["none", "layer", "block", "cylinder", "dome"]


@dataclass(frozen=True)
class StackOutline:
    """Sizes of the stack in mm; the film may be given another (also zero) thickness than the segment's.

    half_x, half_y : half the footprint (half_y of a slice: half the slice's thickness).
    film_bottom, film_top, medium1_top, top : heights.
    shape, effector_half_x, effector_half_y : the effector and half its foot (the radius when round).
    is_slice : a plane-strain slice; a cylinder then is the rectangle, a dome the arc of its section at y = 0.
    planes : mirror planes at which the stack is cut (mesh.symmetry); sizes remain those of the whole.
    """

    half_x: float
    half_y: float
    film_bottom: float
    film_top: float
    medium1_top: float
    top: float
    shape: EffectorShape
    effector_half_x: float
    effector_half_y: float
    is_slice: bool
    planes: Planes = ()

    @property
    def low(self) -> tuple[float, float]:
        """Least x and y, in mm, of what is meshed."""
        return (0.0 if 0 in self.planes else -self.half_x, 0.0 if 1 in self.planes else -self.half_y)

    @property
    def is_round(self) -> bool:
        """Whether a part is no box; in a slice a cylinder is one."""
        return self.shape == "dome" or (self.shape == "cylinder" and not self.is_slice)

    @property
    def dome_radius(self) -> float:
        """Radius in mm of the dome's sphere: (a^2 + h^2) / 2h with the foot's radius a and the height h."""
        height = self.top - self.medium1_top
        return (self.effector_half_x**2 + height**2) / (2 * height)

    @property
    def dome_centre_z(self) -> float:
        """Height in mm of the centre of the dome's sphere."""
        return self.top - self.dome_radius

    def inside_effector(self, points: Floats) -> NDArray[np.bool_]:
        """Whether points (n, 2) in x, y lie within the effector's foot."""
        x, y = np.abs(points[:, 0]), np.abs(points[:, 1])
        if self.shape in ("cylinder", "dome") and not self.is_slice:
            return np.hypot(x, y) < self.effector_half_x
        return (x < self.effector_half_x) & (y < self.effector_half_y)

    def volumes(self) -> dict[str, float]:
        """Exact volume in mm^3 of each part, as far as it is meshed."""
        share = 0.5 ** len(self.planes)
        return {name: share * volume for name, volume in self._whole_volumes().items()}

    def _whole_volumes(self) -> dict[str, float]:
        foot = 4 * self.half_x * self.half_y
        result = {
            "medium2": foot * self.film_bottom,
            "film": foot * (self.film_top - self.film_bottom),
            "medium1": foot * (self.medium1_top - self.film_top),
        }
        if self.shape != "none":
            result["effector"] = self._effector_volume()
        return result

    def _effector_volume(self) -> float:
        """Volume of a box, a cylinder, a spherical cap pi h (3a^2 + h^2) / 6 or, sliced, a circular segment."""
        a, height = self.effector_half_x, self.top - self.medium1_top
        if self.shape == "dome" and self.is_slice:
            radius = self.dome_radius
            below = radius - height
            return 2 * self.half_y * (radius**2 * acos(below / radius) - below * sqrt(radius**2 - below**2))
        if self.shape == "dome":
            return pi * height * (3 * a**2 + height**2) / 6
        if self.shape == "cylinder" and not self.is_slice:
            return pi * a**2 * height
        return 4 * a * self.effector_half_y * height


def stack_outline(
    segment: Segment, film_thickness_mm: float | None = None, slice_mm: float = 0.0, planes: Planes = ()
) -> StackOutline:
    """The outline of a segment: heights, sizes and the shape of its effector.

    film_thickness_mm : thickness of the film, if other than the segment's; slice_mm : size in y of a plane-strain
    slice; planes : mirror planes at which it is cut.
    """
    film = segment.film.thickness_um * 1e-3 if film_thickness_mm is None else film_thickness_mm
    is_slice = segment.section == "plane-strain"
    half_x, half_y = segment.length_mm / 2, (slice_mm if is_slice else segment.width_mm) / 2
    bottom = segment.medium2.thickness_mm
    medium1_top = bottom + film + segment.medium1.thickness_mm
    shape, foot_x, foot_y, height = _effector_outline(segment, half_x, half_y)
    heights = (bottom, bottom + film, medium1_top, medium1_top + height)
    return StackOutline(half_x, half_y, *heights, shape, foot_x, foot_y, is_slice, planes)


def _effector_outline(segment: Segment, half_x: float, half_y: float) -> tuple[EffectorShape, float, float, float]:
    """Shape, half sizes of the foot and height of the effector, in mm."""
    effector = segment.effector
    if effector is None:
        return "none", 0.0, 0.0, 0.0
    if effector.shape == "layer":
        return "layer", half_x, half_y, effector.height_mm
    if effector.shape == "block":
        foot_x = (effector.length_mm or segment.length_mm) / 2
        foot_y = (effector.width_mm or segment.width_mm) / 2
    else:
        foot_x = foot_y = (effector.diameter_mm or segment.length_mm) / 2
    if segment.section == "plane-strain":
        foot_y = half_y
    return effector.shape, foot_x, foot_y, effector.height_mm


class RoundSkin(Protocol):
    """A skin of one round surface, or of several."""

    def holds(self, points: Floats, tolerance: float = 1e-7) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie on the skin within a tolerance in mm; shape (n,)."""

    def project(self, points: Floats) -> Floats:
        """Nearest points (n, 3) of the skin; points in the plane of the foot stay in it."""

    def normals(self, points: Floats) -> Floats:
        """Outward unit normals (n, 3)."""


@dataclass(frozen=True)
class RoundSurface:
    """The surface of a sphere, or of a circular cylinder along one axis.

    centre : (3,) mm; radius : mm; axes : (3,) 1.0 for coordinates that count, 0.0 along a cylinder's axis.
    low_mm : only what lies above this height belongs to the surface.
    """

    centre: Floats
    radius: float
    axes: Floats
    low_mm: float

    @property
    def foot_radius(self) -> float:
        """Radius in mm of the circle in which the surface meets the plane of the foot."""
        return float(np.sqrt(self.radius**2 - (self.axes[2] * (self.low_mm - self.centre[2])) ** 2))

    def distance(self, points: Floats) -> Floats:
        """Signed distance (n,) in mm of points (n, 3) from the surface, positive outside."""
        return np.asarray(np.linalg.norm((points - self.centre) * self.axes, axis=1) - self.radius)

    def holds(self, points: Floats, tolerance: float = 1e-7) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie on the surface within a tolerance in mm; shape (n,)."""
        return (np.abs(self.distance(points)) < tolerance) & (points[:, 2] > self.low_mm - tolerance)

    def project(self, points: Floats) -> Floats:
        """Nearest points (n, 3) of the surface; points in the plane of the foot stay in it."""
        at_foot = np.abs(points[:, 2] - self.low_mm) < 1e-9
        axes = np.where(at_foot[:, None], self.axes * [1.0, 1.0, 0.0], self.axes)
        radius = np.where(at_foot, self.foot_radius, self.radius)
        away = (points - self.centre) * axes
        return np.asarray(points + away * (radius / np.linalg.norm(away, axis=1) - 1.0)[:, None])

    def normals(self, points: Floats) -> Floats:
        """Outward unit normals (n, 3)."""
        away = (points - self.centre) * self.axes
        return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True))


def curved_surface(stack: StackOutline) -> RoundSurface | None:
    """The curved part of the effector's skin, or None where it has none."""
    if stack.shape == "cylinder" and not stack.is_slice:
        return RoundSurface(np.zeros(3), stack.effector_half_x, np.array([1.0, 1.0, 0.0]), stack.medium1_top)
    if stack.shape == "dome":
        axes = np.array([1.0, 0.0 if stack.is_slice else 1.0, 1.0])
        centre = np.array([0.0, 0.0, stack.dome_centre_z])
        return RoundSurface(centre, stack.dome_radius, axes, stack.medium1_top)
    return None
