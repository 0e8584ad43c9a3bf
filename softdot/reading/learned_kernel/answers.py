"""The answers of a learned kernel to touches: probabilities of all cells."""

from dataclasses import dataclass

import numpy as np
from scipy.special import softmax

from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.learned_kernel.courses import STEPS, courses_of, noise_at_rest
from softdot.reading.learned_kernel.kernel_file import LearnedKernel
from softdot.reading.learned_kernel.scores import scores_of_touches
from softdot.reading.learned_kernel.touches import SAME_SHARE, Touches, clipped_channels, letter_cells

PLACE_SHARE = 0.1
"""Of the learned way: by which a touch may begin later or end earlier."""
STILL, FOREIGN_SHARE, NOISE_RATIO = 0.25, 0.1, 5.0
"""Changes of a touch, over the noise at rest, below which the sensor is dead; share of touches unlike all learned ones,
and factor of the noise at rest, from which on a recording is of another kind (assumed).
"""
GAIN_RANGE, LEAST_OF_GAIN = (0.65, 1.5), 5
"""Gains over that of the learned touches that are taken for the same sensor (assumed), and touches that tell one."""


@dataclass(frozen=True)
class TouchAnswers:
    """Probabilities (n, 64) of the cells of touches and their scores.

    by_dots_alone (n,) : the best cells by superposition alone. unlike (n,) : whether a touch agrees less with every
    cell than any touch did that was left out while learning, or changes less than the noise at rest. foreign : whether
    so many do that nothing is stated of the recording. together : number, count and probabilities (64,) of touches of
    one cell.
    """

    probability: Floats
    log_score: Floats
    by_dots_alone: Ints
    unlike: Bools
    foreign: bool
    together: list[tuple[int, int, Floats]]
    among: str
    warnings: list[str]


def answer_touches(kernel: LearnedKernel, touches: Touches, among: str) -> TouchAnswers:
    """Answer touches of the sensor of the kernel. InputError for those of another one.

    among : the cells that may be, "all" 64, "letters" with the blank, or those "learned".
    """
    _refuse_others(kernel, touches)
    courses = courses_of(touches, kernel.about["rest_kept"], kernel.about["place_range_mm"])
    heard = courses[:, :, np.array(kernel.about["channels_heard"]) - 1]
    weighed = heard * kernel.views[0].weight
    barred = _barred(kernel, among)
    score = scores_of_touches(kernel.views, heard)
    dots = scores_of_touches(kernel.views, heard, by_dots_alone=True)
    trust = kernel.about["trust_among_learned" if among == "learned" else "trust"]
    together = []
    for number in [] if touches.together is None else np.unique(touches.together):
        rows = np.flatnonzero(touches.together == number)
        own = len(rows) ** -kernel.about["shared_error"] * score[rows].sum(axis=0)
        together.append((int(number), len(rows), softmax(trust * own + barred)))
    still = weighed.std(axis=1).max(axis=1) < STILL
    unlike = still | (score.max(axis=1) < kernel.about["least_score"])
    gain = _gain(kernel, weighed[~still], score[~still])
    warnings = _foreign_signs(kernel, weighed, still, unlike, gain)
    return TouchAnswers(
        probability=softmax(trust * score + barred, axis=1),
        log_score=score,
        by_dots_alone=(dots + barred).argmax(axis=1),
        unlike=unlike,
        foreign=bool(warnings),
        together=together,
        among=among,
        warnings=[*_warnings(touches, kernel, weighed, int(still.sum()), int(unlike.sum())), *warnings],
    )


def _barred(kernel: LearnedKernel, among: str) -> Floats:
    """Minus infinity (64,) for cells that may not be, 0 for others."""
    allowed = {
        "all": np.arange(KINDS_OF_CELL),
        "letters": np.array(list(letter_cells().values())),
        "learned": kernel.learned_cells,
    }[among]
    return np.where(np.isin(np.arange(KINDS_OF_CELL), allowed), 0.0, -np.inf)


def _refuse_others(kernel: LearnedKernel, touches: Touches) -> None:
    """InputError for touches with other channels, another duration, too few samples, or without the course of place."""
    channels, duration = kernel.about["channels"], kernel.about["duration_s"]
    if touches.taxels.shape[2] != channels:
        raise InputError(f"taxels: has {touches.taxels.shape[2]} channels, the kernel has {channels}")
    if kernel.about["place_range_mm"] is not None:
        if touches.place_mm is None:
            raise InputError("place_mm is missing: the kernel was learned over places")
        start, end = kernel.about["place_range_mm"]
        spare = PLACE_SHARE * (end - start)
        short = (touches.place_mm.min(axis=1) > start + spare) | (touches.place_mm.max(axis=1) < end - spare)
        if short.any():
            raise InputError(
                f"place_mm[{int(np.argmax(short))}]: does not pass the places from {start:.4g} to {end:.4g} mm "
                "that were learned"
            )
        return
    if abs(touches.duration_s - duration) > max(SAME_SHARE * duration, 1.0 / touches.sampling_Hz):
        raise InputError(
            f"taxels: a touch lasts {touches.duration_s:.4g} s, those of the kernel {duration:.4g} s; cut them alike"
        )
    if touches.sampling_Hz < 0.5 * min(kernel.about["sampling_Hz"], STEPS / duration):
        raise InputError(
            f"sampling_Hz = {touches.sampling_Hz:g}: is below half of the {kernel.about['sampling_Hz']:g} Hz that were "
            "learned; sample faster"
        )


def _foreign_signs(kernel: LearnedKernel, weighed: Floats, still: Bools, unlike: Bools, gain: float) -> list[str]:
    """By what a recording with the heard channels weighed (n, t, c) is of another kind than the learned ones."""
    found = []
    learned = kernel.about["noise_at_rest"]
    noise = learned if still.all() else noise_at_rest(weighed[~still])
    if learned > 0.0 and not learned / NOISE_RATIO <= noise <= learned * NOISE_RATIO:
        found.append(
            f"the noise at rest is {noise / learned:.2g} of that of the learned touches: other units, or another gain; "
            "nothing is stated"
        )
    if not GAIN_RANGE[0] <= gain <= GAIN_RANGE[1]:
        found.append(
            f"the touches are {gain:.2g} times as large as the learned ones of their cells, {GAIN_RANGE[0]:g} to "
            f"{GAIN_RANGE[1]:g} is allowed: another gain, other units, or another sensor; nothing is stated"
        )
    if unlike.mean() >= FOREIGN_SHARE:
        found.append(
            f"{100 * unlike.mean():.0f} % of the touches are of another kind than the learned ones: nothing is stated"
        )
    return found


def _gain(kernel: LearnedKernel, weighed: Floats, score: Floats) -> float:
    """Median of the factors by which touches (n, t, c) are larger than those of the cell of the best score (n, 64), by
    least squares along the axes of the first view; 1 where too few touches tell it.
    """
    if len(weighed) < LEAST_OF_GAIN:
        return 1.0
    view = kernel.views[0]
    rest = np.tensordot(view.centre * view.weight, view.axes, 2)
    own = view.mean[score.argmax(axis=1), view.mean.shape[1] // 2] + rest
    found = np.einsum("nd,nd->n", np.tensordot(weighed, view.axes, 2), own) / np.einsum("nd,nd->n", own, own)
    return float(np.median(found))


def _warnings(touches: Touches, kernel: LearnedKernel, weighed: Floats, still: int, unlike: int) -> list[str]:
    """Clipped and dead channels, and how many touches are unlike all that were learned."""
    found, count = [], len(touches.taxels)
    clipped = clipped_channels(touches.taxels)
    if clipped:
        told = ", ".join(f"{number} ({100 * share:.0f} %)" for number, share in clipped.items())
        found.append(f"channels with many values at their least or largest one, clipped perhaps: {told}")
    dead = [kernel.about["channels_heard"][number] for number in np.flatnonzero(np.ptp(weighed, axis=(0, 1)) == 0.0)]
    if dead and still < count:
        found.append(f"channels that never change, though the kernel needs them: {', '.join(map(str, dead))}")
    if still:
        found.append(
            f"{still} of {count} touches change less than the noise at rest of the learned ones, so '?' for them: no "
            "contact, a dead sensor, or other units"
        )
    if unlike > still:
        found.append(
            f"{unlike - still} of {count} touches are unlike all that were learned, so '?' for them: "
            "no Braille, another way over it, exchanged channels, or other units"
        )
    return found
