"""The forward model of a rig with a known segment, by tables of presses of its 3D model."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import Self

import numpy as np

from diagnose.engines.segment import full_model as full
from diagnose.engines.segment.depth import DRIVE_ZERO, nuisance_candidate
from diagnose.engines.segment.derived_quantities import with_derived
from diagnose.engines.segment.dot_positions import DotPositions
from diagnose.engines.segment.drive import Drive, model_drive, ramp_drive
from diagnose.engines.segment.kept_answers import Courses, Recent
from diagnose.engines.segment.path_history import PathHistory, with_histories
from diagnose.engines.segment.prepared import Prepared
from diagnose.engines.segment.presses import Place, with_dot_moved
from diagnose.engines.segment.refusals import refuse_unfit_baseline
from diagnose.engines.segment.response import FilmPlate, Mechanics, channel_signals, mechanics
from diagnose.engines.segment.stated_mechanisms import (
    permanent_settings,
    run_readout,
    untabulated_mechanisms,
    without_untabulated,
)
from diagnose.forward import Candidate, Setting, Signals
from diagnose.signals.recording import Recording, Run
from diagnose.signals.time_scales import time_scales
from diagnose.vocabulary.base import candidates_of_segment
from diagnose.vocabulary.scene import Scene, shown_answers
from foundation.arrays import Floats
from foundation.executor import HERE, Executor
from foundation.progress import Report
from solve.materials.parameters import PiezoelectricFilm
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Readout
from solve.physics import nonlinear_laws
from solve.readout.stages import Hum
from solve.reduced.fit import ResponseTable
from solve.reduced.rig import compliance_mm_per_N
from solve.tables.rig_mesh import MeshSettings, mesh_of
from solve.tables.table_changes import with_changes

MAX_FIXED_POINT_ROUNDS = 40
FORCE_TOLERANCE = 1e-6  # of the largest force
KEPT_TABLES = 4  # tables, and courses of each run: with and without what is fitted, and a step of it
TableQuestion = tuple[Place, list[Setting], float]


def segment_engine(
    model: Model, mesh_settings: MeshSettings, recording: Recording, report: Report, executor: Executor = HERE
) -> "SegmentEngine":
    """Engine of a rig with a known segment: press the baseline, or recall it. executor : does all presses.

    InputError, MeshingError, NoEquilibriumError.
    """
    return SegmentEngine(model, mesh_settings, recording, report, executor)


class SegmentEngine:
    """Forward model of a rig with a known segment, by tables of the 3D model; see diagnose.forward.Engine."""

    name = "3D FEM"
    free_nuisances: tuple[Candidate, ...] = ()

    def __init__(
        self, model: Model, mesh_settings: MeshSettings, recording: Recording, report: Report, executor: Executor
    ) -> None:
        refuse_unfit_baseline(model, recording)
        self.declared = permanent_settings(model)
        self.model, self.recording = without_untabulated(model), recording
        self.drives = [model_drive(*pair) for pair in zip(recording.runs, recording.phases, strict=True)]
        self.dot_positions = DotPositions(self.model, mesh_settings, recording, report, executor)
        self.dot_positions.add([setting.candidate for setting in self.declared], report)
        self.dot_positions.refine(self.declared, report)
        self.accuracy = self.dot_positions.accuracy
        self._tables: Recent[TableQuestion, ResponseTable] = Recent(KEPT_TABLES)
        self._histories: Recent[tuple[Place, list[Setting]], list[PathHistory]] = Recent(KEPT_TABLES)
        self._courses = Courses(KEPT_TABLES * len(recording.runs))
        stated = {(one.name, one.component) for one in untabulated_mechanisms(model)}
        self.candidates: tuple[Candidate, ...] = tuple(
            with_derived(c, self.first_presses) for c in candidates_of_segment(self.scene) if c.name not in stated
        )

    @property
    def first_presses(self) -> Prepared:
        """Prepared presses for the position of the dot in the first run."""
        return self.dot_positions.presses_at(self.recording.runs[0].dot_offset_mm)[0]

    @property
    def channels(self) -> int:
        """Electrodes, each with an amplifier."""
        return max(1, len(self.model.segment.film.electrodes))

    @cached_property
    def scene(self) -> Scene:
        """Scene of the recording, on which the candidates depend."""
        runs = self.recording.runs
        values = [run.channels[name][run.usable(name)] for run in runs for name in run.voltages]
        return Scene(
            model=self.model,
            readouts=tuple(self._readout(run) or Readout() for run in runs),
            depth_mm=self.first_presses.pressed_mm,
            force_N=float(self.first_presses.fit.table[-1, 0, 0]),
            voltage_V=max((float(np.abs(v).max()) for v in values if len(v)), default=0.0),
            scales=time_scales(self.recording),
            channels=self.channels,
            shown=shown_answers(self.recording),
            strain_pC=1e12 * float(np.abs(self.first_presses.fit.table[-1, 0, 2 : 2 + self.channels]).max()),
            places=tuple(dict.fromkeys(run.dot_offset_mm for run in runs)),
        )

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Sentences on candidates that the 3D model could not press as it should."""
        return self.dot_positions.shortfalls

    def nuisance(self, name: str) -> Candidate | None:
        """Candidate of a nuisance, see diagnose.forward.Engine; also "offset_mm", the error of the first touch."""
        return nuisance_candidate(self.scene, self.recording, name)

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine with fewer candidates."""
        fewer = copy(self)
        fewer.candidates = candidates
        return fewer

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Press what these candidates need. NoEquilibriumError."""
        self.dot_positions.add(candidates, report)
        self._forget()

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Press these candidates at few places on a coarse mesh. NoEquilibriumError."""
        self.dot_positions.add_roughly(candidates, report)
        self._forget()

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """Press each of these settings. NoEquilibriumError where the baseline has none."""
        self._forget()
        return self.dot_positions.refine(settings, report)

    def _forget(self) -> None:
        self._tables.clear()
        self._histories.clear()

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run. ValueError for what was not prepared, and where a signal is beyond all numbers."""
        asked, drive = self.recording.runs[run], self.drives[run]
        ahead_s, hum = self._hum(run, settings)
        return self._answers(asked, drive, asked.answers, settings, hum, ahead_s)

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every channel of a run that was not made, its hum left out. ValueError for what was not prepared."""
        runs = (*self.recording.runs, run)
        names = dict.fromkeys(name for each in runs for name in each.channels if name != run.drive)
        return self._answers(run, model_drive(run, Recording((run,)).phases[0]), tuple(names), settings, (), 0.0)

    def _answers(
        self,
        run: Run,
        drive: Drive,
        names: Sequence[str],
        settings: Sequence[Setting],
        hum: Sequence[Hum],
        ahead_s: float,
    ) -> Signals:
        """Signals (t,) of the named channels of a run. ValueError as predict."""
        settings = [*self.declared, *(setting for setting in settings if any(setting.values))]
        direct = [s.candidate.as_mechanism(s.values) for s in settings if s.candidate.traits.acts_on_tables]
        on = with_mechanisms(replace(self.model, readout=self._readout(run)), direct)
        values = self._drive_from_touch(drive, on, settings)
        found = self._mechanics(run, drive, values, on, settings)
        on = replace(on, physics=replace(on.physics, stages=(*on.physics.stages, *hum)))
        signals = channel_signals(run, names, drive, values, found, self._film_plate(on), on, ahead_s)
        if not all(np.isfinite(signal[drive.touching]).all() for signal in signals.values()):
            raise ValueError(f"run '{run.label}': a signal is beyond all numbers")
        return signals

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a run by the 3D model along its own drive. ValueError, NoEquilibriumError."""
        asked, drive = self.recording.runs[run], self.drives[run]
        base, beside = self.dot_positions.presses_at(asked.dot_offset_mm)
        believed = replace(with_dot_moved(base.model, beside), readout=self._readout(asked))
        stated = [setting.candidate.as_mechanism(setting.values) for setting in self.declared]
        on = with_mechanisms(believed, [*stated, *mechanisms])
        elastic, values = replace(on, physics=replace(on.physics, inelastic={})), self._drive_from_touch(drive, on, ())

        def shape(fit: ResponseTable) -> full.Shape:
            return lambda of, values: mechanics(fit, base.depth_mm, base.relaxing, of, values, elastic)

        tet_mesh = mesh_of(on, base.model, base.presses.tet_mesh, base.presses.options)
        before = asked.largest_before.get(asked.drive, 0.0) if nonlinear_laws(on.physics.inelastic) else 0.0
        alike = shape(base.raw), shape(base.fit)
        task = full.Task(asked, drive, values, on, tet_mesh, self._film_plate(on), *alike, before)
        return full.solve(task, report)

    def _readout(self, run: Run) -> Readout | None:
        return run_readout(self.model, run.readout)

    def _drive_from_touch(self, drive: Drive, on: Model, settings: Sequence[Setting]) -> Floats:
        """Drive (t,) from the first touch of a model, in mm, or in N."""
        if not drive.by_depth:
            return drive.values
        zero = sum(setting.values[0] for setting in settings if setting.candidate.mechanism == DRIVE_ZERO)
        return np.asarray(drive.values - on.dot.gap_mm - zero)

    def _mechanics(self, run: Run, drive: Drive, values: Floats, on: Model, settings: Sequence[Setting]) -> Mechanics:
        """Mechanics of a run. What depends on the path acts back on a compliant drive: a fixed point."""
        (base, _), fit = self.dot_positions.presses_at(run.dot_offset_mm), self._response_table(run, on, settings)
        found = self._courses.mechanics(fit, base.depth_mm, base.relaxing, drive, values, on)
        asked = run.dot_offset_mm, base.path_dependent_settings(settings)
        if not asked[1]:
            return found
        histories = self._histories.recall_or_make(asked, lambda: base.path_histories(settings))
        before_mm = self._depth_before_mm(run, fit, on, settings)
        give = compliance_mm_per_N(on.physics) if drive.by_depth else 1.0
        added = np.zeros(len(values))
        for _ in range(MAX_FIXED_POINT_ROUNDS):
            whole = with_histories(found, histories, fit, base.depth_mm, before_mm)
            change = whole.force_N - found.force_N - added
            added = added + change
            if give == 0.0 or np.abs(change).max() <= FORCE_TOLERANCE * np.abs(whole.force_N).max():
                break
            found = mechanics(fit, base.depth_mm, base.relaxing, drive, values - give * added, on)
        return whole

    def _depth_before_mm(self, run: Run, fit: ResponseTable, on: Model, settings: Sequence[Setting]) -> float:
        """Deepest path of the dot in mm in the runs before; what depends on the path does not act back on it here."""
        base, _ = self.dot_positions.presses_at(run.dot_offset_mm)
        slowly = tuple(term for term in on.physics.terms if not term.follows_time)
        at_once = replace(on, physics=replace(on.physics, inelastic={}, terms=slowly))
        deepest = 0.0
        for name, value in run.largest_before.items():
            drive = ramp_drive(value, name)
            values = self._drive_from_touch(drive, on, settings)
            found = mechanics(fit, base.depth_mm, base.relaxing, drive, values, at_once)
            deepest = max(deepest, float(found.path_mm[-1]))
        return deepest

    def _response_table(self, run: Run, on: Model, settings: Sequence[Setting]) -> ResponseTable:
        """Response table of the rig with all that changes it.

        It is kept: runs share it, and what stands behind the film leaves it alone.
        """
        base, beside = self.dot_positions.presses_at(run.dot_offset_mm)
        factor = _d31(on) / _d31(self.model)

        def changed_table() -> ResponseTable:
            change = base.table_change(beside, settings)
            if change is None and factor == 1.0:
                return base.fit
            return with_changes(base.fit, base.depths, base.no_change if change is None else change, factor)

        return self._tables.recall_or_make((run.dot_offset_mm, base.elastic_settings(settings), factor), changed_table)

    def _film_plate(self, on: Model) -> FilmPlate:
        """Film of a model as a plate; a thinner film has more capacitance."""
        return self.first_presses.film.with_capacitance_factor(
            self.model.segment.film.thickness_um / on.segment.film.thickness_um
        )

    def _hum(self, run: int, settings: Sequence[Setting]) -> tuple[float, tuple[Hum, ...]]:
        """Time in s by which the mains are ahead of the touch in a run, and their hum; none where it is off."""
        for setting in settings:
            if setting.candidate.traits.free_phase:
                sine, cosine = setting.values[2 * run : 2 * run + 2]
                ahead_s = float(np.arctan2(cosine, sine)) / (2.0 * np.pi * self.scene.mains_Hz)
                return ahead_s, (Hum(self.scene.mains_Hz, float(np.hypot(sine, cosine))),)
        return 0.0, ()


def _d31(model: Model) -> float:
    film = model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    return film.d31_pC_per_N or film.d33_pC_per_N
