"""The decision to name a mechanism or to say why not: one pure function of the evidence and of stated error rates."""

from dataclasses import dataclass

from diagnose.figures import figure, p_equals
from diagnose.statistics.error_rates import Rates


@dataclass(frozen=True)
class Evidence:
    """Evidence for or against a name. p_mismatch, p_left : family-wise p-values of the residual without and with it.

    p_strained : p-value of the parameter that lies farthest from its prior beside the best named model. gain_lower :
    lower bound of its held-out gain, corrected for all candidates. black_box_lower : the same of the black box over the
    named model; both in nats per press, at the level of Rates. implausible : parameters on a bound that no real part
    has. group : number of models that cannot be told from the named one, itself included. ordinary : whether a careful
    laboratory's rig has as much of it.
    """

    p_mismatch: float
    p_left: float
    p_strained: float
    gain_lower: float
    black_box_lower: float
    implausible: tuple[str, ...]
    group: int
    ordinary: bool = False


@dataclass(frozen=True)
class Decision:
    """Decision on a mismatch. named : the best model is named. unexplained : no known mechanism explains the mismatch.

    reasons : sentences against a name. ambiguous : nothing speaks against a name but the number of models that share
    it.
    """

    mismatch: bool
    named: bool
    unexplained: bool
    reasons: tuple[str, ...]
    ambiguous: bool = False


def decide(evidence: Evidence, rates: Rates) -> Decision:
    """Decide whether the best model is named: only if no reason, a whole sentence each, speaks against it."""
    if evidence.p_mismatch > rates.level:
        reason = f"The residual is no larger than noise makes it ({p_equals(evidence.p_mismatch)})."
        return Decision(False, False, False, (reason,))
    reasons = tuple(_reasons_against(evidence, rates))
    ambiguous = len(reasons) == 1 and evidence.group > rates.largest_group
    return Decision(True, not reasons, bool(reasons), reasons, ambiguous)


def _reasons_against(evidence: Evidence, rates: Rates) -> list[str]:
    """Sentences against naming the best model, from all evidence but the mismatch itself."""
    found = []
    if evidence.gain_lower <= 0.0:
        found.append(
            f"It may predict held-out presses no better than your simulation does (its gain is at least "
            f"{figure(evidence.gain_lower)} nats per press)."
        )
    if evidence.p_left <= rates.level:
        found.append(f"Its residual is still larger than noise makes it ({p_equals(evidence.p_left)}).")
    if evidence.p_strained <= rates.level:
        found.append(
            "Even with it, a gain, a modulus or the assumed law has to differ by more than its stated uncertainty "
            f"({p_equals(evidence.p_strained)})."
        )
    if evidence.implausible:
        values = ", ".join(evidence.implausible)
        found.append(f"It needs a value at the limit of what a real part can have, which is implausible: {values}.")
    if evidence.ordinary:
        found.append("It is no more than what every rig has a little of, and so it is no finding.")
    if evidence.black_box_lower > rates.margin:
        found.append(
            "A flexible model without mechanics, the black box, predicts held-out presses better by at least "
            f"{figure(evidence.black_box_lower)} nats per press."
        )
    if evidence.group > rates.largest_group:
        found.append(too_many_reason(evidence.group, rates))
    return found


def too_many_reason(group: int, rates: Rates) -> str:
    """Sentence against a name where a group of this many models cannot be told apart."""
    return (
        f"{group} explanations cannot be told apart; at most {rates.largest_group} may remain for a name to be given."
    )
