"""Hypotheses that agree are one: the likeliest stands for all, with the weighed mean of their motions."""

import numba as nb
import numpy as np

from softdot.reading.line_filter.hypothesis_arrays import (
    AHEAD,
    COLUMNS,
    LOG_SPEED,
    LOG_WEIGHT,
    PLACE,
    SEEN,
    TOUCH,
    WAY,
    YAW,
)
from softdot.reading.line_filter.lateral import lateral_place, step_aside
from solve.compiled import piece

PLACE_BIN_MM, SPEED_BIN, ASIDE_BIN_MM = 0.12, 0.18, 0.3
"""Within these, along the line, of the log-speed and across the line, two hypotheses are merged."""
ROW_NEAR, ROW_FAR = 0x11, 0x44
"""Bits of the first and of the last row of dots in the last two columns."""


@nb.njit(cache=True)
def merged(made, made_choice, memory, parent, fresh, count, top, told, sensor):  # type: ignore[no-untyped-def]
    """Numbers of the children that stand for all that agree: the likeliest, with the weighed mean of the motions.

    told : mask of the columns in which they must agree, those that are not given out yet, and number of the cell under
    the array as it is given out. How many cells passed before is decided by what was given out: hypotheses that differ
    in that alone are one, numbered as the nearer of them to that cell. Beyond sensor.silent_mm from the middle row dots
    of the far row in the last two columns are not told apart: two that differ in nothing else are one, or each would be
    half as likely as a neighbouring place that has no such row.
    """
    open_bits, given = told
    pitch = sensor.cell_pitch_mm
    size = 64
    while size < 2 * count:
        size *= 2
    slots = np.full(size, -1, dtype=np.int64)
    keys, kept = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    total, most, outward = np.zeros((count, 4)), np.empty(count), np.empty(count, dtype=np.int64)
    number = 0
    for child in range(count):
        aside = lateral_place(memory, parent[child]) + step_aside(fresh[child])
        untold = ROW_NEAR if aside > sensor.silent_mm else ROW_FAR if aside < -sensor.silent_mm else 0
        cell = np.int64(np.floor(made[child, PLACE] / pitch))
        within = made[child, PLACE] - pitch * cell
        key = _key(within, cell, made[child], made_choice[child], aside, open_bits & ~untold)
        slot = key & (size - 1)
        while slots[slot] >= 0 and keys[slots[slot]] != key:
            slot = (slot + 1) & (size - 1)
        own = np.exp(made[child, LOG_WEIGHT] - top)
        if slots[slot] < 0:
            slots[slot], keys[number], kept[number], most[number] = number, key, child, own
            outward[number] = cell + made_choice[child, AHEAD]
            number += 1
        same = slots[slot]
        if own > most[same]:
            kept[same], most[same] = child, own
        outside = cell + made_choice[child, AHEAD]
        if abs(outside - given) < abs(outward[same] - given):
            outward[same] = outside
        total[same, PLACE] += own * within
        for part in range(PLACE + 1, LOG_WEIGHT):
            total[same, part] += own * made[child, part]
        total[same, LOG_WEIGHT] += own
    for k in range(number):
        cell = np.int64(np.floor(made[kept[k], PLACE] / pitch))
        made_choice[kept[k], AHEAD] = outward[k] - cell
        for part in range(LOG_WEIGHT):
            made[kept[k], part] = total[k, part] / total[k, LOG_WEIGHT]
        made[kept[k], PLACE] += pitch * cell
        made[kept[k], LOG_WEIGHT] = top + np.log(total[k, LOG_WEIGHT])
    return kept[:number]


@piece()
def _key(within, cell, state, choice, aside, open_bits):  # type: ignore[no-untyped-def]
    """A number that hypotheses share which agree in all that decides how they go on."""
    key = np.int64(np.floor(within / PLACE_BIN_MM))
    for part in (
        np.int64(np.floor(state[LOG_SPEED] / SPEED_BIN)), np.int64(np.floor(aside / ASIDE_BIN_MM)),
        choice[WAY], choice[YAW], choice[TOUCH], choice[SEEN] - 2 * cell, choice[COLUMNS] & open_bits,
    ):  # fmt: skip
        key = (key ^ (key >> 29)) * np.int64(0x3F58476D1CE4E5B9) + part + np.int64(0x1E3779B97F4A7C15)
    return key ^ (key >> 31)
