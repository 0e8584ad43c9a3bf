"""Structured meshes of quadratic tetrahedra: boxes, slices, discs and rings, graded and curved."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from foundation.arrays import Bools, Floats, Ints
from solve.fem.shape_functions import TET_EDGES

KUHN_PATHS = [list(itertools.accumulate((0, *(1 << a for a in axes)))) for axes in itertools.permutations(range(3))]
"""Paths from corner 0 to corner 7 of a cube, one for each of the six tetrahedra of Kuhn's split."""
FACE_NODES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])  # outward

Axes = Sequence[ArrayLike]
Middle = Callable[[Floats, Floats], Floats]  # of edges, from both ends


@dataclass(frozen=True)
class Grid:
    """A mesh: points (n, 3), tets (m, 10) and the outer facets skin (k, 6), normals outward."""

    points: Floats
    tets: Ints
    skin: Ints

    def facets(self, where: Callable[[Floats], Bools]) -> Ints:
        """Outer facets whose six nodes satisfy a condition on the points (n, 3)."""
        return self.skin[where(self.points)[self.skin].all(axis=1)]

    def nodes(self, where: Callable[[Floats], Bools]) -> Ints:
        """Nodes that satisfy a condition on the points (n, 3)."""
        return np.flatnonzero(where(self.points))

    @property
    def centres(self) -> Floats:
        """Means (m, 3) of the corners of each tetrahedron."""
        return np.asarray(self.points[self.tets[:, :4]].mean(axis=1))


def straight_middle(a: Floats, b: Floats) -> Floats:
    """Middles (n, 3) of straight edges."""
    return 0.5 * (a + b)


def middle_around_axis(a: Floats, b: Floats) -> Floats:
    """Middles (n, 3) of edges at the mean distance from the z axis: edges of constant radius follow the circle."""
    middle = 0.5 * (a + b)
    radius = 0.5 * (np.linalg.norm(a[:, :2], axis=1) + np.linalg.norm(b[:, :2], axis=1))
    middle[:, :2] *= (radius / np.maximum(np.linalg.norm(middle[:, :2], axis=1), 1e-300))[:, None]
    return middle


def grid(
    axes: Axes, mapping: Callable[[Floats], Floats] = lambda p: p, middle: Middle = straight_middle, jitter: float = 0.0
) -> Grid:
    """A mesh of six tetrahedra in each cell of a lattice with the given coordinates along its three axes.

    mapping : lattice (n, 3) -> points; corners that fall together become one, so that cells may become wedges. middle :
    position of the mid-side node from the two ends. jitter : moves inner corners, as a share of the cell.
    """
    lines = [np.asarray(a, float) for a in axes]
    counts = np.array([len(a) for a in lines])
    index = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), -1).reshape(-1, 3)
    corners = np.column_stack([a[i] for a, i in zip(lines, index.T, strict=True)])
    if jitter:
        inner = ((index > 0) & (index < counts - 1)).all(axis=1)
        cell = np.array([np.diff(a).min() for a in lines])
        corners[inner] += np.random.default_rng(1).uniform(-jitter, jitter, (inner.sum(), 3)) * cell
    corners = mapping(corners)
    scale = np.ptp(corners, axis=0).max()
    _, first, same = np.unique(np.round(corners / scale, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    linear = same.ravel()[_linear_tets(counts)]
    linear = linear[(np.diff(np.sort(linear, axis=1), axis=1) > 0).all(axis=1)]
    return _quadratic(corners[first], linear, middle)


def _linear_tets(counts: Ints) -> Ints:
    """Corners (m, 4) of the tetrahedra of a lattice."""
    stride = np.array([counts[1] * counts[2], counts[2], 1])
    cells = np.stack(np.meshgrid(*(np.arange(n - 1) for n in counts), indexing="ij"), -1).reshape(-1, 3) @ stride
    offset = np.array([stride @ [(k >> a) & 1 for a in range(3)] for k in range(8)])
    return np.concatenate([cells[:, None] + offset[path] for path in np.array(KUHN_PATHS)])


def _quadratic(corners: Floats, linear: Ints, middle: Middle) -> Grid:
    """The mesh of quadratic tetrahedra over linear ones."""
    edge = corners[linear[:, 1:]] - corners[linear[:, :1]]
    flip = np.linalg.det(edge) < 0
    linear[flip, 2:] = linear[flip, :1:-1]
    pairs = np.sort(linear[:, TET_EDGES].reshape(-1, 2), axis=1)
    unique, number = np.unique(pairs, axis=0, return_inverse=True)
    points = np.vstack([corners, middle(corners[unique[:, 0]], corners[unique[:, 1]])])
    tets = np.hstack([linear, len(corners) + number.reshape(-1, 6)])
    faces = tets[:, FACE_NODES].reshape(-1, 6)
    _, inverse, count = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_inverse=True, return_counts=True)
    return Grid(points, tets, faces[count[inverse.ravel()] == 1])


def from_polar(p: Floats) -> Floats:
    """Cartesian from cylindrical coordinates: (r, angle, z) -> (x, y, z), (n, 3)."""
    return np.column_stack([p[:, 0] * np.cos(p[:, 1]), p[:, 0] * np.sin(p[:, 1]), p[:, 2]])


def disc(r: ArrayLike, angle: ArrayLike, z: ArrayLike) -> Grid:
    """A disc or ring about the z axis from its radii, angles and heights, with curved elements."""
    return grid((r, angle, z), from_polar, middle_around_axis)


def graded_coordinates(start: float, end: float, first: float, last: float) -> Floats:
    """Coordinates from start to end whose steps grow geometrically, from a length of about first to about last."""
    ratio = last / first
    mean = first if ratio == 1.0 else (last - first) / np.log(ratio)
    count = max(1, round((end - start) / mean))
    steps = first * ratio ** (np.arange(count) / max(count - 1, 1))
    inner = start + np.cumsum(steps[:-1]) * (end - start) / steps.sum()
    return np.concatenate([[start], inner, [end]])
