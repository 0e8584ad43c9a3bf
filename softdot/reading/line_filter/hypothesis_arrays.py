"""What the numbers of the hypotheses on a line mean, which lie in rows of three arrays.

state (h, 4) and choice (h, 6) by the names below, and memory (h, 33 + 5 n): heights of the dots of the last four
columns as shares of a nominal charge, the variances of these, means and covariances of the lateral place, and of each
channel level and rate of the drift, gain and its variance, and change of that rate. Columns of dots that were seen are
kept sixteen at a time, four bits each, the last one lowest; 8 stands for a column that passed without contact. What a
hypothesis numbers as cell k is given out as cell k + AHEAD.
"""

import numba as nb

from solve.compiled import piece

PLACE, LOG_SPEED, MEAN_LOG_SPEED, LOG_WEIGHT = range(4)
WAY, YAW, TOUCH, SEEN, COLUMNS, AHEAD = range(6)
UNSEEN, KEPT_COLUMNS = 8, 16
ROWS, KEPT_HEIGHTS = 3, 4
HEIGHT, SPREAD, LATERAL = 0, ROWS * KEPT_HEIGHTS, 2 * ROWS * KEPT_HEIGHTS
LEVEL = LATERAL + 9
"""Places in the memory; of the rate of the drift n behind its level, of the gain 2 n, of its variance 3 n and of the
change of the rate 4 n.
"""
FORTH, STILL, BACK = 1, 0, -1


@nb.njit(cache=True)
def column_of(columns, seen, number):  # type: ignore[no-untyped-def]
    """The pattern of a column by its number; blank before the first one and where it is kept no more."""
    back = seen - 1 - number
    if number < 0 or back >= KEPT_COLUMNS:
        return 0
    return (columns >> (4 * back)) & 15


@piece()
def kind_before(columns, seen, number):  # type: ignore[no-untyped-def]
    """What is known before a column: 0, 1 for the first one of a cell, behind a cell with dots or a blank one; 2, 3 for
    the second one, behind a column with dots or a blank one.
    """
    before = column_of(columns, seen, number - 1) == 0
    if number % 2:
        return 3 if before else 2
    return 1 if before and column_of(columns, seen, number - 2) == 0 else 0
