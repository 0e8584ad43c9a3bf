"""A run by the 3D model itself: its drive as a waveform, its answer at the run's own times."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.engines.segment.drive import Drive
from diagnose.engines.segment.presses import without_gap
from diagnose.engines.segment.response import FilmPlate, Mechanics, channel_signals
from diagnose.engines.segment.solved_times import solved_samples
from diagnose.forward import Signals
from diagnose.signals.recording import Run
from foundation.arrays import Floats
from foundation.progress import Report
from solve.materials.prony import Prony
from solve.model import Model, Press
from solve.physics import laws_of
from solve.press import press_segment
from solve.result import PressResult, Trace
from solve.solution.errors import NoEquilibriumError
from solve.tables.rig_mesh import Mesh
from solve.waveform import Waveform

TIMELESS_LOAD_STEPS = 8  # of a press in which time does not count
THINNING_TOLERANCE = 0.002  # of the largest drive, by which the thinned drive may differ
MOST_WAVEFORM_POINTS = 199  # what a waveform file may have
REST_IN_RELAXATION_TIMES = 10.0  # times the slowest relaxation
Shape = Callable[[Drive, Floats], Mechanics]


@dataclass(frozen=True)
class Task:
    """A run to solve by the 3D model: its drive with values (t,) in mm or N, and the model with all mechanisms.

    shape : the elastic answer of this mesh's table to any drive. Between the states of the 3D model only the difference
    from it is interpolated, which is smooth where force and charge bend. fine : the same of the table that is corrected
    by a finer mesh. before : the largest drive of earlier runs, in mm or N; 0 for none.
    """

    run: Run
    drive: Drive
    values: Floats
    model: Model
    tet_mesh: Mesh
    film: FilmPlate
    shape: Shape
    fine: Shape
    before: float = 0.0

    @property
    def largest_drive(self) -> float:
        """Largest value of the drive, in this run and before, in mm or N."""
        return max(float(self.values.max()), self.before)


def solve(task: Task, report: Report) -> Signals:
    """Every answer of the task's run by the 3D model. NoEquilibriumError."""
    pressed = replace(task, model=replace(task.model, physics=replace(task.model.physics, added=())))
    found = _solve_through_time(pressed, report) if pressed.model.follows_time else _solve_by_depth(pressed, report)
    # path, force and charge are those of the press itself: what is added and the amplifier are still to come
    return channel_signals(task.run, task.run.answers, task.drive, task.values, found, task.film, task.model)


def _press_run(task: Task, press: Press, report: Report) -> PressResult:
    """Result of a press of the task's model. NoEquilibriumError where it stops short."""
    model = replace(without_gap(task.model), press=press, readout=None)
    result = press_segment(
        model, task.tet_mesh, lambda _, number, count: report(f"3D press of {task.run.label}", number, count)
    )
    if result.failure is not None:
        raise NoEquilibriumError(f"the 3D press of {task.run.label}: {result.failure}", np.zeros(0), None)
    return result


def _press_target(task: Task) -> dict[str, float]:
    """Target of the press as a keyword of Press: the largest depth in mm, or force in N."""
    name = "indentation_mm" if task.drive.by_depth else "force_N"
    return {name: task.largest_drive}


def _solve_by_depth(task: Task, report: Report) -> Mechanics:
    """Mechanics from one press down; the run passes the same states, up and down."""
    trace = _press_run(task, Press(**_press_target(task), load_steps=TIMELESS_LOAD_STEPS), report).trace
    at = 1e3 * trace.indentation_m if task.drive.by_depth else trace.reaction_force_N
    at, first = np.unique(at, return_index=True)
    alike = Drive(np.arange(float(len(at))), at, task.drive.kind, np.ones(len(at), dtype=np.bool_))
    return _interpolate_mechanics(
        _trace_columns(trace)[first],
        at,
        _mechanics_columns(task.shape(alike, at)),
        np.maximum(task.values, 0.0),
        task,
    )


def _solve_through_time(task: Task, report: Report) -> Mechanics:
    """Mechanics along the run's own waveform, after that of a press to what was reached before it."""
    time = task.drive.time_s - task.drive.time_s[0]
    share = np.maximum(task.values, 0.0) / task.largest_drive
    kept = solved_samples(time, share, THINNING_TOLERANCE, MOST_WAVEFORM_POINTS - 3)
    lead_s, lead = _earlier_press(task)
    times_s, shares = np.append(lead_s[:-1], lead_s[-1] + time[kept]), np.append(lead[:-1], share[kept])
    waveform = Waveform.through(times_s, shares, each_solved=True)
    trace = _press_run(task, Press(**_press_target(task), waveform=waveform, load_steps=1), report).trace
    first = int(np.searchsorted(trace.time_s, lead_s[-1]))
    at, found = trace.time_s[first:] - lead_s[-1], _trace_columns(trace)[first:]
    found[:, 3:] -= found[0, 3:]  # what yield left before has leaked away
    alike = _mechanics_columns(task.shape(task.drive, task.values))
    known = np.column_stack([np.interp(at, time, column) for column in alike.T])
    return _interpolate_mechanics(found, at, known, time, task)


def _earlier_press(task: Task) -> tuple[Floats, Floats]:
    """Times (p,) and shares (p,) of a press to the largest drive before, and of a rest until all has relaxed."""
    if task.before <= 0.0:
        return np.zeros(1), np.zeros(1)
    viscosity = laws_of(task.model.physics.inelastic, Prony)
    times = [time for series in viscosity.values() for time in series.relaxation_times]
    rest_s = REST_IN_RELAXATION_TIMES * max(times, default=0.0)
    return np.array([0.0, 1.0, 2.0, 3.0 + rest_s]), np.array([0.0, task.before / task.largest_drive, 0.0, 0.0])


def _interpolate_mechanics(columns: Floats, at: Floats, known: Floats, asked: Floats, task: Task) -> Mechanics:
    """Mechanics at `asked` (t,), from columns (s, 3 + e) of the 3D model at (s,).

    known (s, 3 + e) : the elastic answer at the same places. Only the difference from it is interpolated.
    """
    difference = PchipInterpolator(at, columns - known)(np.clip(asked, at[0], at[-1]))
    path, force, area, *charge = (_mechanics_columns(task.fine(task.drive, task.values)) + difference).T
    if task.drive.by_depth:  # clear of the segment the dot follows the sensor
        path = np.where(task.values < 0.0, task.values, path)
    return Mechanics(path, np.maximum(force, 0.0), np.maximum(area, 0.0), np.column_stack(charge))


def _mechanics_columns(found: Mechanics) -> Floats:
    """Columns (t, 3 + e) of mechanics: path in mm, force, area and charges."""
    return np.column_stack([found.path_mm, found.force_N, found.area_m2, found.charge_C])


def _trace_columns(trace: Trace) -> Floats:
    """Columns (s, 3 + e) of a press: path in mm, force, area and charges."""
    force, area = trace.contact_force_N[:, 2], trace.contact_area_m2
    return np.column_stack([1e3 * trace.dot_path_m, force, area, trace.film_charge_C])
