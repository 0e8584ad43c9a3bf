"""The dots of a line: every cell at the pitches of the standard, with scatter, wear and missing dots. x runs along the
line from the middle of the first cell, y across it from the middle row to the row of dots 3 and 6.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import truncnorm

from foundation.arrays import Bools, Floats, Ints
from geometry.braille_cells import dot_offset_mm
from geometry.braille_standards import BrailleStandard
from softdot.reading.cells import DOTS
from softdot.reading.conditions import WIDEST_SIGMA, ReadingConditions


@dataclass(frozen=True)
class DotLine:
    """Dots (d,) in the order of their x. extra_mm : by how much each is pressed deeper than a nominal dot."""

    x_mm: Floats
    y_mm: Floats
    extra_mm: Floats

    def in_order_of_x(self) -> "DotLine":
        """The same dots in the order of their x."""
        order = np.argsort(self.x_mm, kind="stable")
        return DotLine(self.x_mm[order], self.y_mm[order], self.extra_mm[order])


def dots_of_cells(cells: Ints) -> Bools:
    """Whether each of the six dots of cells (c,) is raised, (c, 6).

    >>> dots_of_cells(np.array([0b011001])).tolist()  # the letter d
    [[True, False, False, True, True, False]]
    """
    return np.asarray((np.asarray(cells)[:, None] >> np.arange(DOTS)) & 1, dtype=bool)


def cells_from(dots: Bools) -> Ints:
    """Cells (c,) of raised dots (c, 6)."""
    return np.asarray(dots @ (1 << np.arange(DOTS)), dtype=np.int64)


def dot_places_mm(chosen: BrailleStandard) -> Floats:
    """Places (6, 2) of the dots of a cell, from its middle."""
    pitch = chosen.nominal_mm("dot_pitch_mm")
    places = np.array([dot_offset_mm(dot, pitch) for dot in range(1, DOTS + 1)])
    return np.asarray(places - places.mean(axis=0))


def cell_pitch_mm(chosen: BrailleStandard) -> float:
    """Distance from the middle of a cell to that of the next, mm."""
    return chosen.nominal_mm("cell_pitch_mm")


def nominal_line(cells: Ints, chosen: BrailleStandard) -> DotLine:
    """The dots of cells (c,) exactly where the standard has them, in the order of x."""
    number, dot = np.nonzero(dots_of_cells(cells))
    places = dot_places_mm(chosen)[dot]
    return DotLine(places[:, 0] + cell_pitch_mm(chosen) * number, places[:, 1], np.zeros(len(dot))).in_order_of_x()


def manufactured_line(
    cells: Ints, chosen: BrailleStandard, conditions: ReadingConditions, random: np.random.Generator
) -> DotLine:
    """The dots of cells (c,) as they were made and worn. conditions : with implied values.

    Heights and places scatter normally, cut at WIDEST_SIGMA. The diameter of the base is not varied: by Hertz a base
    0.05 mm wider changes the force by 2 to 3 %, as a height of 0.004 mm more does.
    """
    line = nominal_line(cells, chosen)
    count = len(line.x_mm)
    scatter = truncnorm(-WIDEST_SIGMA, WIDEST_SIGMA).rvs((3, count), random_state=random)
    height = (conditions.height_mm or 0.0) - chosen.nominal_mm("height_mm")
    worn = random.random(count) < conditions.worn
    kept = random.random(count) >= conditions.missing
    extra = height + (conditions.height_scatter_mm or 0.0) * scatter[0] - conditions.wear_mm * worn
    x = line.x_mm + conditions.position_scatter_mm * scatter[1]
    y = line.y_mm + conditions.position_scatter_mm * scatter[2]
    return DotLine(x[kept], y[kept], extra[kept]).in_order_of_x()
