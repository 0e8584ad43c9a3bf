"""From the baseline to a short list of fitted models: screening, single mechanisms, pairs where one is not enough."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.forward import Candidate, Report
from diagnose.inference.baseline import believed
from diagnose.inference.descent import LEAST_GAIN, descent, lowest
from diagnose.inference.excess import excess
from diagnose.inference.live import live_rows
from diagnose.inference.observed_model import ObservedModel
from diagnose.inference.rates import FINALISTS, PAIRS, RATES
from diagnose.inference.refit import Fitted, common_metric, fitted
from diagnose.inference.samples import noise_degrees
from diagnose.inference.screening import Screened, screened
from diagnose.inference.sensitivities import Sensitivity, sensitivity
from diagnose.inference.system import System
from mesh.types import Floats

STARTS = 3  # of each candidate's first fit
ROUGH = 1e-3  # of the excess: what a last step of a first fit may gain, which only has to tell who is worth a second


@dataclass(frozen=True)
class Screening:
    """baseline : fitted, with its live rows. start : about what the priors find plausible. each, tests : candidates.

    excess : of the baseline.
    """

    candidates: tuple[Candidate, ...]
    baseline: System
    start: System
    each: tuple[Sensitivity, ...]
    tests: Screened
    excess: float

    @property
    def survivors(self) -> list[int]:
        """Numbers of the candidates that show, those that explain most first."""
        order = np.argsort(-self.tests.explained, kind="stable")
        return [int(n) for n in order if self.tests.p_values[n] <= RATES.level]


def screen(model: ObservedModel, baseline: System, report: Report) -> Screening:
    """Every candidate of the engine."""
    candidates = model.engine.candidates
    start = believed(model, baseline)
    each = []
    for number, candidate in enumerate(candidates):
        report("screening", number, len(candidates))
        each.append(sensitivity(model, start.values, candidate))
    live = live_rows(model.samples, baseline, [*(s.columns for s in each), *(s.finite for s in each)])
    baseline, start = baseline.reached(live), start.reached(live)
    tests = screened(start, each, least_degrees(model))
    return Screening(candidates, baseline, start, tuple(each), tests, excess(baseline))


def least_degrees(model: ObservedModel) -> float:
    """Degrees of freedom of the noise that is known worst."""
    return min(noise_degrees(law) for law in model.samples.noise.values())


def singles(model: ObservedModel, found: Screening, report: Report) -> list[Fitted]:
    """Survivors fitted in one metric, and the best of them with all that floats."""
    common = common_metric(model.samples, found.start)
    rough = max(LEAST_GAIN, ROUGH * found.excess)
    firsts: list[tuple[float, int, Floats]] = []
    for count, number in enumerate(found.survivors):
        report("first fits", count, len(found.survivors))
        only = (found.candidates[number],)
        best = lowest(descent(model, common, only, ()), found.tests.estimates[number][:STARTS], rough)
        if best is not None:
            firsts.append((best.cost, number, best.values))
    firsts = sorted(firsts, key=lambda one: one[0])[:FINALISTS]
    fits = []
    for count, (_, number, values) in enumerate(firsts):
        report("fits", count, len(firsts))
        fits.append(fitted(model, found.start, (found.candidates[number],), values, found.excess))
    return [fit for fit in fits if _acts(fit)]


def pairs(
    model: ObservedModel, found: Screening, first: Fitted, same: Sequence[Candidate], report: Report
) -> list[Fitted]:
    """The first mechanism with each second one that shows in what it leaves; same : those that act as the first."""
    names = [one.name for one in (*first.candidates, *same)]
    others = [c for c in found.candidates if c.name not in names]
    each = [sensitivity(model, first.system.values, other, first.settings) for other in others]
    beside = replace(
        first.system,
        excused=np.column_stack([first.slopes[first.system.live], first.system.excused]),
        sigma_of_one=np.concatenate([np.full(first.slopes.shape[1], np.inf), first.system.sigma_of_one]),
    )
    tests = screened(beside, each, least_degrees(model))
    shown = [int(n) for n in np.argsort(-tests.explained) if tests.p_values[n] <= RATES.level][:PAIRS]
    fits = []
    for count, number in enumerate(shown):
        report("pairs", count, len(shown))
        fits += paired(model, found, first, others[number], tests.estimates[number][:STARTS])
    return fits


def paired(
    model: ObservedModel, found: Screening, first: Fitted, second: Candidate, starts: Sequence[Floats]
) -> list[Fitted]:
    """Both together from starts (q,) of the second; none where the model has no answer."""
    both = (*first.candidates, second)
    problem = descent(model, first.system, both, first.settings)
    best = lowest(problem, [np.concatenate([first.values, start]) for start in starts])
    if best is None:
        return []
    fit = fitted(model, first.system, both, best.values, found.excess)
    return [fit] if _acts(fit) else []


def _acts(fit: Fitted) -> bool:
    """Whether all its mechanisms are on: with one that is off it is a model of fewer."""
    return all(any(setting.values) for setting in fit.settings)
