"""The Braille cell around the pressed dot: the tips of all its raised dots."""

import numpy as np
from numpy.typing import NDArray

from foundation.errors import InputError
from geometry.braille_cells import dot_offset_mm, raised_dots
from geometry.dot_size import dot_standard
from geometry.parameters import Dot

Floats = NDArray[np.float64]


def cell_tips(dot: Dot, height_mm: float) -> tuple[Floats, float]:
    """Tips (n, 3) of the raised dots from that of the pressed one, and the height of the pressed one, in mm.

    The pressed dot comes first; z points towards the plate. height_mm : of all dots where the cell does not state their
    own. InputError for a cell that does not exist.
    """
    if dot.cell is None:
        return single_tip(dot, height_mm)
    raised = raised_dots(dot.cell)
    if dot.cell_dot not in raised:
        known = ", ".join(map(str, raised)) or "none"
        raise InputError(f"dot.cell_dot = {dot.cell_dot}: not raised in dot.cell = '{dot.cell}', which has {known}")
    heights = dot.cell_heights_mm or (height_mm,) * len(raised)
    if len(heights) != len(raised):
        raise InputError(
            f"dot.cell_heights_mm = {list(heights)}: dot.cell = '{dot.cell}' has {len(raised)} raised dots; "
            "give as many heights"
        )
    pitch = _pitch_mm(dot)
    tops = {n: np.append(dot_offset_mm(n, pitch), -height) for n, height in zip(raised, heights, strict=True)}
    pressed = tops.pop(dot.cell_dot)
    return np.array([np.zeros(3), *(top - pressed for top in tops.values())]), -float(pressed[2])


def single_tip(dot: Dot, height_mm: float) -> tuple[Floats, float]:
    """The one tip (1, 3) of a dot without a cell, and its height in mm. InputError when a cell is asked for."""
    if dot.cell is not None:
        raise InputError(f"dot.cell = '{dot.cell}': a cell has dots of dot.shape = 'cap', not '{dot.shape}'")
    return np.zeros((1, 3)), height_mm


def _pitch_mm(dot: Dot) -> float:
    chosen = dot_standard(dot)
    if chosen is None:
        raise InputError(
            f"dot.cell = '{dot.cell}': the distance of its dots comes from dot.standard; "
            "name one with a dot pitch instead of explicit sizes"
        )
    return chosen.nominal_mm("dot_pitch_mm")
