"""The sizing field on a background grid, as pytetwild takes it."""

import numpy as np

from mesh.outline import Outline
from mesh.sizing import Sizing
from mesh.types import Floats, Ints

STEP_MM = 0.12
MOST_POINTS = 300_000


def background(stack: Outline, field: Sizing) -> tuple[Floats, Ints, Floats]:
    """Vertices (n, 3), tetrahedra (m, 4) and edge lengths (n,) over the bounding box and a little beyond."""
    low, high = (-stack.half_x, -stack.half_y, 0.0), (stack.half_x, stack.half_y, stack.top)
    volume = float(np.prod(np.subtract(high, low)))
    step = max(STEP_MM, (volume / MOST_POINTS) ** (1 / 3))  # a large segment has no more points than a small one
    lines = []
    for a, b in zip(low, high, strict=True):  # lines on the outer faces, where the sizes are smallest
        lines.append(np.concatenate([[a - step], np.linspace(a, b, 2 + int((b - a) / step)), [b + step]]))
    lines[2] = np.unique(np.concatenate([lines[2], [stack.film_bottom]]))
    shape = tuple(len(line) for line in lines)
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    return points, _grid_tets(shape), field.at(points)


def _grid_tets(shape: tuple[int, ...]) -> Ints:
    """Six tetrahedra around the main diagonal of every cell of a grid."""
    _, ny, nz = shape
    i, j, k = (a.ravel() for a in np.meshgrid(*(np.arange(n - 1) for n in shape), indexing="ij"))
    corner = (i * ny + j) * nz + k
    step = np.array([ny * nz, nz, 1])
    paths = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)]
    offsets = [np.concatenate([[0], np.cumsum(step[list(path)])]) for path in paths]
    result = np.concatenate([corner[:, None] + offset for offset in offsets])
    result[3 * len(corner) :] = result[3 * len(corner) :][:, [0, 2, 1, 3]]  # the odd paths, mirrored
    return np.asarray(result, dtype=np.int64)
