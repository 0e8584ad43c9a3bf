"""Rectangular elements of the stack, graded towards dot, film and sides: quadrilaterals, or bricks of a quarter."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from skfem import MeshHex, MeshQuad  # type: ignore[import-untyped]

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.made import Film, Glue, Layer, Made

AXIAL_MM = 0.04
"""Size of elements along the surface under a ridge, mm."""
TOUCHED_MM, NEAR_MM, FAR_MM = 0.5, 0.125, 0.25
"""About a cap: half width of the touched square, size of elements in it and, on average, outside, mm."""
ACROSS_MM = {"ridge": 0.1, "cap": 0.3}
"""Size of elements across the layers, mm."""
MOST_ACROSS = {"ridge": 12, "cap": 4}
TO_SIDES, FROM_TOUCHED, TO_FACES = 1.3, 2.5, {"ridge": 0.9, "cap": 0.6}
"""Grading. Grids 2.2 times as fine differ by 0.04 % at all of the depth of the clamped ridge, by 0.1 and 0.2 % in force
and charge at a third of it, by 0.2 and 0.4 % at a tenth. The last elements at a side are as thin as they may be: of 5
instead of 14 micrometres the uppermost one folds under 0.28 mm on the thick rig.

Under a cap, five elements instead of three from the touched square to a held side change the charge by 0.05 % at half
depth and by 3 % at a tenth of it; evenly spaced ones have 5 and 40 % more.
"""


@dataclass(frozen=True)
class Grid:
    """Mesh of a stack. mesh : of skfem, last coordinate up, top at 0. part : (m,) number of the layer of each element.

    whole : both halves along x; a quarter of a cap, or half of a ridge in the middle, otherwise.
    """

    mesh: MeshQuad | MeshHex
    part: NDArray[np.int64]
    whole: bool

    @property
    def copies(self) -> int:
        """Number of copies of the piece that make the whole."""
        half = 1 if self.whole else 2
        return half if self.mesh.dim() == 2 else 4


def grid(made: Made) -> Grid:
    """Elements for what was made."""
    levels, parts = _levels(made)
    whole = made.offset_mm != 0.0 or made.one_sided
    ridge = made.dot == "ridge"
    places = _to_side if ridge else _about_dot
    x = places(made.length_mm / 2.0, made.fine) if not made.electrodes else _between_edges(made)
    if made.loose_from_mm is not None:
        x[1 + np.abs(x[1:-1] - made.loose_from_mm).argmin()] = made.loose_from_mm  # never the middle or the side
    if whole and not made.electrodes:
        x = np.concatenate([-x[:0:-1], x])
    across = [] if ridge else [places(made.width_mm / 2.0, made.fine)]
    mesh = (MeshQuad if ridge else MeshHex).init_tensor(x, *across, levels)
    middle = mesh.p[:, mesh.t].mean(axis=1)
    place = np.searchsorted(levels, middle[-1]) - 1
    return Grid(mesh, np.asarray(parts)[place], whole)


def _to_side(end: float, fine: float) -> Floats:
    """0 to end, finer towards the side, where the stress of a held film is singular."""
    even = np.linspace(0.0, 1.0, max(2, round(end * fine / AXIAL_MM)) + 1)
    return np.asarray(end * (1.0 - (1.0 - even) ** TO_SIDES))


def _between_edges(made: Made) -> Floats:
    """Lines at the edges of electrodes, and between them in sizes that grow from the ridge and from the sides.

    From 0 on where the ridge is in the middle, else over the whole length.
    """
    end, start = made.length_mm / 2.0, 0.0 if made.offset_mm == 0.0 else -made.length_mm / 2.0
    edges = sorted({start, end, *(edge for strip in made.electrodes for edge in strip if edge > start)})
    pieces = [np.array([start])]
    for low, high in pairwise(edges):
        x = np.linspace(low, high, PIECE)
        from_dot, from_side = np.abs(x - made.offset_mm), end - np.abs(x)
        size = np.minimum(AXIAL_MM + GROWS * np.maximum(from_dot - STRIP_MM, 0.0), SIDE_MM + SIDE_GROWS * from_side)
        density = 1.0 / np.minimum(size, WIDEST_MM)
        passed = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
        count = max(2, round(made.fine * passed[-1]))
        pieces.append(np.interp(np.linspace(0.0, passed[-1], count + 1), passed, x)[1:])
    return np.concatenate(pieces)


STRIP_MM, GROWS, WIDEST_MM = 0.8, 0.06, 0.12
"""About a ridge over one of several electrodes: half width of the fine part, growth of sizes from there, the widest."""
SIDE_MM, SIDE_GROWS = 0.01, 0.2
PIECE = 401


def _about_dot(end: float, fine: float) -> Floats:
    """0 to end, finer where a cap touches, as its force is that of a small patch, and towards the side."""
    near = np.linspace(0.0, TOUCHED_MM, round(TOUCHED_MM * fine / NEAR_MM) + 1)
    even = np.linspace(0.0, 1.0, max(2, round((end - TOUCHED_MM) * fine / FAR_MM)) + 1)
    far = end - (end - TOUCHED_MM) * (1.0 - even) ** FROM_TOUCHED
    return np.concatenate([near, far[1:]])


def _levels(made: Made) -> tuple[Floats, list[int]]:
    """Heights of the rows of elements from the base (top at 0), and the layer of each row."""
    heights, parts = [-made.height_mm], []
    for number, layer in enumerate(made.layers):
        rows = _rows(layer, made)
        parts += [number] * (len(rows) - 1)
        heights += list(heights[-1] + rows[1:])
    heights[-1] = 0.0
    return np.array(heights), parts


def _rows(layer: Layer | Film | Glue, made: Made) -> Floats:
    """Finer at both faces of a layer; film and glue are one row."""
    if not isinstance(layer, Layer):
        return np.array([0.0, layer.thickness_mm])
    count = min(max(2, round(layer.thickness_mm / ACROSS_MM[made.dot])), MOST_ACROSS[made.dot])
    even = np.linspace(0.0, 1.0, round(made.fine * count) + 1)
    return np.asarray(layer.thickness_mm * (even - TO_FACES[made.dot] * np.sin(2.0 * np.pi * even) / (2.0 * np.pi)))
