"""The lateral place of the array, a straight line along its way and a wander about it, by the extended Kalman filter.

The array's middle is y = a + w beside the middle row. a follows a straight line, a' = a + b dx, and w is an
Ornstein-Uhlenbeck process (Phys. Rev. 36 (1930) 823). Each hypothesis has its own means and covariances of a, b, w.
The next row of dots looks like the right one to an array half a pitch of rows aside; the line decides between them
over the whole way, as one that is taken for its neighbour would have to jump.
"""

from math import radians, tan

import numpy as np

from foundation.arrays import Floats
from softdot.reading.line_filter.hypothesis_arrays import LATERAL
from softdot.reading.line_filter.table import OFFSETS_MM
from solve.compiled import piece

LINE_MM, SLOPE, WANDER_MM, WANDER_S = 0.8, tan(radians(0.8)), 0.3, 1.5
"""Standard deviations of the line's place and slope and of the wander, and the correlation time of that: assumed."""
LINE_A, LINE_B, WANDER, VAR_A, COV_AB, COV_AW, VAR_B, COV_BW, VAR_W = range(9)
"""Places of the means and covariances, behind LATERAL in a memory."""
STEP_ASIDE_MM, STEP_SPREAD_MM = 0.6, 0.3
"""How far away the array is looked for beside where it is thought to be, and the standard deviation there: one dot
between two segments looks like two dots in front of them.
"""
LEFT, RIGHT = 4, 8
"""Bits of such a step."""
LEAST_OFFSET_MM, OFFSET_STEP_MM, OFFSETS = float(OFFSETS_MM[0]), float(OFFSETS_MM[1] - OFFSETS_MM[0]), len(OFFSETS_MM)


def seen_at(offset_mm: float, spread_mm: float) -> tuple[Floats, float]:
    """Means and covariances (9,) where the array was seen at an offset with a standard deviation, and the log-prior of
    that offset.
    """
    prior = np.diag([LINE_MM**2, SLOPE**2, WANDER_MM**2])
    of_place = np.array([1.0, 0.0, 1.0])
    gain = prior @ of_place / (of_place @ prior @ of_place)
    # Everything that is uncertain of the place beside spread_mm is taken away.
    left = prior - np.outer(gain, of_place @ prior) + spread_mm**2 * np.outer(gain, gain)
    return np.array([*(gain * offset_mm), *left[np.triu_indices(3)]]), -0.5 * offset_mm**2 / (
        of_place @ prior @ of_place
    )


@piece()
def lateral_place(memory, h):  # type: ignore[no-untyped-def]
    """Distance of the array's middle from the middle row, mm, in memory h."""
    return memory[h, LATERAL + LINE_A] + memory[h, LATERAL + WANDER]


@piece()
def step_aside(bits):  # type: ignore[no-untyped-def]
    """The step in mm that bits stand for."""
    return STEP_ASIDE_MM * ((bits // RIGHT & 1) - (bits // LEFT & 1))


@piece()
def move_aside(memory, h, way, fade, step, moved):  # type: ignore[no-untyped-def]
    """Fill moved (9,) with means and covariances after a way in mm and a step aside; fade : what is left of the wander
    by then.
    """
    a, b, w = memory[h, LATERAL + LINE_A], memory[h, LATERAL + LINE_B], memory[h, LATERAL + WANDER]
    ab, aw, bb = memory[h, LATERAL + COV_AB], memory[h, LATERAL + COV_AW], memory[h, LATERAL + VAR_B]
    bw, ww = memory[h, LATERAL + COV_BW], memory[h, LATERAL + VAR_W]
    moved[LINE_A], moved[LINE_B], moved[WANDER] = a + step + way * b, b, fade * w
    moved[VAR_A] = memory[h, LATERAL + VAR_A] + way * (2.0 * ab + way * bb)
    moved[COV_AB], moved[COV_AW] = ab + way * bb, fade * (aw + way * bw)
    moved[VAR_B], moved[COV_BW] = bb, fade * bw
    moved[VAR_W] = fade * fade * ww + (1.0 - fade * fade) * WANDER_MM**2
    if step != 0.0:
        moved[VAR_A] += STEP_SPREAD_MM**2


@piece()
def place_spread(moved):  # type: ignore[no-untyped-def]
    """Variance of the place, mm2."""
    return moved[VAR_A] + 2.0 * moved[COV_AW] + moved[VAR_W]


@piece()
def see(moved, share, residual, slope):  # type: ignore[no-untyped-def]
    """Move means and covariances (9,) on by a charge that is residual above the expected one.

    slope : change of the charge over the place; share : slope over the variance of the charge.
    """
    pa, pb = moved[VAR_A] + moved[COV_AW], moved[COV_AB] + moved[COV_BW]
    pw = moved[COV_AW] + moved[VAR_W]
    moved[LINE_A] += share * pa * residual
    moved[LINE_B] += share * pb * residual
    moved[WANDER] += share * pw * residual
    less = share * slope
    moved[VAR_A] -= less * pa * pa
    moved[COV_AB] -= less * pa * pb
    moved[COV_AW] -= less * pa * pw
    moved[VAR_B] -= less * pb * pb
    moved[COV_BW] -= less * pb * pw
    moved[VAR_W] -= less * pw * pw


@piece()
def table_offset(place):  # type: ignore[no-untyped-def]
    """Number of the table's offset below a place, the share of the way to the next one, and offsets in a millimetre.

    Beyond the ends charges stay as they are there: offsets in a millimetre are 0.
    """
    at = (place - LEAST_OFFSET_MM) / OFFSET_STEP_MM
    if at <= 0.0:
        return 0, 0.0, 0.0
    if at >= OFFSETS - 1:
        return OFFSETS - 2, 1.0, 0.0
    return int(at), at - int(at), 1.0 / OFFSET_STEP_MM
