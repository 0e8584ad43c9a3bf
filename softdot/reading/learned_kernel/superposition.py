"""Superposition of dots: a field along the way and across it, which each dot leaves from where it passes the sensor.

The left and the right dot of a row leave the same course, the right one later by the lag of the columns. The three rows
lie one pitch beside each other in the one field, and the lateral place of a touch moves all of them across it. What a
cell leaves is the sum over its dots, which falls as they share the load, on a course that all touches have. Field and
common course are Gaussian processes, smooth over time and across the line, for each channel by itself.
"""

from functools import lru_cache

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from foundation.arrays import Floats, Ints
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.learned_kernel.cell_process import answers_to_dots

ROWS, NODES_OF_PITCH, REACH = 3, 5, 3
"""Rows of dots; nodes of the field in a pitch between rows, and to either side where touches may lie."""
PLACES = np.arange(-REACH, REACH + 1) / NODES_OF_PITCH
"""Lateral places of touches, in pitches of dots."""
SMOOTH_STEPS, SMOOTH_PITCHES = 3.0, 0.8
"""Steps of time and pitches across over which the field changes."""
COMMON, NOISE, MISSED = 3.0, 0.3, 0.3
"""Variances over that of the field: of the course of all touches, of one touch, and of what superposition misses."""
LAGS = np.concatenate([-np.arange(2.0, 10.1, 0.5)[::-1], np.arange(2.0, 10.1, 0.5)])
"""Lags in steps that are tried; below 0 the right column comes first."""
LEAST_SIZE = 1e-3
"""Of the largest: variance of a pattern of the field that is kept."""


def best_lag(cells: Ints, courses: Floats) -> float:
    """The lag in steps with the largest evidence; courses (k, t, c) : mean courses of cells (k,)."""
    values, places = courses.reshape(-1, courses.shape[2]), np.array([REACH])
    evidence = []
    for lag in LAGS:
        patterns = _patterns(cells, places, courses.shape[1], lag).reshape(len(values), -1)
        factor = cho_factor(np.eye(patterns.shape[1]) + patterns.T @ patterns / MISSED, lower=True)
        explained = ((patterns.T @ values) * cho_solve(factor, patterns.T @ values)).sum(axis=0) / MISSED
        left = np.maximum((values**2).sum(axis=0) - explained, 1e-300)
        evidence.append(-np.log(np.diag(factor[0])).sum() * len(left) - 0.5 * len(values) * np.log(left).sum())
    return float(LAGS[int(np.argmax(evidence))])


def superposed_courses(cells: Ints, counts: Floats, courses: Floats, lag: float) -> Floats:
    """Courses (64, p, t, c) of all cells at all places by superposition.

    courses (k, p, t, c) : means of the touches of cells (k,) at each place, of which there are counts (k, p).
    """
    length = courses.shape[2]
    patterns = _patterns_of_all(length, lag)
    size = patterns.shape[3]
    own = patterns[cells].reshape(-1, size)
    trust = np.repeat((counts / (MISSED * counts + NOISE)).ravel(), length)[:, None]
    weights = np.linalg.solve(own.T @ (trust * own) + np.eye(size), own.T @ (trust * courses.reshape(len(own), -1)))
    return np.asarray(patterns @ weights)


@lru_cache(maxsize=2)
def _patterns_of_all(length: int, lag: float) -> Floats:
    """Courses of all cells at all places, kept as each learning needs the same ones many times."""
    return _patterns(np.arange(KINDS_OF_CELL), np.arange(len(PLACES)), length, lag)


def _patterns(cells: Ints, places: Ints, length: int, lag: float) -> Floats:
    """Courses (k, p, t, m) that m patterns of unit variance leave, of the field first and of the common course."""
    spare = int(LAGS.max())
    nodes = np.arange(-spare, length + spare)
    along = _root(_matern(nodes))
    across = np.arange(2 * (NODES_OF_PITCH + REACH) + 1) / NODES_OF_PITCH
    beside = _root(np.exp(-0.5 * ((across[:, None] - across) / SMOOTH_PITCHES) ** 2))
    dots = answers_to_dots(cells)
    of_field = 0.0
    for column, late in enumerate((0.0, lag)):
        course = np.array([np.interp(np.arange(length) - late, nodes, one) for one in along.T]).T
        rows = dots[:, ROWS * column : ROWS * (column + 1)]
        at = places[:, None] + NODES_OF_PITCH * np.arange(ROWS)[::-1]
        of_field = of_field + np.einsum("kr,prb,ta->kptab", rows, beside[at], course, optimize=True)
    shape = (len(cells), len(places), length)
    common = np.sqrt(COMMON) * _root(_matern(np.arange(length)))
    return np.concatenate([np.reshape(of_field, (*shape, -1)), np.broadcast_to(common, (*shape, common.shape[1]))], 3)


def _matern(steps: Floats | Ints) -> Floats:
    """Matérn's covariance of order 5/2 between steps."""
    far = np.sqrt(5.0) * np.abs(steps[:, None] - steps) / SMOOTH_STEPS
    return np.asarray((1.0 + far + far**2 / 3.0) * np.exp(-far))


def _root(covariance: Floats) -> Floats:
    """Patterns (n, m) whose squares make up the covariance (n, n), but for small ones."""
    size, axes = np.linalg.eigh(covariance)
    kept = size > LEAST_SIZE * size.max()
    return np.asarray(axes[:, kept] * np.sqrt(size[kept]))
