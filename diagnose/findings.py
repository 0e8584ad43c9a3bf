"""Findings of a diagnosis: everything that the verdict and the report are written from."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from diagnose.forward import Setting, Signals
from foundation.arrays import Floats


@dataclass(frozen=True)
class Detection:
    """The test for a mismatch. statistic : largest score over all cells and pools; p_value : family-wise.

    level : below it the p-value means a mismatch. least_p_value : the smallest that the random draws can give. noise :
    (label, channel) -> summary of its noise model.
    """

    statistic: float
    p_value: float
    level: float
    noise: Mapping[tuple[str, str], Mapping[str, Any]]
    least_p_value: float = 0.0


@dataclass(frozen=True)
class LocatedExcess:
    """A cell of the baseline's residual in which an excess was found. score : nearly standard normal.

    p_value : family-wise. share : of all excess. component : whose sensitivities explain most of it here, "" for none.
    """

    run: str
    channel: str
    phase: str
    press: int
    band_Hz: tuple[float, float]
    score: float
    p_value: float
    share: float
    component: str


@dataclass(frozen=True)
class Interval:
    """A parameter with its 90 % profile interval.

    low_searched, high_searched : this end is where the search ended, which the recordings do not exclude. fixed : the
    parameter does not depend on what was fitted, so that it has no interval.
    """

    value: float
    low: float
    high: float
    unit: str
    low_searched: bool = False
    high_searched: bool = False
    fixed: bool = False

    @property
    def limited_by_search(self) -> bool:
        """Whether an end is where the search ended, and not set by the recordings."""
        return self.low_searched or self.high_searched


@dataclass(frozen=True)
class FittedModel:
    """One to three mechanisms fitted to all runs, with how it predicts presses that it was not fitted to.

    gain, gain_lower : nats per press over the baseline, and the lower bound of its mean. probability : among all
    models, the baseline and something else. error_left : root mean square error above noise, relative to the signal,
    in conditions that were left out, of the worst channel. intervals : those of the
    parameters, where they are still to be found, which takes as long as many fits; None where nobody asks for them.
    shared : nuisance that all runs share -> its coordinate beside these mechanisms.
    """

    settings: tuple[Setting, ...]
    parameters: tuple[Mapping[str, Interval], ...]
    gain: float
    gain_lower: float
    probability: float
    error_left: float
    intervals: Callable[[], tuple[Mapping[str, Interval], ...]] | None = field(default=None, repr=False, compare=False)
    shared: Mapping[str, float] = field(default_factory=dict)

    def with_intervals(self) -> "FittedModel":
        """This model with the intervals of its parameters, which are found now if they were not yet."""
        return self if self.intervals is None else replace(self, parameters=self.intervals(), intervals=None)


@dataclass(frozen=True)
class Fit:
    """Errors of a fit as root mean square over that of the recording, without samples that are missing or saturated.

    presses : names of the presses that are meant. noise_floor_nrmse : the error that noise alone makes. by_channel :
    the squares of the three errors, before, after and of noise, of each channel; empty where there is one.
    """

    presses: tuple[str, ...]
    nrmse_before: float
    nrmse_after: float
    noise_floor_nrmse: float
    log_score_gain_per_press: float
    by_channel: tuple[tuple[float, float, float], ...] = ()

    @property
    def improves(self) -> bool:
        """Whether the error with the mechanisms is less than without."""
        return self.nrmse_after < self.nrmse_before

    @property
    def excess_before(self) -> float:
        """Square of the error without a mechanism above that of noise, at least 0 in each channel: one whose noise was
        estimated too large hides no other.
        """
        return sum(max(before - noise, 0.0) for before, _, noise in self._channels) / len(self._channels)

    @property
    def excess_after(self) -> float:
        """What is left of it with the mechanisms, at least 0."""
        taken = sum(before - after for before, after, _ in self._channels) / len(self._channels)
        return max(self.excess_before - taken, 0.0)

    @property
    def _channels(self) -> tuple[tuple[float, float, float], ...]:
        return self.by_channel or ((self.nrmse_before**2, self.nrmse_after**2, self.noise_floor_nrmse**2),)

    @property
    def share(self) -> float:
        """Share of the excess over noise that the mechanisms take away; 0 where there was none."""
        return 1.0 - self.excess_after / self.excess_before if self.excess_before > 0.0 else 0.0


class Grade(StrEnum):
    """How much a verdict says of what is missing: all of it, most of it, its kind, or only that something is."""

    AGREEMENT = "agreement"
    IDENTIFIED = "identified"
    MAIN_PART = "main part"
    KIND_ONLY = "kind only"
    UNEXPLAINED = "unexplained"


@dataclass(frozen=True)
class Remainder:
    """Rest beside a main part. share : of the excess over noise that the main part explains where it was not fitted.

    by_phase : phase -> share of what it leaves.
    """

    share: float
    by_phase: Mapping[str, float]


@dataclass(frozen=True)
class Findings:
    """mismatch, unexplained as inference.grades decides, with its reasons as sentences.

    engine, engine_accuracy : name and accuracy of the model, see diagnose.forward.Engine.
    models : all that were fitted, best first; best : the first of them where it is named, else None.
    remainder : where the best is only the main part, what it leaves; then the mismatch is unexplained as a whole.
    kind : half a sentence that is true of all explanations in the first group, where they are too many to name one.
    ambiguous : nothing but their number speaks against a name, whether or not they are of one kind.
    groups : indices into models that these recordings cannot tell apart, the best model's group first.
    nuisances : name or "name of run" -> (value, one sigma of the prior) beside the named mechanisms, else without any.
    baseline, improved : label -> fitted signals with nuisances; improved is None where nothing is named.
    unnamed, closest : held-out errors and signals of the first model where it is not named.
    screened : (mechanism, component) -> p-value of the score test. shares : component -> share of all excess.
    information : (p, p) of the best models' coordinates, in the order of models, see diagnose.next_press.
    """

    engine: str
    engine_accuracy: Mapping[str, float]
    detection: Detection
    places: tuple[LocatedExcess, ...]
    shares: Mapping[str, float]
    screened: Mapping[tuple[str, str], float]
    mismatch: bool
    unexplained: bool
    reasons: tuple[str, ...]
    models: tuple[FittedModel, ...]
    best: FittedModel | None
    groups: tuple[tuple[int, ...], ...]
    train: Fit | None
    held_out: Fit | None
    nuisances: Mapping[str, tuple[float, float]]
    baseline: Mapping[str, Signals]
    improved: Mapping[str, Signals] | None
    black_box_gain: float
    warnings: tuple[str, ...] = ()
    unnamed: Fit | None = None
    closest: Mapping[str, Signals] | None = None
    information: Floats | None = field(default=None, compare=False)
    remainder: Remainder | None = None
    kind: str = ""
    ambiguous: bool = False

    @property
    def comes_closer(self) -> bool:
        """Whether the first model, although it is not named, predicts held-out presses better than the baseline."""
        return self.unnamed is not None and self.unnamed.improves

    @property
    def grade(self) -> Grade:
        """Grade of the verdict: how much it says of what is missing."""
        if not self.mismatch:
            return Grade.AGREEMENT
        if self.best is not None and not self.unexplained:
            return Grade.IDENTIFIED
        if self.best is not None and self.remainder is not None:
            return Grade.MAIN_PART
        return Grade.KIND_ONLY if self.kind else Grade.UNEXPLAINED
