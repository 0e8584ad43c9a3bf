"""The amplifier alone as a forward model: charges are those of a rig's baseline, resistance and capacitance are fitted.

R is that of the input, or of the feedback; C likewise. Stated values are where both are off; without a stated R the
conductance grows from zero.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import asinh, exp, log, sinh
from typing import Self

import numpy as np

from diagnose.forward import Candidate, Coordinate, Setting, Signals, SolvedOutright
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats
from foundation.progress import Report
from solve.mechanisms import Mechanism
from solve.mechanisms.circuit.charge_leakage import CHARGE_LEAKAGE
from solve.mechanisms.circuit.parasitic_capacitance import PARASITIC_CAPACITANCE
from solve.model import Readout
from solve.physics import Physics
from solve.readout.channels import amplify_channels

MOST_FACTOR = 1e4
"""Up to which R and C are sought above and below what is stated."""


@dataclass(frozen=True)
class ReadoutEngine(SolvedOutright):
    """Voltages of a recording behind one amplifier. charge_C : (t, e) of every run from its first sample.

    capacitance_F : (e,) of the film; readout, physics : of the amplifier as stated. error : relative, of the charges.
    """

    recording: Recording
    charge_C: tuple[Floats, ...]
    capacitance_F: Floats
    readout: Readout
    physics: Physics
    error: float

    name = "read-out alone"
    free_nuisances: tuple[Candidate, ...] = ()
    shortfalls: tuple[str, ...] = ()

    @property
    def accuracy(self) -> Mapping[str, float]:
        """Relative error of the charges, which all voltages have."""
        return {"voltage_V": self.error}

    @cached_property
    def candidates(self) -> tuple[Candidate, ...]:
        """Resistance and capacitance."""
        return self._resistance(), self._capacitance()

    def nuisance(self, name: str) -> Candidate | None:
        """None: nothing of the segment floats."""
        return None

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine: it has no others."""
        return self

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Voltages of a run behind the amplifier with these R and C."""
        changes: dict[str, float] = {}
        for one in settings:
            ((_, value),) = one.candidate.parameters(one.values).items()
            changes[self._key(one.candidate)] = float(value)
        readout = self.readout.model_copy(update=changes)
        asked = self.recording.runs[run]
        found = amplify_channels(asked.time_s, self.charge_C[run], self.capacitance_F, readout, self.physics)
        return dict(zip(asked.voltages, found, strict=True))

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """ValueError: a run that was not recorded has no charge here."""
        raise ValueError(f"run '{run.label}': the read-out alone knows recorded runs only")

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """The same as predict: nothing is pressed."""
        return self.predict(run, ())

    @property
    def keys(self) -> tuple[str, str]:
        """Keys of [readout] for R and C."""
        if self.readout.mode == "charge":
            return "feedback_MOhm", "feedback_pF"
        return "input_resistance_MOhm", "input_capacitance_pF"

    def _key(self, candidate: Candidate) -> str:
        return self.keys[candidate.mechanism == PARASITIC_CAPACITANCE.name]

    def _resistance(self) -> Candidate:
        """R by its logarithm over the stated one; without one by a conductance that grows."""
        stated, most = getattr(self.readout, self.keys[0]), log(MOST_FACTOR)
        if stated is not None:
            return self._by_factor(CHARGE_LEAKAGE.name, "resistance_MOhm", stated, -most)
        longest_s = max(float(run.time_s[-1] - run.time_s[0]) for run in self.recording.runs)
        scale = 1e-6 * longest_s / self._whole_F  # MOhm: with it the charge leaks away within the longest run
        top = asinh(MOST_FACTOR)
        coordinate = Coordinate("conductance", 0.0, top, (asinh(1.0), asinh(30.0)), levels_off=(True, True))
        told = lambda values: {"resistance_MOhm": scale / max(sinh(values[0]), 1e-9)}  # noqa: E731
        return Candidate(CHARGE_LEAKAGE.name, "readout", (coordinate,), told, units={"resistance_MOhm": "MOhm"})

    def _capacitance(self) -> Candidate:
        """C by the logarithm of all that takes the charge; a film without any more is the least."""
        if self.readout.mode == "charge":
            feedback = self.readout.feedback_pF or 1.0
            return self._by_factor(PARASITIC_CAPACITANCE.name, "capacitance_pF", feedback, -log(MOST_FACTOR))
        film, whole = 1e12 * float(self.capacitance_F.mean()), 1e12 * self._whole_F
        beside = whole - film - self.readout.input_capacitance_pF  # of the part itself
        return self._by_factor(
            PARASITIC_CAPACITANCE.name, "capacitance_pF", whole, log((film + beside) / whole), film + beside
        )

    @property
    def _whole_F(self) -> float:
        """Capacitance that takes the charge of one electrode."""
        if self.readout.mode == "charge":
            return 1e-12 * (self.readout.feedback_pF or np.inf)
        return float(self.capacitance_F.mean()) + 1e-12 * self.readout.whole_input_pF

    def _by_factor(self, mechanism: str, key: str, stated: float, low: float, without: float = 0.0) -> Candidate:
        """A quantity by the logarithm of its factor; without : of it that is no key of [readout]."""
        starts = tuple(sign * step for step in (0.3, 3.0) for sign in (1.0, -1.0) if sign * step > low)
        coordinate = Coordinate(key, low, log(MOST_FACTOR), starts)
        told = lambda values: {key: max(stated * exp(values[0]) - without, 0.0)}  # noqa: E731
        unit = key.rpartition("_")[2]
        return Candidate(mechanism, "readout", (coordinate,), told, units={key: unit})


def with_voltages_alone(recording: Recording, readout: Readout) -> Recording:
    """The runs with their drive and their voltages, on another amplifier."""
    return replace(recording, runs=tuple(_with_voltages_alone(run, readout) for run in recording.runs))


def _with_voltages_alone(run: Run, readout: Readout) -> Run:
    """A run with its drive and its voltages."""
    kept = (run.drive, *run.voltages)
    channels = {name: run.channels[name] for name in kept}
    valid, saturated = ({name: flags[name] for name in kept} for flags in (run.valid, run.saturated))
    return replace(run, readout=readout, channels=channels, valid=valid, saturated=saturated)
