"""The main part: one explanation of most of the mismatch, where what is left has no name.

The choice between mechanisms is made again with a discrepancy as part of the likelihood (fit/signal_discrepancy.py).
Its size is learned, for each channel, from what the best explanation leaves. A bound of the search is no reason against
an explanation here, and held-out conditions decide: runs that repeat each other are one.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import norm

from diagnose.findings import Fit
from diagnose.fit.descent import settings
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, capped, fitted, within_priors
from diagnose.fit.signal_discrepancy import SignalDiscrepancy, by_phase, conditions, in_plain_units
from diagnose.fit.system import Quadratic, linearised, relative
from diagnose.inference.choice import Judged, implausible, score_of
from diagnose.inference.forecasts import Forecasted, forecasted, gained, separation
from diagnose.inference.search import FirstFit, Screening, first_fits, pairs, screen, singles
from diagnose.signals.phases import PHASES
from diagnose.statistics.abstain import RATES
from diagnose.statistics.held_out import Gain, held_out_probabilities, leave_press_out
from geometry.arrays import Floats
from geometry.base import Report

MOST = 0.9
"""Share of the held-out excess over noise that a main part accounts for."""
IN_EACH, MOST_LEFT, SIGMAS = 0.5, 0.5, 4.0
"""The same in a condition, channel or phase alone, where that holds this share of all that is left; its excess counts
from so many standard errors above noise."""
VISIBLE = 0.01
"""Root mean square error relative to the signal, above noise, below which flaws of an ordinary rig may make it."""
FLAWS = 0.02
"""The same that it may leave: more is not the flaws of a rig and the details of a law."""
NEARLY_ALL = 0.99
"""The share that it needs where it leaves more, or has a value at the end of what a real part can have."""
CONFIRMED = 0.8
"""The same share when the model is fitted anew to half of the presses, and shown on the others."""


@dataclass(frozen=True)
class MainPart:
    """models : best first, each with its gain over the baseline. group : numbers of those that are as good.

    model, found : in the metric in which they were judged. base : the baseline's forecast there. share : of the
    held-out excess over noise that the best accounts for; hidden : what noise may hide of it. left_size : root mean
    square of what it leaves, relative to the signal, of the worst channel. left_by_phase : phase -> share of that.
    """

    models: tuple[Judged, ...]
    group: tuple[int, ...]
    model: ObservedModel
    found: Screening
    base: Forecasted
    share: float
    hidden: float
    left_size: float
    left_by_phase: dict[str, float]

    @property
    def nameable(self) -> bool:
        """Whether few enough are as good, and the best leaves little and has no value at an edge, or is nearly all."""
        few = len(self.group) <= RATES.largest_group
        plain = self.left_size <= FLAWS and not implausible(self.models[0].fit)
        return few and (plain or self.share - self.hidden >= NEARLY_ALL)

    def probabilities(self, rng: np.random.Generator) -> Floats:
        """(m,) of the models, by their held-out scores, among them and the baseline."""
        scores = [*(one.forecast.log_scores for one in self.models), self.base.log_scores]
        return held_out_probabilities(np.array(scores), rng)[:-1]


def confirmed(held_out: Fit) -> bool:
    """Whether a model that was fitted to other presses takes most of the excess over noise away from these."""
    noise = held_out.noise_floor_nrmse**2
    before, after = held_out.nrmse_before**2 - noise, max(held_out.nrmse_after**2 - noise, 0.0)
    return after < (1.0 - CONFIRMED) * before


class TolerantJudge:
    """Judges explanations on held-out conditions, in a metric that tolerates discrepancies of sizes (c,)."""

    def __init__(self, model: ObservedModel, found: Screening, tolerance: SignalDiscrepancy, sizes: Floats) -> None:
        self.tolerance, self.fold = tolerance, conditions(model.samples)
        self.model = model.tolerating(tolerance.variance(np.maximum(sizes, relative(model))))
        rows = found.baseline.informative
        start, baseline = (linearised(self.model, one.values, (), 0.0, rows) for one in (found.start, found.baseline))
        self.found = replace(found, start=start, baseline=baseline, excess=0.0)
        self.base = forecasted(model.samples, within_priors(start, baseline), None, self.fold)
        self.before = self.left(self.base)

    def judged(self, fit: Fitted) -> Judged:
        """Held-out conditions predicted by a model that was fitted in this metric."""
        forecast = forecasted(self.model.samples, capped(fit.system), fit, self.fold)
        left = 1.0 - self.share(forecast)
        return Judged(fit, forecast, self.gained(forecast, self.base), left, np.nan, np.nan)  # no test of noise alone

    def gained(self, one: Forecasted, rival: Forecasted) -> Gain:
        """Nats per condition, with a lower bound that is corrected for all candidates."""
        return gained(one, rival, len(self.found.candidates))

    def excluded(self, rival: Forecasted, best: Forecasted) -> bool:
        """Whether the best would hardly predict so much better if the rival were true.

        With d sigma between the two, its gain would then be normal with mean -d^2 / 2 and deviation d.
        """
        apart = float(np.linalg.norm(separation(best, rival)))
        gain = float((best.log_scores - rival.log_scores).sum())
        return gain + 0.5 * apart**2 > float(norm.isf(RATES.level / len(self.found.candidates))) * apart

    def missed(self, forecast: Forecasted) -> Floats:
        """(n,) residual of the recording, less what the nuisances of each run that was left out make of it."""
        system, run = forecast.system, [one.run for one in self.model.nuisances]
        residual = self.model.samples.recorded - forecast.predicted
        own = np.flatnonzero([number is not None for number in run])
        for _, held in leave_press_out(forecast.fold[system.informative]):
            columns, rows = system.nuisance_design[held][:, own], np.flatnonzero(system.informative)[held]
            weight = system.weight[rows]
            found = Quadratic(columns * weight[:, None], system.sigma[own]).mean(residual[rows] * weight)
            residual[rows] -= columns @ found
        return residual

    def left(self, forecast: Forecasted) -> Floats:
        """(n,) squares above noise, relative to the signals, of what a forecast leaves."""
        return self.tolerance.squares(self.missed(forecast))

    def share(self, forecast: Forecasted) -> float:
        """Share of the baseline's held-out excess that a forecast accounts for."""
        before, after = (max(float(squares.sum()), 0.0) for squares in (self.before, self.left(forecast)))
        return 1.0 - after / before if before > 0.0 else 0.0

    def hidden(self) -> float:
        """Share of the baseline's held-out excess that noise may hide, two sigma."""
        before = float(self.before.sum())
        return 2.0 * self.tolerance.noise_error / before if before > 0.0 else 1.0

    def spread(self, forecast: Forecasted) -> bool:
        """Whether no condition, channel or phase holds most of what is left while most of its own excess stays there.

        That would be something else; laws that are not quite right and flaws of a rig leave a little everywhere.
        """
        after = self.left(forecast)
        for labels in (self.fold, self.tolerance.channel, self.model.samples.phase):
            _, place = np.unique(labels, return_inverse=True)
            was, still = (np.maximum(np.bincount(place, squares), 0.0) for squares in (self.before, after))
            seen = was > SIGMAS * self.tolerance.noise_errors(place)
            if np.any(seen & (still > (1.0 - IN_EACH) * was) & (still > MOST_LEFT * still.sum())):
                return False
        return True

    def largest(self, forecast: Forecasted) -> float:
        """Root mean square of what a forecast leaves, relative to the signal, of the worst channel."""
        return float(np.max(self.tolerance.sizes(self.missed(forecast)), initial=0.0))

    def refitted(self, fit: Fitted) -> Fitted:
        """A model fitted anew in this metric, from its values in another one."""
        start = replace(self.found.start, values=fit.system.values)
        return fitted(self.model, start, fit.candidates, fit.values, 0.0)

    def best_first(self, fits: Sequence[Fitted]) -> list[Judged]:
        """Models by how well they predict held-out conditions."""
        return sorted(map(self.judged, fits), key=score_of, reverse=True)


def main_part(model: ObservedModel, found: Screening, report: Report) -> MainPart | None:
    """None where no explanation, or none that is told from all but a few rivals, accounts for most of the mismatch."""
    plain = model.seen_as(in_plain_units(model.samples))
    seen = screen(plain, linearised(plain, found.baseline.values), report)
    tolerance = SignalDiscrepancy(plain.samples)
    judge = TolerantJudge(plain, seen, tolerance, tolerance.sizes(seen.start.residual))
    firsts = first_fits(judge.model, judge.found, report) if judge.largest(judge.base) > VISIBLE else []
    if not firsts:
        return None
    judge = TolerantJudge(plain, seen, tolerance, _left_by(judge, firsts[0]))
    models = judge.best_first(singles(judge.model, judge.found, firsts, report))
    if models and models[0].left > 1.0 - MOST:
        judge, models = _with_pairs(judge, models, report)
    return _told(judge, models) if models else None


def _left_by(judge: TolerantJudge, first: FirstFit) -> Floats:
    """Sizes (c,) of what a first fit leaves of all presses, nuisances as they come closest."""
    setting = settings((judge.found.candidates[first.number],), first.values)
    start = judge.found.start
    system = linearised(judge.model, start.values, setting, 0.0, start.informative)
    residual = system.residual.copy()
    residual[system.informative] -= system.nuisance_design @ system.quadratic.mean(system.weighted(system.residual))
    return judge.tolerance.sizes(residual)


def _with_pairs(judge: TolerantJudge, models: Sequence[Judged], report: Report) -> tuple[TolerantJudge, list[Judged]]:
    """A second mechanism beside the best, where both predict better for sure; all judged by what the best pair leaves.

    Beside the discrepancy that one mechanism leaves hardly any second one would show, so that the best are tried.
    """
    single = models[0]
    both = [judge.judged(fit) for fit in pairs(judge.model, judge.found, single.fit, [], report, level=1.0)]
    if not both:
        return judge, list(models)
    sizes = judge.tolerance.sizes(judge.missed(max(both, key=score_of).forecast))
    closer = TolerantJudge(judge.model, judge.found, judge.tolerance, sizes)
    again = [closer.judged(closer.refitted(one.fit)) for one in (*models, *both)]
    best = max(again[: len(models)], key=score_of)
    kept = [one for one in again[len(models) :] if closer.gained(one.forecast, best.forecast).lower > 0.0]
    return closer, sorted([*again[: len(models)], *kept], key=score_of, reverse=True)


def _told(judge: TolerantJudge, models: Sequence[Judged]) -> MainPart | None:
    best = models[0]
    group = [n for n, one in enumerate(models) if n == 0 or not judge.excluded(one.forecast, best.forecast)]
    if best.left > 1.0 - MOST or best.gain.lower <= 0.0 or not judge.spread(best.forecast):
        return None
    order = [*group, *(n for n in range(len(models)) if n not in group)]
    left = by_phase(judge.model.samples, judge.left(best.forecast), PHASES)
    return MainPart(
        tuple(models[n] for n in order),
        tuple(range(len(group))),
        judge.model,
        judge.found,
        judge.base,
        1.0 - best.left,
        judge.hidden(),
        judge.largest(best.forecast),
        left,
    )
