"""Target edge length in an array: fine under the dots, growing away from the segments that they press."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from geometry.array.layout import ArrayLayout
from geometry.dot import DotShape
from mesh.options import MeshOptions
from mesh.outline import stack_outline
from mesh.sizing import SIZE_GROWTH, Sizing, sizing_field
from mesh.types import Planes

HYPOTENUSE_PER_MEAN_EDGE = 1.6
"""Longest edge of a right triangle against its mean edge, as in mesh.layered."""
FAR_GROWTH = 0.25
"""Growth of the edge length on the film, mm per mm beside the pressed segment: what reaches a neighbour is smooth."""
SIZE_SAMPLES = 20_000
TRIANGLES_PER_SQUARE = 4.0
"""Triangles for a square of the edge length, as bisection leaves them: within a factor of 1.5 on arrays of six."""


@dataclass(frozen=True)
class ArraySizing(Sizing):
    """Sizing field of an array: fine under the dots and on the film of pressed segments, growing away from these.

    pressed : (k, 4) rectangles x0, x1, y0, y1 of the segments under the dots; ends : (n, 4) the same, of the film,
    where it ends at walls, else of the whole array.
    """

    pressed: Floats
    ends: Floats

    def at(self, points: Floats) -> Floats:
        """Edge lengths in mm at points (n, 3), shape (n,)."""
        z = points[:, 2]
        to_film = np.abs(z - np.clip(z, self.outline.film_bottom, self.outline.film_top))
        beside = FAR_GROWTH * _distance_outside(points, self.pressed).min(axis=1)
        film = self.film_mm + SIZE_GROWTH * to_film + beside
        to_end = np.abs(_distance_inside(points, self.ends)).min(axis=1)
        rim = self._rim_size(np.hypot(to_film, to_end)) + beside
        contact = self.contact_mm + SIZE_GROWTH * self._distance_to_contact(points)
        return np.asarray(np.minimum(np.minimum(np.minimum(contact, film), rim), self.coarse_mm))

    @property
    def side_x_mm(self) -> float:
        """x in mm of that end of the film where its edges are smallest, which is beside the dot."""
        x = self.ends[:, :2].ravel()
        film = np.column_stack([x, np.zeros_like(x), np.full_like(x, self.outline.film_top)])
        return float(x[np.argmin(self.at(film))])

    def at_footprint(self, xy_mm: Floats) -> Floats:
        """Smallest edge lengths (n,) in mm of skin and film above points (n, 2) of the footprint."""
        at = [np.column_stack([xy_mm, np.full(len(xy_mm), z)]) for z in (self.outline.film_top, self.outline.top)]
        return np.asarray(np.minimum(self.at(at[0]), self.at(at[1])))


def _distance_inside(points: Floats, rectangles: Floats) -> Floats:
    """Distance (n, k) of points from the nearest edge of each rectangle, negative outside."""
    x, y = points[:, :1], points[:, 1:2]
    x0, x1, y0, y1 = rectangles.T
    return np.asarray(np.minimum(np.minimum(x - x0, x1 - x), np.minimum(y - y0, y1 - y)), dtype=np.float64)


def _distance_outside(points: Floats, rectangles: Floats) -> Floats:
    """Distance (n, k) of points from each rectangle, zero inside."""
    x, y = points[:, :1], points[:, 1:2]
    x0, x1, y0, y1 = rectangles.T
    beside = np.maximum(np.maximum(x0 - x, x - x1), 0.0), np.maximum(np.maximum(y0 - y, y - y1), 0.0)
    return np.asarray(np.hypot(*beside), dtype=np.float64)


def array_sizing(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> ArraySizing:
    """The sizing field of an array under a dot at rest; it presses the segments within its reach."""
    half_x, half_y = layout.half_mm
    outline = stack_outline(layout.whole, slice_mm=options.contact_element_size_mm, planes=planes)
    base = sizing_field(outline, dot, options)
    segments, rim = np.array(layout.rectangles("film")), np.array([(-half_x, half_x, -half_y, half_y)])
    if layout.is_slice:  # which has no end in y
        segments[:, 2:] = rim[:, 2:] = -np.inf, np.inf
    near = (_distance_outside(base.centers_mm, segments) <= base.reach_mm).any(axis=0)
    ends = segments if layout.ends_at_walls("film") else rim
    return ArraySizing(**vars(base), pressed=segments[near] if near.any() else segments, ends=ends)


def expected_elements(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> float:
    """Rough number of tetrahedra: triangles that the sizes ask for, times the layers, times three."""
    field = array_sizing(layout, dot, options, planes)
    stack = field.outline
    low, high = np.array(stack.low), np.array([stack.half_x, stack.half_y])
    xy = np.random.default_rng(0).uniform(low, high, (SIZE_SAMPLES, 2))
    triangles = float(np.prod(high - low) * np.mean(TRIANGLES_PER_SQUARE / field.at_footprint(xy) ** 2))
    x, y = field.centers_mm.mean(axis=0)
    z = np.linspace(0.0, stack.top, SIZE_SAMPLES)
    through = stack.top * float(np.mean(1.0 / field.at(np.column_stack([np.full_like(z, x), np.full_like(z, y), z]))))
    return 3.0 * triangles * through
