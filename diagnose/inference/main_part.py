"""The main part: one explanation of most of the mismatch, where what is left has no name.

The choice between mechanisms is made again with a discrepancy as part of the likelihood (fit/signal_discrepancy.py).
Its size is learned, for each channel, from what the best explanation leaves. A bound of the search is no reason against
an explanation here, and held-out conditions decide: runs that repeat each other are one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np

from diagnose.findings import Fit
from diagnose.fit.descent import settings
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.linearised_system import linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.signal_discrepancy import (
    VISIBLE_ERROR,
    SignalDiscrepancy,
    condition_labels,
    phase_shares,
    with_white_noise,
)
from diagnose.inference.choice import Judged, implausible, ordinary, score_of
from diagnose.inference.forecasts import Forecasted
from diagnose.inference.screening import Screening, screen
from diagnose.inference.search import first_fits, pairs, singles
from diagnose.inference.tolerant_judge import TolerantJudge, held_together, left_by
from diagnose.signals.phases import PHASES
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.model_criteria import held_out_probabilities
from foundation.arrays import Floats
from foundation.progress import Report

MOST = 0.9
"""Share of the held-out excess over noise that a main part accounts for."""
FLAWS = 0.02
"""Of the signal, the most that may be left by flaws of a rig and the details of a law."""
NEARLY_ALL = 0.99
"""The share that it needs where it leaves more, or has a value at the end of what a real part can have."""
CONFIRMED = 0.8
"""The same share when the model is fitted anew to half of the presses, and shown on the others."""


@dataclass(frozen=True)
class MainPart:
    """models : best first, each with its gain over the baseline. group : numbers of those that are as good.

    model, found : in the metric in which they were judged. base : the baseline's forecast there. share : of the
    held-out excess over noise that the best accounts for; hidden : what noise may hide of it. left_size, effect_size :
    root mean square of what it and the baseline leave, relative to the signal, of the worst channel. left_by_phase :
    phase -> share of what it leaves. most : whether it accounts for most of the mismatch, in all places; otherwise it
    is what comes closest.
    """

    models: tuple[Judged, ...]
    group: tuple[int, ...]
    model: ObservedModel
    found: Screening
    base: Forecasted
    share: float
    hidden: float
    left_size: float
    effect_size: float
    left_by_phase: dict[str, float]
    most: bool

    @property
    def nameable(self) -> bool:
        """Whether few enough are as good, and the best leaves little and has no value at an edge, or is nearly all.

        What it may leave are flaws of a rig, and of a law some percent of its effect; a wrong number has no law.
        """
        few = len(self.group) <= RATES.largest_group
        best = self.models[0].fit
        stated = all(candidate.traits.wrong_number for candidate in best.candidates)
        law = 0.0 if stated else FORM_ERROR
        plain = self.left_size <= min(FLAWS, hypot(VISIBLE_ERROR, law * self.effect_size)) and not implausible(best)
        return few and not ordinary(best) and (plain or self.share - self.hidden >= NEARLY_ALL)

    def probabilities(self, rng: np.random.Generator) -> Floats:
        """(m,) of the models, by their held-out scores, among them and the baseline."""
        scores = [*(one.forecast.log_scores for one in self.models), self.base.log_scores]
        return held_out_probabilities(np.array(scores), rng)[:-1]


def confirmed(held_out: Fit) -> bool:
    """Whether a model that was fitted to other presses takes most of the excess over noise away from these."""
    return held_out.share > CONFIRMED


def main_part(model: ObservedModel, found: Screening, report: Report) -> MainPart | None:
    """None where no explanation shows, or none predicts better than the baseline."""
    plain = model.with_samples(with_white_noise(model.samples))
    seen = screen(plain, linearise(plain, found.baseline.values), report)
    tolerance = SignalDiscrepancy(plain.samples)
    judge = TolerantJudge(plain, seen, tolerance, tolerance.sizes(seen.start.residual), condition_labels(plain.samples))
    firsts = first_fits(judge.model, judge.found, report) if judge.largest(judge.base) > VISIBLE_ERROR else []
    if not firsts:
        return None
    first = seen.candidates[firsts[0].number]
    judge = TolerantJudge(
        plain,
        seen,
        tolerance,
        left_by(judge, settings((first,), firsts[0].values)),
        held_together(plain.samples, [first]),
    )
    models = judge.best_first(singles(judge.model, judge.found, firsts, report))
    if models and models[0].left > 1.0 - MOST:
        judge, models = _with_pairs(judge, models, report)
    return _told(judge, models) if models and models[0].gain.lower > 0.0 else None


def _with_pairs(judge: TolerantJudge, models: Sequence[Judged], report: Report) -> tuple[TolerantJudge, list[Judged]]:
    """A second mechanism beside the best, where both predict better for sure; all judged by what the best pair leaves.

    Beside the discrepancy that one mechanism leaves hardly any second one would show, so that the best are tried.
    """
    single = models[0]
    both = [judge.judged(fit) for fit in pairs(judge.model, judge.found, single.fit, [], report, level=1.0)]
    if not both:
        return judge, list(models)
    sizes = judge.tolerance.sizes(judge.missed(max(both, key=score_of).forecast))
    closer = judge.tolerating(sizes)
    again = [closer.judged(closer.refitted(one.fit)) for one in (*models, *both)]
    best = max(again[: len(models)], key=score_of)
    kept = [one for one in again[len(models) :] if closer.gained(one.forecast, best.forecast).lower > 0.0]
    return closer, sorted([*again[: len(models)], *kept], key=score_of, reverse=True)


def _told(judge: TolerantJudge, models: Sequence[Judged]) -> MainPart:
    best = models[0]
    group = [n for n, one in enumerate(models) if n == 0 or not judge.excluded(one.forecast, best.forecast)]
    flaws = judge.largest(best.forecast) <= VISIBLE_ERROR
    order = [*group, *(n for n in range(len(models)) if n not in group)]
    left = phase_shares(judge.model.samples, judge.left(best.forecast), PHASES)
    return MainPart(
        tuple(models[n] for n in order),
        tuple(range(len(group))),
        judge.model,
        judge.found,
        judge.base,
        1.0 - best.left,
        judge.hidden(),
        judge.largest(best.forecast),
        judge.largest(judge.base),
        left,
        best.left <= 1.0 - (CONFIRMED if flaws else MOST) and judge.spread(best.forecast),
    )


def flaws_alone(held_out: Fit) -> bool:
    """Whether what is left of held-out presses above noise is no more than an ordinary rig and the details of a law."""
    return held_out.excess_after <= FLAWS**2
