"""The symmetric start triangulation of the footprint, with the effector's foot resolved."""

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from mesh.bisection import Triangulation
from mesh.outline import StackOutline


def start_triangulation(outline: StackOutline, coarse_mm: float) -> Triangulation:
    """Triangles of about coarse_mm; part 1 inside the effector's foot, part 0 outside.

    Raises InputError when a cylinder leaves no room for triangles beside it.
    """
    round_foot = outline.shape == "cylinder"
    patch = _foot_patch(outline) if round_foot else (outline.effector_half_x, outline.effector_half_y)
    x = _grid_lines(outline.half_x, patch[0], coarse_mm, round_foot)
    y = _grid_lines(outline.half_y, patch[1], coarse_mm, round_foot)
    cells = [(i, j) for j in range(len(y) - 1) for i in range(len(x) - 1)]
    if round_foot:
        cells = [c for c in cells if not _is_in_patch(x, c[0], patch[0]) or not _is_in_patch(y, c[1], patch[1])]
    around = ((0, 0), (1, 0), (1, 1), (0, 1))
    quads = np.array([[[x[i + di], y[j + dj]] for di, dj in around] for i, j in cells]).reshape(-1, 4, 2)
    triangles = crossed_triangles(quads)
    part = outline.inside_effector(triangles.mean(axis=1)).astype(np.int64)
    if round_foot:
        rim, disc = round_patch(patch, outline.effector_half_x)
        ring = crossed_triangles(rim)
        triangles = np.concatenate([triangles, ring, disc])
        part = np.concatenate([part, np.zeros(len(ring), dtype=np.int64), np.ones(len(disc), dtype=np.int64)])
    return join_triangles(triangles, part)


def _foot_patch(outline: StackOutline) -> tuple[float, float]:
    """Half sizes in mm of the rectangle around a round foot. InputError where it leaves no rim."""
    radius = outline.effector_half_x
    room = min(outline.half_x, outline.half_y)
    if radius > 0.97 * room:
        raise InputError(
            f"segment.effector.diameter_mm = {2 * radius:g} leaves no rim for mesher layered on a footprint "
            f"of {2 * outline.half_x:g} x {2 * outline.half_y:g} mm: use mesher pytetwild"
        )
    wish = 1.3 * radius
    half_x, half_y = (half if half < 1.2 * wish else wish for half in (outline.half_x, outline.half_y))
    return half_x, half_y


def _grid_lines(half: float, patch: float, coarse: float, round_foot: bool) -> Floats:
    """Symmetric grid lines (n,) through the edges of the patch; four cells over a patch around a round foot."""
    inner = 4 if round_foot else 2 * max(1, round(patch / coarse)) if 0 < patch < half else 0
    pieces = [np.linspace(-patch, patch, inner + 1)] if inner else []
    if inner and patch < half:
        outer = np.linspace(patch, half, 1 + max(1, round((half - patch) / coarse)))
        pieces = [-outer[:0:-1], *pieces, outer[1:]]
    elif not inner:
        pieces = [np.linspace(-half, half, 1 + 2 * max(1, round(half / coarse)))]
    return np.concatenate(pieces)


def _is_in_patch(lines: Floats, cell: int, patch: float) -> bool:
    """Whether a cell of the grid lies in the patch."""
    return bool(abs(lines[cell] + lines[cell + 1]) / 2 < patch)


def crossed_triangles(quads: Floats) -> Floats:
    """Four triangles (4 k, 3, 2) of each quadrilateral (k, 4, 2), counter-clockwise, its centre first."""
    centre = quads.mean(axis=1)
    sides = [np.stack([centre, quads[:, i], quads[:, (i + 1) % 4]], axis=1) for i in range(4)]
    return np.concatenate(sides)


def round_patch(patch: tuple[float, float], radius: float) -> tuple[Floats, Floats]:
    """Quadrilaterals (k, 4, 2) between circle and rectangle, and triangles (m, 3, 2) of the disc with a square core."""
    t = np.array([-1.0, -0.5, 0.0, 0.5])
    one = np.ones(4)
    unit = np.concatenate([np.stack(s, axis=1) for s in ((t, -one), (one, t), (-t, one), (-one, -t))])
    outer = unit * np.array(patch)
    circle = radius * unit / np.linalg.norm(unit, axis=1, keepdims=True)
    next_outer, next_circle = np.roll(outer, -1, axis=0), np.roll(circle, -1, axis=0)
    rim = np.stack([circle, outer, next_outer, next_circle], axis=1)
    inner, next_inner = 0.45 * radius * unit, 0.45 * radius * np.roll(unit, -1, axis=0)
    band = np.stack([inner, circle, next_circle, next_inner], axis=1)
    cell = 0.225 * radius * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    core = np.array([cell + 0.225 * radius * np.array([i, j]) for i in range(-2, 2) for j in range(-2, 2)])
    return rim, crossed_triangles(np.concatenate([band, core]))


def join_triangles(triangles: Floats, part: Ints) -> Triangulation:
    """Number the corners of loose triangles (m, 3, 2); corners closer than a nanometre become one."""
    flat = triangles.reshape(-1, 2)
    _, first, number = np.unique(np.round(flat * 1e6), axis=0, return_index=True, return_inverse=True)
    return Triangulation(flat[first], number.reshape(-1, 3).astype(np.int64), part)
