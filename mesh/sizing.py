"""Target edge length at a point: fine under the dot, fine on the film, growing smoothly; on a grid and along a line."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from mesh.options import MeshOptions
from mesh.outline import StackOutline

SIZE_GROWTH = 0.4  # mm of edge length per mm of distance: neighbouring edges differ by about a factor 1.4
REFINED_DEPTH_MM = 0.3  # the contact zone is refined for a press this deep
RIM_SIZE_SHARE, RIM_SIZE_GROWTH = (
    0.3,
    0.5,
)  # edge length along the film's rim against that of the film: its stress is singular there
SLICE_RIM_SIZE_SHARE, SLICE_RIM_SIZE_GROWTH = 0.2, SIZE_GROWTH  # the same in a slice, where it costs next to nothing


@dataclass(frozen=True)
class Sizing:
    """The sizing field: target edge lengths in mm.

    outline : the stack the points lie in; coarse_mm, contact_mm, film_mm : edge lengths.
    centers_mm : (k, 2) axes of the dots in x, y; reach_mm : radius of the contact zone.
    kind : shape of the dot; a ridge reaches along y, a plate everywhere.
    """

    outline: StackOutline
    coarse_mm: float
    contact_mm: float
    film_mm: float
    centers_mm: Floats
    reach_mm: float
    kind: str

    def at(self, points: Floats) -> Floats:
        """Edge lengths (n,) in mm at points (n, 3)."""
        contact = self.contact_mm + SIZE_GROWTH * self._distance_to_contact(points)
        z = points[:, 2]
        to_film = np.abs(z - np.clip(z, self.outline.film_bottom, self.outline.film_top))
        film = self.film_mm + SIZE_GROWTH * to_film
        rim = self._rim_size(np.hypot(to_film, self._distance_to_side(points)))
        fine = np.minimum(np.minimum(contact, film), rim)
        return np.minimum(fine, self.coarse_mm)

    def _rim_size(self, away: Floats) -> Floats:
        """Edge lengths (n,) in mm at a distance (n,) in mm from the rim of the film."""
        of_slice, of_solid = (SLICE_RIM_SIZE_SHARE, SLICE_RIM_SIZE_GROWTH), (RIM_SIZE_SHARE, RIM_SIZE_GROWTH)
        share, growth = of_slice if self.outline.is_slice else of_solid
        return np.asarray(share * self.film_mm + growth * away)

    @property
    def side_x_mm(self) -> float:
        """x in mm at which the side that the case may hold is resolved."""
        return self.outline.half_x

    def _distance_to_side(self, points: Floats) -> Floats:
        """Distance (n,) in mm to the nearest side that the case may hold."""
        to_x = self.outline.half_x - np.abs(points[:, 0])
        to_y = to_x if self.outline.is_slice else self.outline.half_y - np.abs(points[:, 1])
        return np.maximum(np.minimum(to_x, to_y), 0.0)

    def _distance_to_contact(self, points: Floats) -> Floats:
        """Distance (n,) in mm to the contact zone on the skin."""
        depth = np.maximum(self._skin_height(points) - points[:, 2], 0.0)
        if self.kind == "plate":
            return depth
        away = points[:, None, :2] - self.centers_mm[None]
        flat = self.outline.is_slice or self.kind == "ridge"
        radial = np.abs(away[..., 0]) if flat else np.hypot(away[..., 0], away[..., 1])
        return np.asarray(np.hypot(np.maximum(radial.min(axis=1) - self.reach_mm, 0.0), depth))

    def _skin_height(self, points: Floats) -> Floats:
        """Height (n,) in mm of the skin within the contact zone: flat, or falling away from the pole of a dome."""
        if self.outline.shape != "dome":
            return np.full(len(points), self.outline.top)
        y = 0.0 if self.outline.is_slice else points[:, 1]
        radial = np.minimum(np.hypot(points[:, 0], y), 0.9 * self.outline.effector_half_x)
        return self.outline.dome_centre_z + np.sqrt(self.outline.dome_radius**2 - radial**2)


def sizing_field(outline: StackOutline, dot: DotShape, options: MeshOptions) -> Sizing:
    """The sizing field for a dot at its rest position.

    The contact zone is where the undeformed skin and the dot overlap, sqrt(2 R u) at a depth u, with 1/R the
    sum of the curvatures of dot and dome, plus one element.
    """
    film_mm = options.film_element_size_mm or sqrt(options.contact_element_size_mm * options.element_size_mm)
    centers = (dot.origin_mm + dot.tips_mm @ dot.rotation.T)[:, :2]
    curvature = 0.0 if dot.kind == "plate" else 1.0 / dot.radius_mm
    if outline.shape == "dome":
        curvature += 1.0 / outline.dome_radius
    widest = 2 * max(outline.half_x, outline.half_y)
    overlap = sqrt(2 * REFINED_DEPTH_MM / curvature) if curvature else widest
    reach = min(overlap, widest) + options.contact_element_size_mm
    kind = "plate" if curvature == 0.0 else ("ridge" if dot.kind == "ridge" else "cap")
    return Sizing(outline, options.element_size_mm, options.contact_element_size_mm, film_mm, centers, reach, kind)


BACKGROUND_STEP_MM = 0.12
MOST_BACKGROUND_POINTS = 300_000


def background_mesh(stack: StackOutline, field: Sizing) -> tuple[Floats, Ints, Floats]:
    """Vertices (n, 3), tetrahedra (m, 4) and edge lengths (n,) over the bounding box and a little beyond."""
    low, high = (*stack.low, 0.0), (stack.half_x, stack.half_y, stack.top)
    volume = float(np.prod(np.subtract(high, low)))
    step = max(
        BACKGROUND_STEP_MM, (volume / MOST_BACKGROUND_POINTS) ** (1 / 3)
    )  # a large segment has no more points than a small one
    lines = []
    for a, b in zip(low, high, strict=True):  # lines on the outer faces, where the sizes are smallest
        lines.append(np.concatenate([[a - step], np.linspace(a, b, 2 + int((b - a) / step)), [b + step]]))
    lines[2] = np.unique(np.concatenate([lines[2], [stack.film_bottom]]))
    shape = tuple(len(line) for line in lines)
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    return points, _grid_tets(shape), field.at(points)


def _grid_tets(shape: tuple[int, ...]) -> Ints:
    """Six tetrahedra around the main diagonal of every cell of a grid with this many points along each axis."""
    _, ny, nz = shape
    i, j, k = (a.ravel() for a in np.meshgrid(*(np.arange(n - 1) for n in shape), indexing="ij"))
    corner = (i * ny + j) * nz + k
    step = np.array([ny * nz, nz, 1])
    paths = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)]
    offsets = [np.concatenate([[0], np.cumsum(step[list(path)])]) for path in paths]
    result = np.concatenate([corner[:, None] + offset for offset in offsets])
    result[3 * len(corner) :] = result[3 * len(corner) :][:, [0, 2, 1, 3]]  # the odd paths, mirrored
    return np.asarray(result, dtype=np.int64)


def graded_points(start: float, end: float, size: Callable[[Floats], Floats]) -> Floats:
    """Points (n,) from start to end, both included, whose steps follow the size at the points.

    The number of steps is the integral of 1/size, rounded up; the points cut that integral into equal parts.
    """
    fine = np.linspace(start, end, 513)
    density = 1.0 / size(fine)
    integral = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(fine))])
    steps = max(1, int(np.ceil(integral[-1] - 1e-9)))
    points = np.interp(np.linspace(0.0, integral[-1], steps + 1), integral, fine)
    points[0], points[-1] = start, end
    return np.asarray(points, dtype=np.float64)


def graded_points_through(breaks: list[float], size: Callable[[Floats], Floats]) -> Floats:
    """Graded points (n,) that go through all breaks, which rise."""
    pieces = [graded_points(a, b, size)[:-1] for a, b in pairwise(breaks)]
    return np.concatenate([*pieces, [breaks[-1]]])
