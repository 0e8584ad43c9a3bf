"""The x-z section of a slice as a structured graded mesh of triangles."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from mesh.sizing import Sizing, graded_points_through


@dataclass(frozen=True)
class MeshedSection:
    """A triangulated x-z section. points_mm : (n, 2); triangles : (m, 3); region : (m,) index into region_names."""

    points_mm: Floats
    triangles: Ints
    region: Ints
    region_names: tuple[str, ...]


Holds = Callable[[str, Floats, float], Bools]
"""Whether a layer has material at x (n,) and a height, both in mm."""


def structured_section(
    field: Sizing, heights: Floats, layer_region: Ints, names: tuple[str, ...], edges: Sequence[float], holds: Holds
) -> MeshedSection:
    """A grid of graded x columns and z layers, every rectangle cut by a diagonal that mirrors about x = 0.

    edges : rising x in mm at which some layer begins or ends, 0 among them; columns begin and end there.
    """
    x = _column_lines(field, edges)
    points = np.column_stack([np.tile(x, len(heights)), np.repeat(heights, len(x))])
    middle = (x[1:] + x[:-1]) / 2
    levels = (heights[1:] + heights[:-1]) / 2
    kept = np.array([holds(names[part], middle, z) for part, z in zip(layer_region, levels, strict=True)])
    layer, column = np.nonzero(kept & (middle > field.outline.low[0]))
    a = layer * len(x) + column
    b, c, d = a + 1, a + 1 + len(x), a + len(x)
    rising = (middle[column] > 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
    other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
    triangles = np.where(rising, one, other).reshape(-1, 3)
    return MeshedSection(points, triangles, np.repeat(layer_region[layer], 2), names)


def _column_lines(field: Sizing, edges: Sequence[float]) -> Floats:
    """x (n,) of the columns through the edges, as fine as the finest of skin and film at each x."""
    levels = (field.outline.film_top, field.outline.top)

    def size(x: Floats) -> Floats:
        at = [np.column_stack([x, np.zeros_like(x), np.full_like(x, z)]) for z in levels]
        return np.minimum(field.at(at[0]), field.at(at[1]))

    return graded_points_through(list(edges), size)
