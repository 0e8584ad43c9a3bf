"""The last word: name a mechanism, or say why not. One pure function of the evidence and of stated error rates."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Rates:
    """level : chance per case of each kind of false alarm (wilson.rate_for_promise gives it from a promise).

    margin : nats per press by which the black box must win. largest_group : models that may stay indistinguishable.
    """

    level: float
    margin: float
    largest_group: int


@dataclass(frozen=True)
class Evidence:
    """p_mismatch, p_left : family-wise p-values of the whitened residual before and after the best named model.

    p_strained : of the parameter that lies farthest from its prior beside that model. gain_lower : lower bound of its
    held-out gain, corrected for all candidates. black_box_lower : the same of the black box over the named model; both
    in nats per press, at the level of Rates. implausible : parameters on a bound that no real part has. group : models
    that cannot be told from the named one, itself included.
    """

    p_mismatch: float
    p_left: float
    p_strained: float
    gain_lower: float
    black_box_lower: float
    implausible: tuple[str, ...]
    group: int


@dataclass(frozen=True)
class Decision:
    """named : the best model is named. unexplained : a mismatch that no known mechanism explains."""

    mismatch: bool
    named: bool
    unexplained: bool
    reasons: tuple[str, ...]


def decide(evidence: Evidence, rates: Rates) -> Decision:
    """Name only a model with no reason against it; reasons are whole sentences."""
    if evidence.p_mismatch > rates.level:
        reason = f"The residual is as large as noise makes it (p = {evidence.p_mismatch:.3g})."
        return Decision(False, False, False, (reason,))
    reasons = tuple(_against(evidence, rates))
    return Decision(True, not reasons, bool(reasons), reasons)


def _against(evidence: Evidence, rates: Rates) -> list[str]:
    found = []
    if evidence.gain_lower <= 0.0:
        found.append(f"It may predict held-out presses no better (gain at least {evidence.gain_lower:.3g} nats).")
    if evidence.p_left <= rates.level:
        found.append(f"Its residual is still larger than noise makes it (p = {evidence.p_left:.3g}).")
    if evidence.p_strained <= rates.level:
        far = f"(p = {evidence.p_strained:.3g})"
        found.append(f"Beside it, gains, moduli or the error of its law still lie farther off than stated {far}.")
    if evidence.implausible:
        found.append(f"Parameters sit on implausible bounds: {', '.join(evidence.implausible)}.")
    if evidence.black_box_lower > rates.margin:
        found.append(f"A black box predicts held-out presses better, by at least {evidence.black_box_lower:.3g} nats.")
    if evidence.group > rates.largest_group:
        found.append(f"{evidence.group} models cannot be told apart; at most {rates.largest_group} may be.")
    return found
