"""Learning a kernel from labelled touches: alignment in time, axes, what each cell is like, and how sure to be."""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.special import log_softmax, logsumexp

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from softdot.progress import Progress
from softdot.reading.cells import DOTS, KINDS_OF_CELL
from softdot.reading.learned_kernel.cell_process import expect_cells, parts_of_covariance
from softdot.reading.learned_kernel.courses import REST_SHARE, STEPS, courses_of, place_range_of, shift_courses
from softdot.reading.learned_kernel.kernel_file import LearnedKernel
from softdot.reading.learned_kernel.scatter import scatter_of_cells
from softdot.reading.learned_kernel.scores import along_axes, scores_by_shift, scores_of_touches
from softdot.reading.learned_kernel.superposition import best_lag, superposed_courses
from softdot.reading.learned_kernel.touches import Touches, clipped_channels, dead_channels
from softdot.version import installed_version

MOST_AXES, ALIGNMENTS, SHIFTS = 25, 2, np.arange(-4.0, 5.0)
"""Axes that are kept, rounds of alignment, and shifts in steps of a course that are tried."""
LEAST_CELLS, LEAST_TOUCHES = 6, 2
"""Different cells, and touches of each, that are needed."""
QUIETEST = 0.3
"""Least noise of a channel that is believed, of the median of all."""
CELLS_LEFT_OUT, FOLDS_OF_TOUCHES, TOGETHER = 3, 4, 5
"""To learn how sure to be: cells that are left out together, parts into which the touches of each cell are cut, and
touches that are read together.
"""
TRUST = np.geomspace(0.02, 2.0, 93)
"""Factors of the scores that are tried."""


def learn_kernel(touches: Touches, keep_rest: bool, progress: Progress) -> LearnedKernel:
    """Learn what touches of all 64 cells are like. InputError for too few cells or touches, or none with a letter.

    keep_rest : whether the values before the touch are used, not only what changes.
    """
    cells = _checked_cells(touches)
    place_range = place_range_of(touches)
    if place_range is not None and not place_range[1] > place_range[0]:
        raise InputError("place_mm: no place is passed by all touches; cut them alike")
    courses = courses_of(touches, keep_rest, place_range)
    progress.stage("learn")
    kernel, shifts = _aligned_kernel(courses, cells)
    lag = kernel.about["lag_steps"]
    sure = _sureness(*_left_out_scores(courses, shifts, cells, lag, progress), np.unique(cells))
    return replace(
        kernel,
        about={
            "softdot_version": installed_version(),
            "channels": touches.taxels.shape[2],
            "sampling_Hz": touches.sampling_Hz,
            "duration_s": touches.duration_s,
            "place_range_mm": place_range,
            "rest_kept": keep_rest,
            "touches_of_cells": {str(cell): int(np.sum(cells == cell)) for cell in np.unique(cells)},
            "lag_steps": lag,
            "share_of_dots": share_of_dots(kernel),
            **sure,
            "warnings": _warnings(touches, cells),
        },
    )


def share_of_dots(kernel: LearnedKernel) -> float:
    """Share of what sets the 64 cells apart, in units of the noise, that is the superposition of courses of dots."""
    noise = np.linalg.cholesky(kernel.scatter.mean(axis=0))
    whole = np.linalg.solve(noise, (kernel.mean - kernel.mean.mean(axis=0)).T)
    missed = np.linalg.solve(noise, (kernel.mean - kernel.dot_mean - (kernel.mean - kernel.dot_mean).mean(axis=0)).T)
    return float(1.0 - (missed**2).sum() / (whole**2).sum())


def _checked_cells(touches: Touches) -> Ints:
    """The cells (n,) of the touches. InputError where they are too few."""
    if touches.cells is None:
        raise InputError("letter is missing: what was touched must be known to learn from it")
    kinds, counts = np.unique(touches.cells, return_counts=True)
    if len(kinds) < LEAST_CELLS or counts.min() < LEAST_TOUCHES:
        raise InputError(
            f"letter: {len(kinds)} different cells, at least {counts.min()} touches of each: at least {LEAST_CELLS} "
            f"cells and {LEAST_TOUCHES} touches of each are needed"
        )
    if len(dead_channels(touches.taxels)) == touches.taxels.shape[2]:
        raise InputError("taxels: no channel ever changes")
    return touches.cells


def _warnings(touches: Touches, cells: Ints) -> list[str]:
    """What limits the kernel: dots that were never touched or never absent, clipped and dead channels."""
    found = []
    raised = (cells[:, None] >> np.arange(DOTS) & 1).astype(bool)
    for dot in range(DOTS):
        share = raised[:, dot].mean()
        if share in (0.0, 1.0):
            found.append(f"dot {dot + 1} is raised in {'all' if share else 'none'} of the learned cells: it is guessed")
    clipped = clipped_channels(touches.taxels)
    if clipped:
        told = ", ".join(f"{number} ({100 * share:.0f} %)" for number, share in clipped.items())
        found.append(f"channels with many values at their least or largest one, clipped perhaps: {told}")
    dead = dead_channels(touches.taxels)
    if dead:
        found.append(f"channels that never change and are left out: {', '.join(map(str, dead))}")
    return found


def _aligned_kernel(courses: Floats, cells: Ints) -> tuple[LearnedKernel, Floats]:
    """The kernel of touches, and the shifts (n,) in steps by which they come late, found by turns."""
    shifts = np.zeros(len(courses))
    kernel = _kernel_of(courses, cells)
    for _ in range(ALIGNMENTS):
        by_shift = scores_by_shift(kernel, along_axes(kernel, courses), kernel.mean)
        own = by_shift[np.arange(len(cells)), :, cells]
        shifts = np.exp(own - logsumexp(own, axis=1, keepdims=True)) @ kernel.shift_steps
        shifts -= shifts.mean()
        kernel = _kernel_of(shift_courses(courses, shifts), cells)
    return kernel, shifts


def _kernel_of(courses: Floats, cells: Ints, lag: float | None = None) -> LearnedKernel:
    """The kernel of aligned touches (n, t, c), which says nothing about itself yet."""
    kinds, place, counts = np.unique(cells, return_inverse=True, return_counts=True)
    weight = _channel_weights(courses, cells)
    centre = courses.mean(axis=0)
    flat = ((courses - centre) * weight).reshape(len(courses), -1)
    degrees = len(courses) - len(kinds)
    axes = np.linalg.svd(flat, full_matrices=False)[2][: min(MOST_AXES, max(1, degrees - 1))].T
    touches = flat @ axes
    means = np.array([touches[cells == kind].mean(axis=0) for kind in kinds])
    residuals = touches - means[place]
    mean_courses = np.array([flat[cells == kind].mean(axis=0) for kind in kinds]).reshape(-1, *centre.shape)
    lag = best_lag(kinds, mean_courses) if lag is None else lag
    superposed = superposed_courses(kinds, mean_courses, lag).reshape(KINDS_OF_CELL, -1) @ axes
    missed = means - superposed[kinds]
    parts, noise = parts_of_covariance(), (residuals**2).sum(axis=0) / degrees
    expected = [expect_cells(parts, kinds, one, own / counts) for one, own in zip(missed.T, noise, strict=True)]
    return LearnedKernel(
        centre=centre,
        weight=weight,
        axes=axes.reshape(*centre.shape, -1),
        mean=superposed + np.stack([one.mean for one in expected], axis=1),
        dot_mean=superposed,
        variance=np.stack([one.variance for one in expected], axis=1),
        scatter=scatter_of_cells(residuals, cells),
        shift_steps=SHIFTS,
        about={"lag_steps": lag},
    )


def _channel_weights(courses: Floats, cells: Ints) -> Floats:
    """One over the noise (c,) of each channel before the dots come; 0 for a dead one."""
    before = courses[:, : max(1, round(REST_SHARE * STEPS))]
    kinds, place = np.unique(cells, return_inverse=True)
    means = np.array([before[cells == kind].mean(axis=0) for kind in kinds])
    noise = np.sqrt(((before - means[place]) ** 2).mean(axis=(0, 1)))
    alive = np.ptp(courses, axis=(0, 1)) > 0.0
    heard = noise[alive & (noise > 0.0)]
    least = QUIETEST * float(np.median(heard)) if len(heard) else 1.0
    return np.where(alive, 1.0 / np.maximum(noise, least), 0.0)


def _left_out_scores(
    courses: Floats, shifts: Floats, cells: Ints, lag: float, progress: Progress
) -> tuple[Any, Any, Any, Any]:
    """Scores and cells of touches of cells that were left out, then of touches left out while others stayed."""
    aligned = shift_courses(courses, shifts)
    kinds = np.random.default_rng(0).permutation(np.unique(cells))
    apart = [np.isin(cells, kinds[first : first + CELLS_LEFT_OUT]) for first in range(0, len(kinds), CELLS_LEFT_OUT)]
    turn = np.array([np.sum(cells[:number] == cell) for number, cell in enumerate(cells)])
    turn = (turn + np.searchsorted(np.unique(cells), cells)) % FOLDS_OF_TOUCHES  # of two touches never all first ones
    folds = [*apart, *(turn == part for part in range(FOLDS_OF_TOUCHES))]
    scores = []
    for number, out in enumerate(folds):
        kernel = _kernel_of(aligned[~out], cells[~out], lag)
        scores.append(scores_of_touches(kernel, along_axes(kernel, courses[out])))
        progress.step(number + 1, len(folds), "left out")
    count = len(apart)
    true = [cells[out] for out in folds]
    return (
        np.concatenate(scores[:count]), np.concatenate(true[:count]),
        np.concatenate(scores[count:]), np.concatenate(true[count:]),
    )  # fmt: skip


def _sureness(unseen: Floats, unseen_cells: Ints, seen: Floats, seen_cells: Ints, learned: Ints) -> dict[str, Any]:
    """How sure to be by what was left out: the factor of scores, trust, at which the probabilities of true cells are
    largest, the exponent by which it falls with the number of touches that are read together, and the rates.

    Touches of one cell share what is not known of that cell, so that five of them say less than five times as much.
    """
    trust = _best_trust(np.concatenate([unseen, seen]), np.concatenate([unseen_cells, seen_cells]))
    fives, five_cells = [], []
    for cell in np.unique(unseen_cells):
        own = unseen[unseen_cells == cell]
        fives += [own[first : first + TOGETHER].sum(axis=0) for first in range(0, len(own) - TOGETHER + 1, TOGETHER)]
        five_cells += [cell] * (len(own) // TOGETHER)
    of_five = _best_trust(np.array(fives), np.array(five_cells)) if fives else trust / TOGETHER
    return {
        "trust": trust,
        "trust_among_learned": _best_trust(seen[:, learned], np.searchsorted(learned, seen_cells)),
        "shared_error": float(np.clip(np.log(trust / of_five) / np.log(TOGETHER), 0.0, 1.0)),
        "least_score": float(min(unseen.max(axis=1).min(), seen.max(axis=1).min())),
        "cells_left_out_read": float((unseen.argmax(axis=1) == unseen_cells).mean()),
        "touches_left_out_read": float((seen.argmax(axis=1) == seen_cells).mean()),
    }


def _best_trust(score: Floats, cells: Ints) -> float:
    """Factor of scores (n, k) of k cells at which the true ones (n,) are most probable."""
    told = [log_softmax(trust * score, axis=1)[np.arange(len(cells)), cells].mean() for trust in TRUST]
    return float(TRUST[int(np.argmax(told))])
