"""How well touches agree with each cell: logarithms of Student likelihoods, summed over shifts in time."""

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from foundation.arrays import Floats
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.learned_kernel.courses import shift_courses
from softdot.reading.learned_kernel.kernel_file import LearnedKernel

FREEDOM, SHIFT_DEVIATION_STEPS = 8.0, 1.6
"""Degrees of freedom of the likelihood, which forgive touches far from all; deviation of the shift of a touch."""


def along_axes(kernel: LearnedKernel, courses: Floats) -> Floats:
    """Touches (n, s, d) along the axes of the kernel, moved by each of its shifts; courses : (n, t, c)."""
    axes = kernel.axes.reshape(-1, kernel.axes.shape[2])
    moved = [(shift_courses(courses, steps) - kernel.centre) * kernel.weight for steps in kernel.shift_steps]
    return np.stack([one.reshape(len(courses), -1) @ axes for one in moved], axis=1)


def scores_by_shift(kernel: LearnedKernel, touches: Floats, mean: Floats) -> Floats:
    """Logarithm (n, s, 64) of the density of touches (n, s, d) for each shift and each cell of the mean (64, d)."""
    count, shifts, size = touches.shape
    found = np.empty((count, shifts, KINDS_OF_CELL))
    for cell in range(KINDS_OF_CELL):
        factor = np.linalg.cholesky(kernel.scatter[cell] + np.diag(kernel.variance[cell]))
        away = solve_triangular(factor, (touches - mean[cell]).reshape(-1, size).T, lower=True)
        distance = (away**2).sum(axis=0).reshape(count, shifts)
        found[..., cell] = -0.5 * (FREEDOM + size) * np.log1p(distance / FREEDOM) - np.log(np.diag(factor)).sum()
    return found + _shift_score(kernel)[:, None]


def scores_of_touches(kernel: LearnedKernel, touches: Floats, by_dots_alone: bool = False) -> Floats:
    """Scores (n, 64) of touches (n, s, d). by_dots_alone : with the means of superposition."""
    mean = kernel.dot_mean if by_dots_alone else kernel.mean
    return np.asarray(logsumexp(scores_by_shift(kernel, touches, mean), axis=1))


def _shift_score(kernel: LearnedKernel) -> Floats:
    """Logarithm (s,) of the prior of each shift, but for a constant."""
    return np.asarray(-0.5 * (kernel.shift_steps / SHIFT_DEVIATION_STEPS) ** 2)
