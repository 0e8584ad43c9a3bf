"""What may be said of a mismatch: an ordered list of rules, each of which looks at the evidence and speaks or passes.
The first one that speaks decides. All thresholds are in the table THRESHOLDS, with what they mean.
"""

from collections.abc import Callable
from dataclasses import dataclass

from diagnose.figures import figure, p_equals, part_percent, percent
from diagnose.fit.rig_discrepancy import VISIBLE_ERROR
from diagnose.statistics.error_rates import RATES


@dataclass(frozen=True)
class Thresholds:
    """All thresholds, in one place.

    level : chance per recording of a mismatch where there is none.
    nothing : probability of nothing from which on it is not excluded, where what the best takes away is not visible.
    rival : probability of an explanation, against the best one, from which on it is not excluded.
    sure : probability from which on something else is certain.
    most, nearly_all : shares of the held-out excess for a main part, and for an identified explanation.
    confirmed : the same share where all is fitted anew to half of the presses and shown on the others.
    visible : error over the signal that flaws of an ordinary rig make.
    closer : share of the squares of an error that must be gone for another explanation to be closer.
    left : error over the signal that an identified explanation may leave at most.
    largest_group : number of explanations that may stay together for a name to be given.
    """

    level: float = RATES.level
    nothing: float = 0.05
    rival: float = 0.01
    sure: float = 0.95
    most: float = 0.9
    nearly_all: float = 0.95
    confirmed: float = 0.8
    visible: float = VISIBLE_ERROR
    closer: float = 0.5
    left: float = 0.1
    largest_group: int = RATES.largest_group


THRESHOLDS = Thresholds()


def takes_away(before: float, after: float) -> bool:
    """Whether errors over the signal show an explanation in practice: half of the squares are gone, and no less than
    what is visible, since less may be a flaw of the rig.
    """
    return before**2 - after**2 >= max(THRESHOLDS.closer * before**2, THRESHOLDS.visible**2)


def accounts_for_all(error: float, share: float) -> bool:
    """Whether an explanation leaves no more than flaws of a rig, or little of what was there. error : over the signal;
    share : of the excess that it takes away.
    """
    small = error <= THRESHOLDS.visible and share >= THRESHOLDS.confirmed
    return small or (share >= THRESHOLDS.nearly_all and error <= THRESHOLDS.left)


@dataclass(frozen=True)
class Evidence:
    """Evidence on a recording. p_mismatch : family-wise p-value of the residual of the baseline. best : its name, ""
    where no mechanism shows. nothing, something_else : their probabilities. share : of the held-out excess over noise
    that the best accounts for, as far as noise lets it be known; error, error_before : root mean square of what it and
    the baseline leave of what was held out, relative to the signal, in the worst channel. share_of_else : as share, of
    something else. group : number of explanations that cannot be told apart. shared, shared_probability : mechanism
    that most explanations hold, and its probability. kind : what all of the group have in common, "" for nothing.
    confirmed : share of the excess that a fit to half of the presses takes away from the others, None where none could
    be held out. ordinary : whether every rig has as much of it. implausible : values at the end of what parts can
    have. several : whether the best is more than one mechanism.
    """

    p_mismatch: float
    best: str = ""
    nothing: float = 1.0
    something_else: float = 0.0
    share: float = 0.0
    share_of_else: float = 0.0
    error: float = 0.0
    error_before: float = 0.0
    group: int = 0
    kind: str = ""
    confirmed: float | None = None
    ordinary: bool = False
    implausible: tuple[str, ...] = ()
    several: bool = False
    untold_memory: bool = False

    @property
    def beaten(self) -> bool:
        """Whether something without mechanics predicts better for sure, and in practice."""
        better = 1.0 - self.share_of_else < 0.5 * (1.0 - self.share)
        return self.something_else > THRESHOLDS.sure and better and self.error > THRESHOLDS.visible

    @property
    def is_visible(self) -> bool:
        """Whether what the best takes away from conditions that were left out counts in practice."""
        return takes_away(self.error_before, self.error)

    @property
    def holds(self) -> bool:
        """Whether a fit to half of the presses shows the same on the others."""
        return self.confirmed is None or self.confirmed > THRESHOLDS.confirmed


@dataclass(frozen=True)
class Agreement:
    """The recording is what the simulation says."""

    reasons: tuple[str, ...]


@dataclass(frozen=True)
class Identified:
    """The best explanation, or one of a few, accounts for the mismatch."""

    reasons: tuple[str, ...]


@dataclass(frozen=True)
class MainPart:
    """The best explanation, or one of a few, accounts for most of the mismatch."""

    reasons: tuple[str, ...]


@dataclass(frozen=True)
class KindOnly:
    """Only what several explanations have in common is certain."""

    reasons: tuple[str, ...]
    kind: str


@dataclass(frozen=True)
class Unexplained:
    """There is a mismatch, and nothing that is known explains it."""

    reasons: tuple[str, ...]


Verdict = Agreement | Identified | MainPart | KindOnly | Unexplained


def agreement(e: Evidence) -> Verdict | None:
    """No mismatch beyond noise and the errors of the model."""
    if e.p_mismatch <= THRESHOLDS.level:
        return None
    return Agreement(
        (f"The residual is no larger than noise and the errors of the model make it ({p_equals(e.p_mismatch)}).",)
    )


def no_explanation(e: Evidence) -> Verdict | None:
    """No mechanism shows and predicts anything."""
    said = "No candidate both shows in the residual and predicts what was held out better than your simulation does."
    return None if e.best else Unexplained((said,))


def nothing_predicts(e: Evidence) -> Verdict | None:
    """The simulation alone predicts as well as the best explanation: it may be likelier in details, and leaves no more
    in practice.
    """
    if e.nothing <= THRESHOLDS.nothing or e.is_visible:
        return None
    return Unexplained((f"{e.best} may predict what was held out no better than your simulation does.",))


def every_rig_has_it(e: Evidence) -> Verdict | None:
    """So little of it is no finding."""
    if not e.ordinary:
        return None
    return Unexplained((f"{e.best} is no more than what every rig has a little of, and so it is no finding.",))


def one_loading_shows_no_memory(e: Evidence) -> Verdict | None:
    """What depends on time or path cannot be told from what does not in one loading, and nothing was left out."""
    if not e.untold_memory:
        return None
    return Unexplained(
        (
            f"The recording is a single loading, in which nothing could be left out. {e.best} comes closest to it, and "
            "depends on time or path: another speed, a hold or a return has to show that.",
        )
    )


def identified(e: Evidence) -> Verdict | None:
    """Few explanations are left, which account for all but flaws of a rig, and nothing flexible does better."""
    whole, few = accounts_for_all(e.error, e.share), e.group <= THRESHOLDS.largest_group
    return Identified(_praise(e)) if whole and few and e.holds and not e.beaten and not e.implausible else None


def main_part(e: Evidence) -> Verdict | None:
    """Few explanations are left, which account for most; several mechanisms together only where nothing flexible does
    better, and with values that parts can have.
    """
    few = e.group <= THRESHOLDS.largest_group and not (e.several and (e.implausible or e.beaten))
    return MainPart((*_praise(e), *_against(e))) if e.share >= THRESHOLDS.most and few and e.holds else None


def kind_only(e: Evidence) -> Verdict | None:
    """Several explanations account for most, and all are of one kind."""
    most = e.share >= THRESHOLDS.most and e.holds
    return KindOnly((*_praise(e), *_against(e)), e.kind) if most and e.kind else None


def unexplained(e: Evidence) -> Verdict | None:
    """Nothing accounts for most of it."""
    return Unexplained((*_praise(e), *_against(e)))


RULES: tuple[Callable[[Evidence], Verdict | None], ...] = (
    agreement,
    no_explanation,
    nothing_predicts,
    every_rig_has_it,
    one_loading_shows_no_memory,
    identified,
    main_part,
    kind_only,
    unexplained,
)


def judged(evidence: Evidence) -> Verdict:
    """The verdict of the first rule that speaks."""
    return next(verdict for rule in RULES if (verdict := rule(evidence)) is not None)


def _praise(e: Evidence) -> tuple[str, ...]:
    return (
        f"The best explanation is {e.best}. It accounts for {part_percent(max(min(e.share, 1.0), 0.0))} of the excess "
        f"over noise in conditions that were left out, where the error falls from {percent(e.error_before)} to "
        f"{percent(e.error)} of the signal above the noise.",
    )


def _against(e: Evidence) -> tuple[str, ...]:
    """Sentences on why it is not all, or not one."""
    found = []
    if e.error > (THRESHOLDS.visible if e.share < THRESHOLDS.nearly_all else THRESHOLDS.left):
        found.append("It leaves more than the flaws of an ordinary rig.")
    if e.confirmed is not None and not e.holds:
        found.append(
            f"Fitted to half of the presses, it takes {part_percent(max(e.confirmed, 0.0))} of the excess away from "
            "the others."
        )
    if e.beaten:
        found.append(
            f"A flexible memory without mechanics predicts what was held out better (probability "
            f"{figure(e.something_else)})."
        )
    if e.implausible:
        found.append(
            f"It needs a value at the limit of what a real part can have, which is implausible: "
            f"{', '.join(e.implausible)}."
        )
    if e.group > THRESHOLDS.largest_group:
        found.append(
            f"{e.group} explanations cannot be told apart; at most {THRESHOLDS.largest_group} may remain for a name to "
            "be given."
        )
    return tuple(found)
