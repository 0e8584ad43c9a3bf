"""The x-z section of a slice as a structured graded mesh of triangles."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from mesh.outline import StackOutline
from mesh.sizing import Sizing, graded_points_through


@dataclass(frozen=True)
class MeshedSection:
    """A triangulated x-z section. points_mm : (n, 2); triangles : (m, 3); region : (m,) index into region_names."""

    points_mm: Floats
    triangles: Ints
    region: Ints
    region_names: tuple[str, ...]


def structured_section(
    stack: StackOutline, field: Sizing, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> MeshedSection:
    """A grid of graded x columns and z layers, every rectangle cut by a diagonal that mirrors about x = 0."""
    x = _column_lines(stack, field)
    points = np.column_stack([np.tile(x, len(heights)), np.repeat(heights, len(x))])
    layer, column = np.divmod(np.arange((len(x) - 1) * (len(heights) - 1)), len(x) - 1)
    middle = (x[column] + x[column + 1]) / 2
    kept = (layer_region[layer] < 3) | (np.abs(middle) < stack.effector_half_x)
    kept &= middle > stack.low[0]
    column, layer, middle = column[kept], layer[kept], middle[kept]
    a = layer * len(x) + column
    b, c, d = a + 1, a + 1 + len(x), a + len(x)
    rising = (middle > 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
    other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
    triangles = np.where(rising, one, other).reshape(-1, 3)
    return MeshedSection(points, triangles, np.repeat(layer_region[layer], 2), names)


def _column_lines(stack: StackOutline, field: Sizing) -> Floats:
    """x of the columns, through the sides of the effector, as fine as the finest of skin and film at each x."""

    def size(x: Floats) -> Floats:
        at = [np.column_stack([x, np.zeros_like(x), np.full_like(x, z)]) for z in (stack.film_top, stack.top)]
        return np.minimum(field.at(at[0]), field.at(at[1]))

    half, foot = stack.half_x, stack.effector_half_x
    breaks = [-half, 0.0, half]
    if 0.0 < foot < half * (1 - 1e-9):
        breaks = [-half, -foot, 0.0, foot, half]
    return graded_points_through(breaks, size)
