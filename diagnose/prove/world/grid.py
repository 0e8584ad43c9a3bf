"""Rectangular elements of the stack, graded towards dot, film and sides: quadrilaterals, or bricks of a quarter."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import MeshHex, MeshQuad  # type: ignore[import-untyped]

from diagnose.prove.world.made import Film, Floats, Glue, Layer, Made

AXIAL_MM = 0.04
"""Size of elements along the surface under a ridge, mm."""
TOUCHED_MM, NEAR_MM, FAR_MM = 0.5, 0.125, 0.25
"""About a cap: half width of the touched square, size of elements in it and, on average, outside, mm."""
ACROSS_MM = {"ridge": 0.1, "cap": 0.3}
"""Size of elements across the layers, mm."""
MOST_ACROSS = {"ridge": 12, "cap": 4}
TO_SIDES, FROM_TOUCHED, TO_FACES = 1.6, 2.5, {"ridge": 0.9, "cap": 0.6}
"""Grading. From a tenth of the depth on, grids three times as fine differ by 0.1 % on both ridges.

Under a cap, five elements instead of three from the touched square to a held side change the charge by 0.05 % at half
depth and by 3 % at a tenth of it; evenly spaced ones have 5 and 40 % more.
"""


@dataclass(frozen=True)
class Grid:
    """mesh : of skfem, last coordinate up, top at 0. part : (m,) number of the layer of each element.

    whole : both halves along x; a quarter of a cap, or half of a ridge in the middle, otherwise.
    """

    mesh: MeshQuad | MeshHex
    part: NDArray[np.int64]
    whole: bool

    @property
    def copies(self) -> int:
        """How often the piece makes the whole."""
        half = 1 if self.whole else 2
        return half if self.mesh.dim() == 2 else 4


def grid(made: Made) -> Grid:
    """Elements for what was made."""
    levels, parts = _levels(made)
    whole = made.offset_mm != 0.0
    ridge = made.dot == "ridge"
    places = _to_side if ridge else _about_dot
    x = places(made.length_mm / 2.0, made.fine)
    if whole:
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
