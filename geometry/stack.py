"""The layers of a segment by height, and its outer shape at rest as convex bodies."""

from dataclasses import dataclass
from math import hypot, sqrt
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from geometry.parameters import Effector, Segment


@dataclass(frozen=True)
class Layer:
    """One layer: its name, its lower and upper height in mm and its material."""

    name: str
    bottom_mm: float
    top_mm: float
    material: str

    @property
    def thickness_mm(self) -> float:
        """Thickness of the layer in mm."""
        return self.top_mm - self.bottom_mm


def layers(segment: Segment) -> tuple[Layer, ...]:
    """Layers from the base upwards: medium2, film, medium1 and, where there is one, effector."""
    sizes = [
        ("medium2", segment.medium2.thickness_mm, segment.medium2.material),
        ("film", segment.film.thickness_um * 1e-3, segment.film.material),
        ("medium1", segment.medium1.thickness_mm, segment.medium1.material),
    ]
    if segment.effector is not None:
        sizes.append(("effector", segment.effector.height_mm, segment.effector.material))
    result, bottom = [], 0.0
    for name, thickness, material in sizes:
        result.append(Layer(name, bottom, bottom + thickness, material))
        bottom += thickness
    return tuple(result)


Vector = NDArray[np.float64]


class Body(Protocol):
    """A convex body that stands upright on the axis of the segment."""

    def reach(self, direction: Vector) -> float:
        """Largest projection of a point of the body on the unit direction (3,), in mm."""

    def distance(self, point: Vector) -> float:
        """Distance of the point (3,) from the body in mm, 0 inside."""


@dataclass(frozen=True)
class Box:
    """An upright box about the axis. half_x, half_y : half its sizes; bottom, top : heights. All in mm."""

    half_x: float
    half_y: float
    bottom: float
    top: float

    def reach(self, direction: Vector) -> float:
        """Largest projection of the box on a unit direction (3,), in mm."""
        x, y, z = direction
        return float(abs(x) * self.half_x + abs(y) * self.half_y + max(z * self.bottom, z * self.top))

    def distance(self, point: Vector) -> float:
        """Distance of a point (3,) from the box in mm, 0 inside."""
        x, y, z = point
        beside = hypot(max(abs(x) - self.half_x, 0.0), max(abs(y) - self.half_y, 0.0))
        return hypot(beside, max(z - self.top, self.bottom - z, 0.0))


@dataclass(frozen=True)
class Disc:
    """An upright cylinder on the axis. radius, bottom, top in mm."""

    radius: float
    bottom: float
    top: float

    def reach(self, direction: Vector) -> float:
        """Largest projection of the cylinder on a unit direction (3,), in mm."""
        x, y, z = direction
        return float(hypot(x, y) * self.radius + max(z * self.bottom, z * self.top))

    def distance(self, point: Vector) -> float:
        """Distance of a point (3,) from the cylinder in mm, 0 inside."""
        x, y, z = point
        return hypot(max(hypot(x, y) - self.radius, 0.0), max(z - self.top, self.bottom - z, 0.0))


@dataclass(frozen=True)
class Dome:
    """A spherical cap of at most a hemisphere on the axis. foot_radius, bottom, top in mm."""

    foot_radius: float
    bottom: float
    top: float

    @property
    def radius(self) -> float:
        """Radius of the sphere in mm, (a^2 + h^2) / 2h with the foot's radius a and the height h."""
        height = self.top - self.bottom
        return (self.foot_radius**2 + height**2) / (2 * height)

    @property
    def centre_z(self) -> float:
        """Height of the sphere's centre in mm."""
        return self.top - self.radius

    def reach(self, direction: Vector) -> float:
        """Largest projection of the cap on a unit direction (3,), in mm.

        It is that of the sphere, or of the rim of the foot where the direction leaves the cap.
        """
        x, y, z = direction
        if self.centre_z + self.radius * z >= self.bottom:
            return float(self.centre_z * z + self.radius)
        return float(hypot(x, y) * self.foot_radius + z * self.bottom)

    def distance(self, point: Vector) -> float:
        """Distance in mm of a point (3,) above the foot or beside it, 0 inside."""
        beside, above = hypot(point[0], point[1]), point[2] - self.centre_z
        away = sqrt(beside**2 + above**2)
        if away <= self.radius:
            return max(self.bottom - float(point[2]), 0.0)
        if above * self.radius >= (self.bottom - self.centre_z) * away:
            return away - self.radius
        return hypot(max(beside - self.foot_radius, 0.0), float(point[2]) - self.bottom)


def bodies(segment: Segment) -> tuple[Body, ...]:
    """The layers below the effector as one box, then the effector where there is one."""
    half_x, half_y = segment.length_mm / 2, segment.width_mm / 2
    stack = layers(segment)
    if segment.effector is None:
        return (Box(half_x, half_y, 0.0, stack[-1].top_mm),)
    effector = _effector(segment.effector, half_x, half_y, stack[-1].bottom_mm)
    return (Box(half_x, half_y, 0.0, stack[-2].top_mm), effector)


def _effector(effector: Effector, half_x: float, half_y: float, bottom: float) -> Body:
    top = bottom + effector.height_mm
    if effector.shape == "layer":
        return Box(half_x, half_y, bottom, top)
    if effector.shape == "block":
        length, width = effector.length_mm, effector.width_mm
        return Box(length / 2 if length else half_x, width / 2 if width else half_y, bottom, top)
    radius = effector.diameter_mm / 2 if effector.diameter_mm else half_x
    return Disc(radius, bottom, top) if effector.shape == "cylinder" else Dome(radius, bottom, top)
