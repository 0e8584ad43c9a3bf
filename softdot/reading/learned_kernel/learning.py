"""Learning a kernel from labelled touches: where they lie in time and across the line, what each cell is like."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.special import log_softmax, logsumexp

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from softdot.progress import Progress
from softdot.reading.cells import DOTS
from softdot.reading.learned_kernel.cell_process import Expected, expect_cells, parts_of_covariance
from softdot.reading.learned_kernel.courses import (
    REST_SHARE,
    STEPS,
    compressed,
    courses_of,
    noise_at_rest,
    place_range_of,
    shift_courses,
)
from softdot.reading.learned_kernel.kernel_file import KernelView, LearnedKernel
from softdot.reading.learned_kernel.scatter import scatter_of_cells
from softdot.reading.learned_kernel.scores import along_axes, scores_by_cause, scores_of_touches
from softdot.reading.learned_kernel.superposition import PLACES, best_lag, superposed_courses
from softdot.reading.learned_kernel.touches import Touches, clipped_channels
from softdot.version import installed_version

VIEWS, ALIGNMENTS, SHIFTS = ((40, np.inf), (25, 12.0)), 3, np.arange(-4.0, 5.0)
"""Axes that are kept in each view, and from what value on, in units of the noise, it compresses; rounds of alignment,
and shifts in steps of a course that are tried.
"""
LEAST_CELLS, LEAST_TOUCHES = 6, 2
"""Different cells, and touches of each, that are needed."""
LIKENESS_PITCHES, LEAST_COUNT = 0.4, 0.2
"""Pitches across over which what superposition misses changes; touches of a cell at a place that are needed there."""
QUIETEST = 0.3
"""Least noise of a channel that is believed, of the median of all."""
RISE, RISE_IF_CLIPPED = 1.45, 4.0
"""By which the variance of a channel must rise as dots pass, and where most of its values are clipped."""
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
    heard = _heard_channels(touches, keep_rest)
    courses = courses_of(touches, keep_rest, place_range)[:, :, heard]
    progress.stage("learn")
    aligned = [_aligned_view(courses, cells, *of_view) for of_view in VIEWS]
    views = tuple(view for view, _, _ in aligned)
    sure = _sureness(*_left_out_scores(courses, aligned, cells, progress), np.unique(cells))
    return LearnedKernel(
        views,
        about={
            "softdot_version": installed_version(),
            "channels": touches.taxels.shape[2],
            "channels_heard": (heard + 1).tolist(),
            "sampling_Hz": touches.sampling_Hz,
            "duration_s": touches.duration_s,
            "place_range_mm": place_range,
            "rest_kept": keep_rest,
            "noise_at_rest": noise_at_rest(courses * views[0].weight),
            "touches_of_cells": {str(cell): int(np.sum(cells == cell)) for cell in np.unique(cells)},
            "lags_steps": [view.lag_steps for view in views],
            "share_of_dots": share_of_dots(views[0]),
            **sure,
            "warnings": _warnings(touches, cells, heard),
        },
    )


def share_of_dots(view: KernelView) -> float:
    """Share of what sets the 64 cells apart, in units of the noise, that is the superposition of courses of dots."""
    noise = np.linalg.cholesky(view.scatter.mean(axis=0))
    mean, beyond = (one[:, len(PLACES) // 2] for one in (view.mean, view.mean - view.dot_mean))
    whole, missed = (np.linalg.solve(noise, (one - one.mean(axis=0)).T) for one in (mean, beyond))
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
    if not np.ptp(touches.taxels, axis=(0, 1)).any():
        raise InputError("taxels: no channel ever changes")
    return touches.cells


def _warnings(touches: Touches, cells: Ints, heard: Ints) -> list[str]:
    """What limits the kernel: dots that were never touched or never absent, channels clipped or left out."""
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
    deaf = np.setdiff1d(np.arange(touches.taxels.shape[2]), heard) + 1
    if len(deaf):
        found.append(f"channels that do not answer to dots and are left out: {', '.join(map(str, deaf))}")
    return found


def _aligned_view(
    courses: Floats, cells: Ints, most_axes: int, limit_in_noise: float
) -> tuple[KernelView, Floats, Floats]:
    """One view of touches, the shifts (n,) in steps by which they come late, and the shares (n, p) of the places
    where they may lie, found by turns: first from superposition alone, with all touches in the middle.
    """
    limit = limit_in_noise / _channel_weights(courses, cells)
    courses = compressed(courses, limit)
    shares = np.tile((PLACES == 0.0).astype(np.float64), (len(courses), 1))
    view = _view_of(courses, cells, shares, most_axes, limit)
    for number in range(ALIGNMENTS):
        moved, mean = along_axes(view, courses), view.mean if number else view.dot_mean
        score = np.empty((*moved.shape[:2], len(PLACES)))
        for cell in np.unique(cells):
            score[cells == cell] = scores_by_cause(view, moved[cells == cell], mean, cell)
        likely = np.exp(score - logsumexp(score, axis=(1, 2), keepdims=True))
        shifts, shares = likely.sum(axis=2) @ view.shift_steps, likely.sum(axis=1)
        shifts -= shifts.mean()
        view = _view_of(shift_courses(courses, shifts), cells, shares, most_axes, limit, view.lag_steps)
    return view, shifts, shares


def _view_of(
    courses: Floats, cells: Ints, shares: Floats, most_axes: int, limit: Floats, lag: float | None = None
) -> KernelView:
    """The view of aligned touches (n, t, c), compressed from the limit (c,) on, with shares (n, p) of places."""
    kinds, place = np.unique(cells, return_inverse=True)
    weight, centre = _channel_weights(courses, cells), courses.mean(axis=0)
    flat = ((courses - centre) * weight).reshape(len(courses), -1)
    degrees = len(courses) - len(kinds)
    axes = np.linalg.svd(flat, full_matrices=False)[2][: min(most_axes, max(1, degrees - 1))].T
    of_cells = np.eye(len(kinds))[place]
    counts = of_cells.T @ shares
    means = np.einsum("nk,np,nx->kpx", of_cells, shares, flat, optimize=True) / np.maximum(counts, 1e-9)[..., None]
    lag = best_lag(kinds, _means_of_cells(flat, cells).reshape(-1, *centre.shape)) if lag is None else lag
    superposed = superposed_courses(kinds, counts, means.reshape(*counts.shape, *centre.shape), lag)
    superposed = superposed.reshape(*superposed.shape[:2], -1) @ axes
    touches, means = flat @ axes, means @ axes
    noise = np.einsum("np,npd->d", shares, (touches[:, None] - means[place]) ** 2) / degrees
    expected = _expected(kinds, counts, means - superposed[kinds], noise)
    mean = superposed + np.stack([one.mean for one in expected], axis=2)
    return KernelView(
        limit=limit,
        centre=centre,
        weight=weight,
        axes=axes.reshape(*centre.shape, -1),
        mean=mean,
        dot_mean=superposed,
        variance=np.stack([one.variance for one in expected], axis=2),
        scatter=scatter_of_cells(touches - np.einsum("np,npd->nd", shares, mean[cells]), cells),
        shift_steps=SHIFTS,
        lag_steps=lag,
    )


def _expected(kinds: Ints, counts: Floats, missed: Floats, noise: Floats) -> list[Expected]:
    """What superposition misses in each cell at each place, for every axis; missed (k, p, d) in cells (k,) learned."""
    parts, alike = parts_of_covariance(), np.exp(-0.5 * ((PLACES[:, None] - PLACES) / LIKENESS_PITCHES) ** 2)
    cell, place = np.nonzero(counts > LEAST_COUNT)
    states, many = kinds[cell] * len(PLACES) + place, counts[cell, place]
    return [
        expect_cells(parts, alike, states, one, own / many)
        for one, own in zip(missed[cell, place].T, noise, strict=True)
    ]


def _means_of_cells(touches: Floats, cells: Ints) -> Floats:
    """Mean of the touches (n, ...) of each cell, by rising cell."""
    return np.array([touches[cells == kind].mean(axis=0) for kind in np.unique(cells)])


def _heard_channels(touches: Touches, keep_rest: bool) -> Ints:
    """Channels, from 0 on, in which more happens while dots pass than before; all that change where the rest is kept.

    One that is clipped most of the time tells rather how hard the finger was pressed on, unless dots stand out in it.
    """
    alive = np.ptp(touches.taxels, axis=(0, 1)) > 0.0
    courses, first = courses_of(touches, False, None), max(1, round(REST_SHARE * STEPS))
    before, after = courses[:, :first].var(axis=(0, 1)), courses[:, first:].var(axis=(0, 1))
    clipped = [clipped_channels(touches.taxels).get(number + 1, 0.0) > 0.5 for number in range(len(alive))]
    heard = alive & (keep_rest | (after > np.where(clipped, RISE_IF_CLIPPED, RISE) * before))
    return np.flatnonzero(heard if heard.any() else alive)


def _channel_weights(courses: Floats, cells: Ints) -> Floats:
    """One over the noise (c,) of each channel before the dots come."""
    before = courses[:, : max(1, round(REST_SHARE * STEPS))]
    means = _means_of_cells(before, cells)[np.unique(cells, return_inverse=True)[1]]
    noise = np.sqrt(((before - means) ** 2).mean(axis=(0, 1)))
    heard = noise[noise > 0.0]
    return np.asarray(1.0 / np.maximum(noise, QUIETEST * float(np.median(heard)) if len(heard) else 1.0))


def _left_out_scores(
    courses: Floats, views: Sequence[tuple[KernelView, Floats, Floats]], cells: Ints, progress: Progress
) -> tuple[Any, Any, Any, Any]:
    """Scores and cells of touches of cells that were left out, then of touches left out while others stayed.

    views : each with the shifts (n,) and shares of places (n, p) of all touches.
    """
    kinds = np.random.default_rng(0).permutation(np.unique(cells))
    apart = [np.isin(cells, kinds[first : first + CELLS_LEFT_OUT]) for first in range(0, len(kinds), CELLS_LEFT_OUT)]
    turn = np.array([np.sum(cells[:number] == cell) for number, cell in enumerate(cells)])
    turn = (turn + np.searchsorted(np.unique(cells), cells)) % FOLDS_OF_TOUCHES  # of two touches never all first ones
    folds = [*apart, *(turn == part for part in range(FOLDS_OF_TOUCHES))]
    scores = []
    for number, out in enumerate(folds):
        learned = []
        for (view, shifts, shares), (most_axes, _) in zip(views, VIEWS, strict=True):
            moved = shift_courses(compressed(courses[~out], view.limit), shifts[~out])
            learned.append(_view_of(moved, cells[~out], shares[~out], most_axes, view.limit, view.lag_steps))
        scores.append(scores_of_touches(learned, courses[out]))
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
