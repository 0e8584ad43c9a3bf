"""How well touches agree with each cell: logarithms of Student likelihoods, summed over shifts and lateral places."""

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from foundation.arrays import Floats
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.learned_kernel.courses import shift_courses
from softdot.reading.learned_kernel.kernel_file import LearnedKernel
from softdot.reading.learned_kernel.superposition import PLACES

FREEDOM, SHIFT_DEVIATION_STEPS, PLACE_DEVIATION_PITCHES = 8.0, 1.6, 0.24
"""Degrees of freedom of the likelihood, which forgive touches far from all; deviations of the shift and of the lateral
place of a touch.
"""


def along_axes(kernel: LearnedKernel, courses: Floats) -> Floats:
    """Touches (n, s, d) along the axes of the kernel, moved by each of its shifts; courses : (n, t, c)."""
    axes = kernel.axes.reshape(-1, kernel.axes.shape[2])
    moved = [(shift_courses(courses, steps) - kernel.centre) * kernel.weight for steps in kernel.shift_steps]
    return np.stack([one.reshape(len(courses), -1) @ axes for one in moved], axis=1)


def scores_by_cause(kernel: LearnedKernel, touches: Floats, mean: Floats, cell: int) -> Floats:
    """Logarithm (n, s, p) of the density of touches (n, s, d) of a cell for each shift and place; mean : (64, p, d)."""
    count, shifts, size = touches.shape
    found = np.empty((count, shifts, len(PLACES)))
    for place, (centre, variance) in enumerate(zip(mean[cell], kernel.variance[cell], strict=True)):
        factor = np.linalg.cholesky(kernel.scatter[cell] + np.diag(variance))
        away = solve_triangular(factor, (touches - centre).reshape(-1, size).T, lower=True)
        distance = (away**2).sum(axis=0).reshape(count, shifts)
        found[..., place] = -0.5 * (FREEDOM + size) * np.log1p(distance / FREEDOM) - np.log(np.diag(factor)).sum()
    late, aside = kernel.shift_steps / SHIFT_DEVIATION_STEPS, PLACES / PLACE_DEVIATION_PITCHES
    return np.asarray(found - 0.5 * (late**2)[:, None] - 0.5 * aside**2)


def scores_of_touches(kernel: LearnedKernel, touches: Floats, by_dots_alone: bool = False) -> Floats:
    """Scores (n, 64) of touches (n, s, d). by_dots_alone : with the means of superposition."""
    mean = kernel.dot_mean if by_dots_alone else kernel.mean
    cells = [logsumexp(scores_by_cause(kernel, touches, mean, cell), axis=(1, 2)) for cell in range(KINDS_OF_CELL)]
    return np.stack(cells, axis=1)
