"""What is recorded of every converged state: loads and charges; and fields at the reported steps."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.symmetry import mirrored_mesh
from mesh.types import TetMesh
from solve.added import Motion, added_charge_C
from solve.convergence_warnings import convergence_warnings
from solve.fields import fields
from solve.film_means import film_peak
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.model import Press
from solve.physics import Physics
from solve.result import PressResult, Record, Step, Trace
from solve.solution.schedule import first_reached_s, fraction
from solve.system import State, System
from solve.waveform import Waveform
from solve.whole_segment import meshed_share, whole_charge


def prescribed_acceleration(press: Press, trace: Trace) -> Floats:
    """Second derivative (t,) of the prescribed path in m/s2, by central differences of the waveform.

    The interval is the smallest of the recorded ones: at a kink a finite sensor sees a finite pulse.
    """
    waveform, time = press.waveform or Waveform(), trace.time_s
    if len(time) < 2:
        return np.zeros_like(time)
    h = float(np.diff(time).min())
    depth = 1e-3 * press.depth_mm
    before, now, after = (fraction(waveform, time + shift) for shift in (-h, 0.0, h))
    return np.asarray(depth * (after - 2.0 * now + before) / h**2)


def prescribed_velocity(press: Press, trace: Trace) -> Floats:
    """First derivative (t,) of the prescribed path in m/s, by central differences as of prescribed_acceleration."""
    waveform, time = press.waveform or Waveform(), trace.time_s
    if len(time) < 2:
        return np.zeros_like(time)
    h = float(np.diff(time).min())
    before, after = (fraction(waveform, time + shift) for shift in (-h, h))
    return np.asarray(1e-3 * press.depth_mm * (after - before) / (2.0 * h))


class Recorder:
    """Collects the history of a press in SI units."""

    def __init__(
        self,
        system: System,
        tet_mesh: TetMesh,
        physics: Physics,
        segment: Segment,
        materials: Mapping[str, Material],
    ) -> None:
        self.system, self.tet_mesh, self.physics = system, tet_mesh, physics
        self.segment, self.film = segment, materials["film"]
        self.whole = mirrored_mesh(tet_mesh)
        self._copies, self._whole_force = 2 ** len(tet_mesh.planes), np.full(3, 1.0 / meshed_share(segment, tet_mesh))
        self._whole_force[list(tet_mesh.planes)] = 0.0  # both sides of a mirror plane pull against each other
        self._whole_charge = whole_charge(segment, tet_mesh)
        self.steps: list[Step] = []
        self.records: list[Record] = []
        self._rest_charge = np.zeros(system.film.electrodes)
        self._last: tuple[State, State] | None = None
        self._reported = 0

    def start(self, rest: State) -> None:
        """The unloaded state: its charge, of a prestretch, has long leaked away."""
        self._last = (rest, rest)
        self._rest_charge = self._mechanical_charge(rest, rest)
        self.record(rest, rest)
        self.report()

    def memory(self) -> list[Any]:
        """Everything that was recorded, to be restored later."""
        return [self.records, self.steps, self._rest_charge]

    def restore(self, memory: list[Any]) -> None:
        """Go on after what was recorded."""
        self.records, self.steps, self._rest_charge = memory
        self._reported = len(self.records)

    def record(self, state: State, before: State) -> None:
        """Add a converged state; before : the one its step started from."""
        self._last = (state, before)
        units, system = self.system.units, self.system
        trial = system.trial(state.x, state.load, state.time, before)
        resultant = system.dot_force(trial)
        drive = state.load.drive
        sensor = -float(trial.move[2]) if system.unknowns.approach < 0 or self.system.force_driven else drive
        touched = system.contact.closed_nodes(trial)  # the pressure of open nodes is zero but for round-off
        self.records.append(
            Record(
                time_s=state.time,
                indentation_m=sensor * units.length,
                dot_path_m=-float(trial.move[2]) * units.length,
                contact_force_N=-resultant * units.force * self._whole_force,
                rig_force_N=self._rig_force(state, before) * units.force * self._whole_force[2],
                film_charge_C=(self._mechanical_charge(state, before) - self._rest_charge),
                contact_area_m2=self._copies * float(system.contact.nodal_area[touched].sum()) * units.length**2,
                newton_iterations=state.iterations,
                relative_residual=state.relative_residual,
                time_error=state.time_error,
                snapped=state.snapped,
            )
        )

    def report(self) -> None:
        """Make the last recorded state a step with its fields."""
        assert self._last is not None
        state, before = self._last
        record, system = self.records[-1], self.system
        move = system.move(state.x, state.load)
        self.steps.append(
            Step(
                time_s=record.time_s,
                indentation_m=record.indentation_m,
                reaction_force_N=record.rig_force_N,
                film_charge_C=record.film_charge_C,
                open_circuit_voltage_V=record.film_charge_C / self.capacitance_F,
                newton_iterations=sum(r.newton_iterations for r in self.records[self._reported :]),
                relative_residual=max(r.relative_residual for r in self.records[self._reported :]),
                dot_position_m=1e-3 * system.contact.dot.shape.origin_mm + move * system.units.length,
                dot_force_N=record.contact_force_N,
                fields=fields(system, self.tet_mesh, self.whole, state, before),
            )
        )
        self._reported = len(self.records)

    def result(self, failure: str | None, linear_solver: str, press: Press, follows_time: bool) -> PressResult:
        """The whole history; sources of charge that do not depend on the mechanics are added here."""
        trace = self.trace(press)
        charge, progress = trace.film_charge_C, trace.time_s
        at = np.searchsorted(trace.time_s, [step.time_s for step in self.steps])
        if not follows_time:
            progress = trace.time_s / (press.waveform or Waveform()).rise_s
            trace = replace(trace, time_s=first_reached_s(progress, press))
        steps = tuple(
            replace(
                step,
                time_s=float(trace.time_s[i]),
                reaction_force_N=float(trace.reaction_force_N[i]),
                film_charge_C=charge[i],
                open_circuit_voltage_V=charge[i] / self.capacitance_F,
            )
            for step, i in zip(self.steps, at, strict=True)
        )
        return PressResult(
            steps=steps,
            trace=trace,
            follows_time=follows_time,
            progress=progress,
            tet_mesh=self.whole.tet_mesh,
            planes=self.tet_mesh.planes,
            converged=failure is None,
            failure=failure,
            electrode_names=tuple(e.name for e in self.segment.film.electrodes) or ("film",),
            capacitance_F=self.capacitance_F,
            unknowns=self.system.count,
            linear_solver=linear_solver,
            max_relative_residual=max(step.relative_residual for step in steps),
            film_peak=film_peak(steps, self.whole.tet_mesh, self.segment),
            warnings=convergence_warnings(steps, self.records),
        )

    @property
    def capacitance_F(self) -> Floats:
        """Capacitance (e,) in F of the undeformed film under each electrode."""
        units = self.system.units
        return self._whole_charge @ self.system.film.capacitance() * (units.charge / units.voltage)

    @property
    def electrode_area_m2(self) -> Floats:
        """Undeformed area (e,) in m2 of the film under each electrode."""
        return np.asarray(self._whole_charge @ self.system.film.area() * self.system.units.length**2)

    def _mechanical_charge(self, state: State, before: State) -> Floats:
        """Short-circuit charge (e,) in C that the strain of the film puts on each electrode."""
        film, system = self.system.film, self.system
        trial = system.trial(state.x, state.load, state.time, before)
        return self._whole_charge @ film.charge(trial, system.history_of(film, before)) * system.units.charge

    def _rig_force(self, state: State, before: State) -> float:
        """Reading of the rig's force sensor in solver units, positive in compression."""
        trial = self.system.trial(state.x, state.load, state.time, before)
        rig = self.system.rig
        return -float(self.system.dot_force(trial)[2]) if rig is None else rig.drive_force(trial)

    def trace(self, press: Press) -> Trace:
        """Trace of everything that was recorded, with what the physics adds."""
        trace = self._trace()
        motion = Motion(
            1e3 * trace.indentation_m,
            lambda: 1e3 * prescribed_velocity(press, trace),
            lambda: 1e3 * prescribed_acceleration(press, trace),
        )
        added_N = self.physics.added_force_N(motion, dot_is_free=self.system.rig is not None)
        return replace(
            trace,
            reaction_force_N=trace.reaction_force_N + added_N,
            film_charge_C=trace.film_charge_C + self._added_charge(trace),
        )

    def _trace(self) -> Trace:
        """Trace of everything that was recorded, without what the physics adds."""
        return Trace(
            time_s=np.array([r.time_s for r in self.records]),
            indentation_m=np.array([r.indentation_m for r in self.records]),
            dot_path_m=np.array([r.dot_path_m for r in self.records]),
            reaction_force_N=np.array([r.rig_force_N for r in self.records]),
            contact_force_N=np.array([r.contact_force_N for r in self.records]),
            film_charge_C=np.array([r.film_charge_C for r in self.records]),
            contact_area_m2=np.array([r.contact_area_m2 for r in self.records]),
        )

    def _added_charge(self, trace: Trace) -> Floats:
        """Charge (t, e) in C that is not of the strain."""
        assert isinstance(self.film, PiezoelectricFilm)
        constant = self.film.pyroelectric_uC_per_m2_K
        film = trace.time_s, trace.contact_area_m2, self.electrode_area_m2, constant, trace.film_charge_C
        return added_charge_C(self.physics.added, *film)
