"""How well touches agree with each cell: logarithms of Student likelihoods, summed over shifts and lateral places."""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from foundation.arrays import Floats
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.learned_kernel.courses import compressed, shift_courses
from softdot.reading.learned_kernel.kernel_file import KernelView
from softdot.reading.learned_kernel.superposition import PLACES

FREEDOM, SHIFT_DEVIATION_STEPS, PLACE_DEVIATION_PITCHES = 8.0, 1.6, 0.24
"""Degrees of freedom of the likelihood, which forgive touches far from all; deviations of the shift and of the lateral
place of a touch.
"""


def along_axes(view: KernelView, courses: Floats) -> Floats:
    """Touches (n, s, d) along the axes of the view, moved by each of its shifts; courses : (n, t, c)."""
    axes = view.axes.reshape(-1, view.axes.shape[2])
    moved = [(shift_courses(courses, steps) - view.centre) * view.weight for steps in view.shift_steps]
    return np.stack([one.reshape(len(courses), -1) @ axes for one in moved], axis=1)


def scores_by_cause(view: KernelView, touches: Floats, mean: Floats, cell: int) -> Floats:
    """Logarithm (n, s, p) of the density of touches (n, s, d) of a cell for each shift and place; mean : (64, p, d)."""
    count, shifts, size = touches.shape
    found = np.empty((count, shifts, len(PLACES)))
    for place, (centre, variance) in enumerate(zip(mean[cell], view.variance[cell], strict=True)):
        factor = np.linalg.cholesky(view.scatter[cell] + np.diag(variance))
        away = solve_triangular(factor, (touches - centre).reshape(-1, size).T, lower=True)
        distance = (away**2).sum(axis=0).reshape(count, shifts)
        found[..., place] = -0.5 * (FREEDOM + size) * np.log1p(distance / FREEDOM) - np.log(np.diag(factor)).sum()
    late, aside = view.shift_steps / SHIFT_DEVIATION_STEPS, PLACES / PLACE_DEVIATION_PITCHES
    return np.asarray(found - 0.5 * (late**2)[:, None] - 0.5 * aside**2)


def scores_of_touches(views: Sequence[KernelView], courses: Floats, by_dots_alone: bool = False) -> Floats:
    """Scores (n, 64) of courses (n, t, c), the mean of those of all views. by_dots_alone : with superposed means."""
    found = np.zeros((len(courses), KINDS_OF_CELL))
    for view in views:
        moved, mean = along_axes(view, compressed(courses, view.limit)), view.dot_mean if by_dots_alone else view.mean
        for cell in range(KINDS_OF_CELL):
            found[:, cell] += logsumexp(scores_by_cause(view, moved, mean, cell), axis=(1, 2)) / len(views)
    return found
