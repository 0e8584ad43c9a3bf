"""Explanations judged as a reader does who knows that no law is exact: on held-out conditions, by their errors.

Their discrepancy is part of the likelihood (fit/signal_discrepancy.py), and runs that repeat each other are one
condition.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import norm

from diagnose.fit.baseline import cap_nuisances, hold_strained_nuisances
from diagnose.fit.linearised_system import engine_errors, linearise
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, fit_mechanisms
from diagnose.fit.samples import Samples
from diagnose.fit.signal_discrepancy import SignalDiscrepancy, condition_labels, with_white_noise
from diagnose.forward import Candidate, Setting
from diagnose.inference.choice import Judged, score_of
from diagnose.inference.forecasts import Forecasted, forecasted, gained, separation
from diagnose.inference.screening import Screening
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.held_out import Gain, leave_press_out
from foundation.arrays import Floats, Ints

IN_EACH, MOST_LEFT, SIGMAS = 0.5, 0.5, 4.0
"""Share of an excess that most of it is: in a condition, channel or phase alone, where that holds this share of all
that is left; its excess counts from so many standard errors above noise."""
LITTLE_LEFT = 0.1  # of all that is left: what holds less of it may be predicted worse


class TolerantJudge:
    """Judges explanations on what a fold (n,) holds out, in a metric that tolerates discrepancies of sizes (c,)."""

    def __init__(
        self, model: ObservedModel, found: Screening, tolerance: SignalDiscrepancy, sizes: Floats, fold: Ints
    ) -> None:
        self.tolerance, self.fold = tolerance, fold
        self.model = model.with_tolerance(tolerance.variance(np.maximum(sizes, engine_errors(model))))
        rows = found.baseline.informative
        start, baseline = (linearise(self.model, one.values, (), 0.0, rows) for one in (found.start, found.baseline))
        self.found = replace(found, start=start, baseline=baseline, excess=0.0)
        self.base = forecasted(model.samples, hold_strained_nuisances(start, baseline), None, self.fold)
        self.before = self.left(self.base)

    def tolerating(self, sizes: Floats) -> "TolerantJudge":
        """The same judge beside discrepancies of other sizes (c,)."""
        return TolerantJudge(self.model, self.found, self.tolerance, sizes, self.fold)

    def judged(self, fit: Fitted) -> Judged:
        """Held-out conditions predicted by a model that was fitted in this metric."""
        forecast = forecasted(self.model.samples, cap_nuisances(fit.system), fit, self.fold)
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
        residual = self.model.samples.recorded_vector - forecast.predicted
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

        That would be something else; laws that are not quite right and flaws of a rig leave a little everywhere. Nor is
        any that holds a good part of it predicted worse for sure than without: there its effect is not what happens.
        """
        after = self.left(forecast)
        for labels in (self.fold, self.tolerance.channel, self.model.samples.phase):
            _, place = np.unique(labels, return_inverse=True)
            was, still = (np.maximum(np.bincount(place, squares), 0.0) for squares in (self.before, after))
            sure = SIGMAS * self.tolerance.noise_errors(place)
            alone = (was > sure) & (still > (1.0 - IN_EACH) * was) & (still > MOST_LEFT * still.sum())
            worse = (still > was + sure) & (still > LITTLE_LEFT * still.sum())
            if np.any(alone | worse):
                return False
        return True

    def largest(self, forecast: Forecasted) -> float:
        """Root mean square of what a forecast leaves, relative to the signal, of the worst channel."""
        return float(np.max(self.tolerance.sizes(self.missed(forecast)), initial=0.0))

    def refitted(self, fit: Fitted) -> Fitted:
        """A model fitted anew in this metric, from its values in another one."""
        start = replace(self.found.start, values=fit.system.values)
        return fit_mechanisms(self.model, start, fit.candidates, fit.values, 0.0)

    def best_first(self, fits: Sequence[Fitted]) -> list[Judged]:
        """Models by how well they predict held-out conditions."""
        return sorted(map(self.judged, fits), key=score_of, reverse=True)


def held_together(samples: Samples, candidates: Sequence[Candidate]) -> Ints:
    """Label (n,) of what is held out together: a condition, or a press where a candidate has values in each run.

    The phase of hum in a run that was left out follows from no other run.
    """
    return samples.fold if any(one.traits.free_phase for one in candidates) else condition_labels(samples)


def left_by(judge: TolerantJudge, on: Sequence[Setting]) -> Floats:
    """Sizes (c,) of what settings leave of all presses, nuisances as they come closest."""
    return judge.tolerance.sizes(residual_beside(judge, on))


def residual_beside(judge: TolerantJudge, on: Sequence[Setting]) -> Floats:
    """(n,) residual of all presses with settings, nuisances as they come closest."""
    start = judge.found.start
    system = linearise(judge.model, start.values, on, 0.0, start.informative)
    residual = system.residual.copy()
    residual[system.informative] -= system.nuisance_design @ system.quadratic.mean(
        system.weighted_rows(system.residual)
    )
    return residual


def judge_of_name(model: ObservedModel, found: Screening, name: Sequence[Setting]) -> TolerantJudge:
    """Its discrepancy is what the named mechanisms leave."""
    plain = model.with_samples(with_white_noise(model.samples))
    tolerance = SignalDiscrepancy(plain.samples)
    fold = held_together(plain.samples, [one.candidate for one in name])
    judge = TolerantJudge(plain, found, tolerance, np.zeros(len(plain.samples.channels)), fold)
    return TolerantJudge(plain, found, tolerance, left_by(judge, name), fold)
