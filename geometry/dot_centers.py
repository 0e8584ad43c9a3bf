"""Where the dots of a cell lie around the pressed one."""

import numpy as np
from numpy.typing import NDArray

from geometry.braille_cell import dot_offset_mm, raised_dots
from geometry.dot_size import dot_standard
from geometry.errors import InputError
from geometry.parameters import Dot

Floats = NDArray[np.float64]


def cell_centers(dot: Dot) -> Floats:
    """Axes (n, 2) of the raised dots against the pressed one, which comes first, in mm. InputError."""
    if dot.cell is None:
        return refuse_cell_of(dot)
    raised = raised_dots(dot.cell)
    if dot.cell_dot not in raised:
        known = ", ".join(map(str, raised)) or "none"
        raise InputError(f"dot.cell_dot = {dot.cell_dot}: not raised in dot.cell = '{dot.cell}', which has {known}")
    pitch = _pitch_mm(dot)
    pressed = dot_offset_mm(dot.cell_dot, pitch)
    others = [dot_offset_mm(number, pitch) - pressed for number in raised if number != dot.cell_dot]
    return np.array([np.zeros(2), *others])


def refuse_cell_of(dot: Dot) -> Floats:
    """The one axis (1, 2) of a dot without a cell. InputError when a cell is asked for."""
    if dot.cell is not None:
        raise InputError(f"dot.cell = '{dot.cell}': a cell has dots of dot.shape = 'cap', not '{dot.shape}'")
    if dot.cell_dot != 1:
        raise InputError(f"dot.cell_dot = {dot.cell_dot}: has a meaning only together with dot.cell")
    return np.zeros((1, 2))


def _pitch_mm(dot: Dot) -> float:
    chosen = dot_standard(dot)
    if chosen is None:
        raise InputError(
            f"dot.cell = '{dot.cell}': the distance of its dots comes from dot.standard; "
            "name one with a dot pitch instead of explicit sizes"
        )
    return chosen.nominal_mm("dot_pitch_mm")
