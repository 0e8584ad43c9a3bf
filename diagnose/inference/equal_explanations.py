"""Which explanations are as good as a name, once a discrepancy as large as what the name itself leaves is allowed."""

from collections.abc import Sequence
from dataclasses import replace

from diagnose.figures import percent
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.signal_discrepancy import VISIBLE_ERROR
from diagnose.inference.choice import Choice, Judged
from diagnose.inference.screening import Screening
from diagnose.inference.tolerant_judge import TolerantJudge, judge_of_name
from diagnose.statistics.abstain import too_many_reason
from diagnose.statistics.error_rates import RATES


def distinguished(model: ObservedModel, found: Screening, choice: Choice) -> Choice:
    """A choice whose name has all that is as good in its group; there is no name where these are too many.

    Nor is there one of a pair where one of the two alone leaves no more than flaws of an ordinary rig.
    """
    if not choice.decision.named:
        return choice
    judge = judge_of_name(model, found, choice.models[0].fit.settings)
    again = [judge.judged(judge.refitted(one.fit)) for one in choice.models]
    good = {n for n, one in enumerate(again) if not judge.excluded(one.forecast, again[0].forecast)}
    group = tuple(sorted({*choice.groups[0], 0, *good}))
    ambiguous = len(group) > RATES.largest_group
    against = [too_many_reason(len(group), RATES)] if ambiguous else _needless(judge, again)
    rest = (tuple(n for n in other if n not in group) for other in choice.groups[1:])
    decision = choice.decision
    if against:
        reasons = (*decision.reasons, *against)
        decision = replace(decision, named=False, unexplained=True, reasons=reasons, ambiguous=ambiguous)
    return replace(choice, groups=(group, *filter(None, rest)), decision=decision)


def _needless(judge: TolerantJudge, models: Sequence[Judged]) -> list[str]:
    """The reason against a pair, which is the first of the models, where one of the two is enough."""
    pair = models[0].fit.candidates
    for one in models[1:]:
        (first, *more), left = one.fit.candidates, judge.largest(one.forecast)
        second = [other for other in pair if other != first]
        if not more and len(second) < len(pair) and second and left <= VISIBLE_ERROR:
            return [
                f"{first.mechanism} ({first.component}) alone leaves {percent(left)} of the signal, which may be flaws "
                f"of an ordinary rig: {second[0].mechanism} ({second[0].component}) is not named for that."
            ]
    return []
