"""Up to three mechanisms, found one at a time: what else shows in what those that are named leave.

Beside a discrepancy as large as what the named ones leave hardly anything more would show, so that the next one is
sought beside one as large as the best explanation with it leaves. Only true refits judge it: some conditions are left
out in turn, and the errors there are counted as a reader does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, fit_mechanisms
from diagnose.fit.samples import Samples
from diagnose.forward import Setting
from diagnose.inference.main_part import FLAWS
from diagnose.inference.screening import Screening
from diagnose.inference.search import pairs
from diagnose.inference.tolerant_judge import TolerantJudge, judge_of_name, left_by
from diagnose.inference.true_refit import trained_and_held
from foundation.arrays import Floats
from foundation.progress import Report

MOST_MECHANISMS = 3
HALF = 0.5
"""The next mechanism leaves at most this share of the excess, and of what any other one in its place leaves."""
SHOWN = 0.25  # share of the squares: what explains less of them to first order is not worth a fit
FOLDS = 5  # groups of conditions that are left out in turn
SAME = 0.05  # relative: presses that go as far as each other


@dataclass(frozen=True)
class Joined:
    """A fit of several mechanisms, in the metric of a judge."""

    judge: TolerantJudge
    fit: Fitted


def joined(model: ObservedModel, found: Screening, named: Sequence[Setting], report: Report) -> Joined:
    """The named mechanisms with all that shows beside them, fitted anew beside what they leave."""
    judge = judge_of_name(model, found, named)
    values = np.concatenate([one.values for one in named])
    fit = fit_mechanisms(judge.model, judge.found.start, tuple(one.candidate for one in named), values, 0.0)
    now = Joined(judge, fit)
    while len(now.fit.candidates) < MOST_MECHANISMS and (more := _with_one_more(now, report)) is not None:
        now = more
    return now


def _with_one_more(now: Joined, report: Report) -> Joined | None:
    """None where no other mechanism, or more than one, takes most of what is left away.

    What leaves too much even of the presses that it was fitted to needs no refit.
    """
    tried = pairs(now.judge.model, now.judge.found, now.fit, [], report, level=1.0, least=SHOWN)
    sizes = [left_by(now.judge, fit.settings) for fit in (now.fit, *tried)]
    alone, *left = [float((each**2).sum()) for each in sizes]
    order = sorted(range(len(tried)), key=left.__getitem__)
    if not tried or left[order[0]] > HALF * alone:
        return None
    judge = now.judge.tolerating(sizes[1 + order[0]])
    best, *others = [judge.refitted(tried[n]) for n in order if HALF * left[n] <= left[order[0]]]
    before, after = excess_left(judge, judge.refitted(now.fit)), excess_left(judge, best)
    if before.sum() <= len(before) * FLAWS**2 or np.any(after > before) or after.sum() > HALF * before.sum():
        return None
    rivalled = any(after.sum() > HALF * excess_left(judge, other).sum() for other in others)
    return None if rivalled else Joined(judge, best)


def excess_left(judge: TolerantJudge, fit: Fitted) -> Floats:
    """(f,) squares of the error above noise, relative to the recording, of each group of conditions that is left out.

    Mechanisms and what all runs share come from the others. Presses that go farther than all of these are not looked
    at: what a law says beyond the strains that it was fitted to is no sign of what is there.
    """
    samples, left = judge.model.samples, []
    numbers = range(len(samples.presses))
    presses, reached = np.array(numbers), np.array([reach(samples, n) for n in numbers])
    drive = np.array([samples.recording.runs[run].drive for run, _ in samples.presses])
    condition = np.unique([judge.fold[samples.press == n][0] for n in numbers], return_inverse=True)[1]
    for group in range(min(FOLDS, int(condition.max()) + 1)):
        out = condition % FOLDS == group
        farthest = np.array([reached[~out & (drive == one)].max(initial=0.0) for one in drive])
        within = out & (reached <= (1.0 + SAME) * farthest)
        if within.any():
            halves = (presses[~out].tolist(), presses[within].tolist())
            shown = trained_and_held(judge.model, judge.found, fit, np.zeros(0), halves)[1]
            assert shown is not None
            left.append(shown.excess_after)
    return np.array(left)


def reach(samples: Samples, number: int) -> float:
    """How far a press goes, in units of its drive."""
    run, press = samples.presses[number]
    driven = samples.recording.runs[run].drive_values
    return float(np.abs(driven[samples.recording.phases[run].press == press]).max())
