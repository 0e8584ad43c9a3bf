"""Hypotheses that agree are one: the likeliest stands for all, with the weighed mean of their motions."""

import numba as nb
import numpy as np

from softdot.reading.line_filter.hypothesis_arrays import (
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
def merged(made, made_choice, memory, parent, fresh, count, top, open_bits, silent_mm):  # type: ignore[no-untyped-def]
    """Numbers of the children that stand for all that agree: the likeliest, with the weighed mean of the motions.

    open_bits : mask of the columns in which they must agree, those that are not given out yet. silent_mm : distance
    from the middle row beyond which dots of the far row in the last two columns are not told apart: two that differ in
    nothing else are one, or each would be half as likely as a neighbouring place that has no such row.
    """
    size = 64
    while size < 2 * count:
        size *= 2
    slots = np.full(size, -1, dtype=np.int64)
    keys, kept = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    total, most = np.zeros((count, 4)), np.empty(count)
    number = 0
    for child in range(count):
        aside = lateral_place(memory, parent[child]) + step_aside(fresh[child])
        untold = ROW_NEAR if aside > silent_mm else ROW_FAR if aside < -silent_mm else 0
        key = _key(made[child], made_choice[child], aside, open_bits & ~untold)
        slot = key & (size - 1)
        while slots[slot] >= 0 and keys[slots[slot]] != key:
            slot = (slot + 1) & (size - 1)
        own = np.exp(made[child, LOG_WEIGHT] - top)
        if slots[slot] < 0:
            slots[slot], keys[number], kept[number], most[number] = number, key, child, own
            number += 1
        same = slots[slot]
        if own > most[same]:
            kept[same], most[same] = child, own
        for part in range(LOG_WEIGHT):
            total[same, part] += own * made[child, part]
        total[same, LOG_WEIGHT] += own
    for k in range(number):
        for part in range(LOG_WEIGHT):
            made[kept[k], part] = total[k, part] / total[k, LOG_WEIGHT]
        made[kept[k], LOG_WEIGHT] = top + np.log(total[k, LOG_WEIGHT])
    return kept[:number]


@piece()
def _key(state, choice, aside, open_bits):  # type: ignore[no-untyped-def]
    """A number that hypotheses share which agree in all that decides how they go on."""
    key = np.int64(np.floor(state[PLACE] / PLACE_BIN_MM))
    for part in (
        np.int64(np.floor(state[LOG_SPEED] / SPEED_BIN)), np.int64(np.floor(aside / ASIDE_BIN_MM)),
        choice[WAY], choice[YAW], choice[TOUCH], choice[SEEN], choice[COLUMNS] & open_bits,
    ):  # fmt: skip
        key = (key ^ (key >> 29)) * np.int64(0x3F58476D1CE4E5B9) + part + np.int64(0x1E3779B97F4A7C15)
    return key ^ (key >> 31)
