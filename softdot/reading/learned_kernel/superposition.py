"""Superposition of dots that pass one after the other: each row of dots leaves one course, and leaves it twice.

The left and the right dot of a row pass the sensor on the same way, so that they leave the same course, the right one
later by the lag of the columns. What a cell leaves is the sum of the courses of its dots, which fall together as they
share the load, on a course that all touches have. These courses are Gaussian processes over time.
"""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from foundation.arrays import Floats, Ints
from softdot.reading.cells import DOTS, KINDS_OF_CELL
from softdot.reading.learned_kernel.cell_process import LIKENESS_DOTS, load_shares

ROWS, SMOOTH_STEPS = 3, 3.0
"""Rows of dots, and steps over which a course changes."""
COMMON, ROW, CELL, NOISE = 3.0, 1.0, 0.3, 0.05
"""Variances of the course of all touches, of those of rows, of what superposition misses, and of noise, over that of a
row.
"""
LAGS = np.concatenate([-np.arange(2.0, 10.1, 0.5)[::-1], np.arange(2.0, 10.1, 0.5)])
"""Lags in steps that are tried; below 0 the right column comes first."""


def best_lag(cells: Ints, courses: Floats) -> float:
    """The lag in steps with the largest evidence; courses (k, t, c) : mean courses of cells (k,)."""
    flat = courses.reshape(-1, courses.shape[2])
    evidence = []
    for lag in LAGS:
        factor = cho_factor(_covariance(cells, courses.shape[1], lag), lower=True)
        size = np.maximum((flat * cho_solve(factor, flat)).sum(axis=0) / len(flat), 1e-300)
        evidence.append(-np.log(np.diag(factor[0])).sum() * len(size) - 0.5 * len(flat) * np.log(size).sum())
    return float(LAGS[int(np.argmax(evidence))])


def superposed_courses(cells: Ints, courses: Floats, lag: float) -> Floats:
    """Courses (64, t, c) of all cells by superposition, after mean courses (k, t, c) of some cells (k,)."""
    length = courses.shape[1]
    weights = cho_solve(cho_factor(_covariance(cells, length, lag), lower=True), courses.reshape(-1, courses.shape[2]))
    every = np.arange(KINDS_OF_CELL)
    return np.asarray((_superposed(every, cells, length, lag) @ weights).reshape(len(every), length, -1))


def _covariance(cells: Ints, length: int, lag: float) -> Floats:
    """Covariance (k t, k t) of mean courses of cells, with what superposition misses and with noise."""
    dots = _dots(cells)
    apart = np.abs(dots[:, None] - dots).sum(axis=2)
    missed = np.kron(np.exp(-apart / LIKENESS_DOTS), _likeness(length, 0.0))
    return _superposed(cells, cells, length, lag) + CELL * missed + NOISE * np.eye(len(missed))


def _superposed(one: Ints, other: Ints, length: int, lag: float) -> Floats:
    """Covariance (k t, m t) of the superposed courses of cells one (k,) and other (m,)."""
    own, its = _dots(one), _dots(other)
    load = np.outer(load_shares(one), load_shares(other))
    left, right, left_too, right_too = own[:, :ROWS], own[:, ROWS:], its[:, :ROWS], its[:, ROWS:]
    found = COMMON * np.kron(np.ones_like(load), _likeness(length, 0.0))
    for pairs, late in (
        (left @ left_too.T + right @ right_too.T, 0.0), (left @ right_too.T, lag), (right @ left_too.T, -lag),
    ):  # fmt: skip
        found += ROW * np.kron(load * pairs, _likeness(length, late))
    return np.asarray(found)


def _likeness(length: int, late: float) -> Floats:
    """Matérn's covariance (t, t) of order 5/2 of a course with itself, the second time late by some steps."""
    steps = np.arange(length)
    far = np.sqrt(5.0) * np.abs(steps[:, None] - steps + late) / SMOOTH_STEPS
    return np.asarray((1.0 + far + far**2 / 3.0) * np.exp(-far))


def _dots(cells: Ints) -> Floats:
    return (cells[:, None] >> np.arange(DOTS) & 1).astype(np.float64)
