"""Forward models as a diagnosis sees them, whatever solves them: the segment in 3D, a coupon, a proportional sensor."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, Self

from diagnose.signals.recording import Run
from foundation.arrays import Floats
from foundation.progress import Report
from solve.mechanisms import Mechanism, Traits, traits_of


class NoAnswerError(ValueError):
    """A trial to which a forward model has no answer: it is rejected, whoever made it."""


Signals = Mapping[str, Floats]
"""Channel -> samples (t,) of one run, named as in the recording."""


@dataclass(frozen=True)
class Coordinate:
    """One number that is fitted; 0 is off. Chosen so that the answer is smooth in it, at best linear near 0.

    low, high : what a real part can have; 0 lies between them or on one of them. At an end the value is implausible.
    starts : from where nonlinear fits begin besides the linear estimate; not 0.
    nodes : values at which the 3D model itself is pressed, without 0; () where no press of its own is needed.
    levels_off : beyond the low, the high end the answer is about that at the end; then that end is plausible.
    """

    name: str
    low: float
    high: float
    starts: tuple[float, ...]
    nodes: tuple[float, ...] = ()
    levels_off: tuple[bool, bool] = (False, False)


@dataclass(frozen=True)
class Candidate:
    """A mechanism at a component, by its coordinates.

    parameters : values of the coordinates -> parameters as in [[mechanisms]]; only for values that are not all off.
    derived : the same -> quantities that are comparable between laws (relaxed_fraction, force_ratio, loss_ratio).
    compared : which of these, "force_ratio" or "loss_ratio", a press of the 3D model tells; "" for none.
    together : how its coordinates go together in presses of the 3D model: "sum", "jointly", "fading" or "glue" (see
    diagnose.engines.segment.interpolation).
    units : name of a parameter or derived quantity -> unit in the verdict.
    everyday : name of a parameter or derived quantity -> what a careful laboratory has of it: no finding.
    stated_as : nuisance parameter by which rig.toml says how uncertain it is, such as "offset_mm"; "" for none.
    identical_to : names of what would be the very same element of the model, and is no candidate of its own.
    either_sign : parameters whose sign nobody can tell, as the rig is its own mirror image: told without one.
    told : values -> numbers by which the verdict tells it where parameters will not do: each is the same quantity at
    all values, and no modulus that is fitted beside it is a part of it. None: the parameters.
    """

    mechanism: str
    component: str
    coordinates: tuple[Coordinate, ...]
    parameters: Callable[[Sequence[float]], dict[str, Any]]
    derived: Callable[[Sequence[float]], dict[str, float]] = lambda _: {}
    units: Mapping[str, str] = field(default_factory=dict)
    compared: str = ""
    together: str = "sum"
    everyday: Mapping[str, float] = field(default_factory=dict)
    stated_as: str = ""
    identical_to: tuple[tuple[str, str], ...] = ()
    either_sign: tuple[str, ...] = ()
    told: Callable[[Sequence[float]], dict[str, Any]] | None = None

    @property
    def traits(self) -> Traits:
        """Traits of its mechanism."""
        return traits_of(self.mechanism)

    @property
    def name(self) -> tuple[str, str]:
        """Mechanism and component."""
        return self.mechanism, self.component

    def is_ordinary(self, values: Sequence[float]) -> bool:
        """Whether a careful laboratory's rig has as much of it as with values (q,)."""
        if not self.everyday:
            return False
        found = {**self.parameters(values), **self.derived(values)}
        return all(found[name] <= most for name, most in self.everyday.items())

    def as_mechanism(self, values: Sequence[float]) -> Mechanism:
        """Mechanism with values (q,) as a configuration has it. ValueError for values beyond its bounds."""
        return Mechanism(name=self.mechanism, component=self.component, parameters=self.parameters(values))


@dataclass(frozen=True)
class Setting:
    """A candidate at values (q,) of its coordinates; all 0: off."""

    candidate: Candidate
    values: tuple[float, ...]


class Engine(Protocol):
    """A forward model of all runs of a recording.

    name : for the verdict. accuracy : "force_N", "voltage_V" or "displacement_mm" -> one sigma of its own error of
    discretisation and reduction, relative to the signal. candidates : what may be missing here.
    free_nuisances : what nobody states and every fit finds anew, without prior and never a mismatch, one coordinate
    each: the sensitivity of a sensor of unknown geometry. 0 is only a start; linearise about what was fitted, since
    gain and lag act on the fitted signal. () where everything is stated. They are no Mechanisms.
    shortfalls : sentences on what prepare could not do.
    """

    @property
    def name(self) -> str:
        """Name of the model for the verdict."""

    @property
    def accuracy(self) -> Mapping[str, float]:
        """Relative error, one sigma, by channel without number."""

    @property
    def candidates(self) -> tuple[Candidate, ...]:
        """Candidates for what may be missing, in any order."""

    @property
    def free_nuisances(self) -> tuple[Candidate, ...]:
        """Nuisances that every fit finds anew; none where everything is stated."""

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Sentences on what could not be prepared so far."""

    def nuisance(self, name: str) -> Candidate | None:
        """Candidate whose single coordinate is the relative error of "modulus.medium1", "thickness.film" or "d31".

        None where the model has no such part.
        """

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine with fewer candidates."""

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Do the full solves that these candidates need, or recall them. Repeated calls cost nothing."""

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Do few and coarse solves: predictions with these candidates tell which of them are worth all solves."""

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """Do a full solve with each of these settings alone, so that predictions near them are as right as there.

        Returns those whose predictions have changed by more than an error that matters.
        """

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run (number in the recording) in milliseconds, at its own times, without noise.

        Settings add up; none is the baseline. ValueError where they lie beyond what was prepared.
        """

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run that was not recorded: its drive as samples, readout and dot_offset_mm, no answers.

        It has every channel of the sensor, by the names of the recording. ValueError with one sentence where this is
        beyond what the model can tell, such as deeper than was prepared or off the prepared position.
        """

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a run by the full model with these mechanisms, in minutes. NoEquilibriumError."""


class SolvedOutright:
    """Base of engines whose every prediction is solved, in milliseconds: nothing is prepared or refined."""

    solves_outright = True

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Do nothing."""

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Do nothing."""

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """No settings, as predictions are as right everywhere."""
        return ()
