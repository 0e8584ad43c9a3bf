"""The forward model of a sensor of unknown geometry, which nobody can mesh, and what may be missing in it.

A factor on all signals is nothing but another sensitivity, which is free: parasitic capacitance, d31, moduli and, with
free sensitivities, crosstalk cannot be found, and are no candidates. What acts on "medium1" acts on whatever medium
strains the film.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import sinh
from typing import Self

import numpy as np

from diagnose.engines.coupon.tested_layer import active_mechanisms, layer_model, with_factors_last
from diagnose.engines.proportional.charge import Loading, amplifier_voltage, film_charge, held_back, other_charge
from diagnose.engines.proportional.medium import MEDIUM
from diagnose.forward import Candidate, Coordinate, Setting, Signals, SolvedOutright
from diagnose.signals.phases import Segmentation, find_phases, rest_level
from diagnose.signals.recording import Recording, Run
from diagnose.signals.time_scales import time_scales
from diagnose.vocabulary.base import candidates_of_unknown_geometry
from diagnose.vocabulary.scales import growing
from diagnose.vocabulary.scene import Scene, film_capacitance_pF, shown_answers
from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.progress import Report
from solve.mechanisms import Mechanism
from solve.model import Model, Readout
from solve.solution.errors import NoEquilibriumError

SENSITIVITY, CAPACITANCE = "sensitivity", "film-capacitance"
LARGEST_CAPACITANCE_RATIO = 1e4  # of the assumed film
LARGEST_SENSITIVITY_FACTOR = 1e6


def sensitivity_candidate(channel: int) -> Candidate:
    """Candidate of the relative change of a channel's sensitivity (from 1), of either sign; no mechanism."""
    coordinate = Coordinate(
        f"sensitivity of channel {channel}", -LARGEST_SENSITIVITY_FACTOR, LARGEST_SENSITIVITY_FACTOR, (0.5,)
    )
    return Candidate(SENSITIVITY, f"channel-{channel}", (coordinate,), lambda values: {"factor": 1.0 + values[0]})


def capacitance_candidate() -> Candidate:
    """Candidate of the capacitance that the film has beyond the assumed one, over that one; no mechanism."""
    coordinate = growing(CAPACITANCE, 1.0, LARGEST_CAPACITANCE_RATIO, (1.0, 30.0, 1000.0))
    return Candidate(CAPACITANCE, "film", (coordinate,), lambda values: {"coordinate": values[0]})


@dataclass(frozen=True)
class ProportionalEngine(SolvedOutright):
    """Forward model with a charge in proportion to the measured force, behind the amplifier as stated.

    largest_N : force above rest, of all runs. scene : sizes of the recording; its film is assumed, for only time
    constants show. loadings : of each run. sensitivity_C : (channels,) charge at the largest force at which the free
    sensitivities start. Nothing has to be prepared, and solve is predict at those starts.
    """

    recording: Recording
    largest_N: float
    scene: Scene
    loadings: tuple[Loading, ...]
    sensitivity_C: Floats
    candidates: tuple[Candidate, ...]
    free_nuisances: tuple[Candidate, ...]
    name: str = "charge proportional to force"
    accuracy: Mapping[str, float] = field(default_factory=dict)
    shortfalls: tuple[str, ...] = ()

    def nuisance(self, name: str) -> Candidate | None:
        """None for any name: moduli and thicknesses of a sensor that nobody knows hide in its sensitivity."""

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine with fewer candidates."""
        return replace(self, candidates=candidates)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Voltages (t,) of a run. ValueError beyond the bounds of a value, or where a law turns over."""
        hum = [s.values for s in settings if s.candidate.traits.free_phase]
        signals = self._answers(self.recording.runs[run], self.loadings[run], settings)
        return {name: values + sum(self._hum(run, one) for one in hum) for name, values in signals.items()}

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run that was not made, without hum. ValueError as predict."""
        phases = find_phases(run.time_s, run.drive_values, from_touch=False)
        return self._answers(run, _scaled_loading(run, phases, self.largest_N), settings)

    def _answers(self, run: Run, loading: Loading, settings: Sequence[Setting]) -> Signals:
        own = {s.candidate.name: s.values[0] for s in settings if s.candidate.mechanism in (SENSITIVITY, CAPACITANCE)}
        rest = [
            s
            for s in settings
            if s.candidate.mechanism not in (SENSITIVITY, CAPACITANCE) and not s.candidate.traits.free_phase
        ]
        more = sinh(own.get((CAPACITANCE, "film"), 0.0))
        factors = [1.0 + own.get((SENSITIVITY, f"channel-{n + 1}"), 0.0) for n in range(len(self.sensitivity_C))]
        try:
            signals = self._voltages(run, loading, active_mechanisms(rest), self.sensitivity_C * factors, more)
        except NoEquilibriumError as error:
            raise ValueError(str(error)) from None
        return signals

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a run with these mechanisms. NoEquilibriumError."""
        return self._voltages(self.recording.runs[run], self.loadings[run], mechanisms, self.sensitivity_C)

    def _voltages(
        self,
        run: Run,
        loading: Loading,
        mechanisms: Sequence[Mechanism],
        sensitivity_C: Floats,
        more_capacitance: float = 0.0,
    ) -> Signals:
        model = with_factors_last(idle_model(run, more_capacitance), mechanisms)
        shape, other = film_charge(model, loading), other_charge(model, loading)
        shown = shape - held_back(model, shape, 1e-12 * self.scene.charge_pC)  # whatever the free sensitivity
        return {
            name: amplifier_voltage(model, loading, charge * shown + other)
            for name, charge in zip(self.recording.runs[0].voltages, sensitivity_C, strict=True)
        }

    def _hum(self, run: int, values: Sequence[float]) -> Floats:
        """Hum (t,) of a run, from its sine and cosine.

        The filters of the amplifier change only its amplitude and phase.
        """
        phase = 2.0 * np.pi * self.scene.mains_Hz * self.recording.runs[run].time_s
        return np.asarray(values[2 * run] * np.sin(phase) + values[2 * run + 1] * np.cos(phase))


def idle_model(run: Run, more_capacitance: float = 0.0) -> Model:
    """Model of an idle segment with the medium of unit modulus and the amplifier of a run.

    more_capacitance : of the film, in terms of the assumed one. Charge flows into film and input together, so that it
    stands at the input.
    """
    model = layer_model(MEDIUM, 1.0, run.readout or Readout())
    assert model.readout is not None
    added = model.readout.input_capacitance_pF + more_capacitance * film_capacitance_pF(model)
    return replace(model, readout=model.readout.model_copy(update={"input_capacitance_pF": added}))


def proportional_engine(recording: Recording, report: Report) -> ProportionalEngine:
    """Engine of a recording of force and voltages. InputError for another drive, or for columns beside them."""
    for run in recording.runs:
        _refuse_unfit_run(run, recording.runs[0])
    largest_N = max(_largest_force_above_rest(run) for run in recording.runs)
    loadings = tuple(_scaled_loading(*pair, largest_N) for pair in zip(recording.runs, recording.phases, strict=True))
    scene = _scene(recording)
    free = [sensitivity_candidate(n + 1) for n in range(scene.channels)]
    if any(readout.input_resistance_MOhm for readout in scene.readouts):
        free.append(capacitance_candidate())
    engine = ProportionalEngine(
        recording, largest_N, scene, loadings, np.ones(scene.channels),
        candidates_of_unknown_geometry(scene, recording), tuple(free),
    )  # fmt: skip
    report("charge proportional to force", 1, 1)
    return replace(engine, sensitivity_C=_starting_charge_C(engine))


def _refuse_unfit_run(run: Run, first: Run) -> None:
    where = f"recording '{run.file}'"
    if run.drive != "force_N":
        raise InputError(f"{where}: geometry = 'unknown' needs drive = 'force_N', because its stiffness is not known")
    others = [name for name in run.answers if name not in run.voltages]
    if others:
        raise InputError(f"{where}: geometry = 'unknown' cannot explain column {others[0]}; leave it out")
    if not run.voltages:
        raise InputError(f"{where}: has no column of voltage")
    if run.voltages != first.voltages:
        raise InputError(f"{where}: has other columns of voltage than '{first.file}'")


def _largest_force_above_rest(run: Run) -> float:
    """Largest distance of the force of a run from its rest, in N."""
    return float(np.abs(run.drive_values - rest_level(run.drive_values)[0]).max())


def _scaled_loading(run: Run, phases: Segmentation, largest_N: float) -> Loading:
    """Loading of a run: its force from its rest, over the largest of all runs."""
    level = rest_level(run.drive_values)[0]
    before = max(run.largest_before.get(run.drive, level) - level, 0.0)
    touch_s = float(run.time_s[phases.presses[0].touch])
    return Loading(run.time_s, (run.smoothed_drive.values - level) / largest_N, touch_s, before / largest_N)


def _scene(recording: Recording) -> Scene:
    runs = recording.runs
    return Scene(
        model=idle_model(runs[0]),
        readouts=tuple(run.readout or Readout() for run in runs),
        depth_mm=1.0,
        force_N=1.0,
        voltage_V=max(float(np.nanmax(np.abs(run.channels[name]))) for run in runs for name in run.voltages),
        scales=time_scales(recording),
        channels=len(runs[0].voltages),
        shown=shown_answers(recording),
    )


def _starting_charge_C(engine: ProportionalEngine) -> Floats:
    """Charge (channels,) in C at the largest force that makes voltages of the size and, mostly, sign recorded."""
    recorded, predicted, product = (np.zeros(len(engine.sensitivity_C)) for _ in range(3))
    for number, run in enumerate(engine.recording.runs):
        signals = engine.solve(number, (), lambda *_: None)
        for n, name in enumerate(run.voltages):
            there = run.usable(name)
            given, unit = run.channels[name][there], signals[name][there]
            recorded[n] = max(recorded[n], float(np.abs(given).max()))
            predicted[n] = max(predicted[n], float(np.abs(unit).max()))
            product[n] += float((given - given.mean()) @ (unit - unit.mean()))
    return np.asarray(np.where(product < 0.0, -1.0, 1.0) * recorded / predicted)
