"""A run by the 3D model itself: its drive as a waveform, its answer at the run's own times."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.engines.segment.drive import Drive
from diagnose.engines.segment.presses import ungapped
from diagnose.engines.segment.response import FilmPlate, Mechanics, shown
from diagnose.engines.segment.solved_times import knots
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

LOAD_STEPS = 8  # of a press in which time does not count
TOLERANCE = 0.002  # of the largest drive, by which the thinned drive may differ
MOST_POINTS = 199  # what a waveform file may have
RESTED = 10.0  # times the slowest relaxation
Shape = Callable[[Drive, Floats], Mechanics]


@dataclass(frozen=True)
class Task:
    """A run, its drive with values (t,) in mm or N, and the model with all mechanisms on its mesh.

    shape : the elastic answer of this mesh's table to any drive. Between the states of the 3D model only the
    difference from it is interpolated, which is smooth where force and charge bend. fine : the same of the table that
    is corrected by a finer mesh. before : the largest drive of earlier runs, in mm or N; 0 for none.
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
    def largest(self) -> float:
        """Of the drive, in this run and before, in mm or N."""
        return max(float(self.values.max()), self.before)


def solve(task: Task, report: Report) -> Signals:
    """Every answer of the run. NoEquilibriumError."""
    found = _through_time(task, report) if task.model.follows_time else _by_depth(task, report)
    # path, force and charge are those of the press itself: only the amplifier is still to come
    return shown(task.run, task.run.answers, task.drive, task.values, found, task.film, task.model)


def _press(task: Task, press: Press, report: Report) -> PressResult:
    """NoEquilibriumError where it stops short."""
    model = replace(ungapped(task.model), press=press, readout=None)
    result = press_segment(
        model, task.tet_mesh, lambda _, number, count: report(f"3D press of {task.run.label}", number, count)
    )
    if result.failure is not None:
        raise NoEquilibriumError(f"the 3D press of {task.run.label}: {result.failure}", np.zeros(0), None)
    return result


def _largest(task: Task) -> dict[str, float]:
    name = "indentation_mm" if task.drive.by_depth else "force_N"
    return {name: task.largest}


def _by_depth(task: Task, report: Report) -> Mechanics:
    """One press down; the run passes the same states, up and down."""
    trace = _press(task, Press(**_largest(task), load_steps=LOAD_STEPS), report).trace
    at = 1e3 * trace.indentation_m if task.drive.by_depth else trace.reaction_force_N
    at, first = np.unique(at, return_index=True)
    alike = Drive(np.arange(float(len(at))), at, task.drive.kind, np.ones(len(at), dtype=np.bool_))
    return _between(_columns(trace, task)[first], at, _of(task.shape(alike, at)), np.maximum(task.values, 0.0), task)


def _through_time(task: Task, report: Report) -> Mechanics:
    """Along the run's own waveform, after that of a press to what was reached before it."""
    time = task.drive.time_s - task.drive.time_s[0]
    share = np.maximum(task.values, 0.0) / task.largest
    kept = knots(time, share, TOLERANCE, MOST_POINTS - 3)
    lead_s, lead = _earlier_press(task)
    times_s, shares = np.append(lead_s[:-1], lead_s[-1] + time[kept]), np.append(lead[:-1], share[kept])
    waveform = Waveform.through(times_s, shares, each_solved=True)
    trace = _press(task, Press(**_largest(task), waveform=waveform, load_steps=1), report).trace
    first = int(np.searchsorted(trace.time_s, lead_s[-1]))
    at, found = trace.time_s[first:] - lead_s[-1], _columns(trace, task)[first:]
    found[:, 3:] -= found[0, 3:]  # what yield left before has leaked away
    alike = _of(task.shape(task.drive, task.values))
    known = np.column_stack([np.interp(at, time, column) for column in alike.T])
    return _between(found, at, known, time, task)


def _earlier_press(task: Task) -> tuple[Floats, Floats]:
    """Times (p,) and shares (p,) of a press to the largest drive before, and a rest until nothing relaxes any more."""
    if task.before <= 0.0:
        return np.zeros(1), np.zeros(1)
    viscosity = laws_of(task.model.physics.inelastic, Prony)
    times = [time for series in viscosity.values() for time in series.relaxation_times]
    rest_s = RESTED * max(times, default=0.0)
    return np.array([0.0, 1.0, 2.0, 3.0 + rest_s]), np.array([0.0, task.before / task.largest, 0.0, 0.0])


def _between(columns: Floats, at: Floats, known: Floats, asked: Floats, task: Task) -> Mechanics:
    """Columns (s, 3 + e) known at (s,), where the elastic answer is known (s, 3 + e), at what was asked for (t,)."""
    difference = PchipInterpolator(at, columns - known)(np.clip(asked, at[0], at[-1]))
    path, force, area, *charge = (_of(task.fine(task.drive, task.values)) + difference).T
    if task.drive.by_depth:  # clear of the segment the dot follows the sensor
        path = np.where(task.values < 0.0, task.values, path)
    return Mechanics(path, np.maximum(force, 0.0), np.maximum(area, 0.0), np.column_stack(charge))


def _of(found: Mechanics) -> Floats:
    """Path in mm, force, area and charges (t, 3 + e)."""
    return np.column_stack([found.path_mm, found.force_N, found.area_m2, found.charge_C])


def _columns(trace: Trace, task: Task) -> Floats:
    """Path in mm, force, area and charges (s, 3 + e) of a press, without the charge that the recorder adds."""
    charge = trace.film_charge_C - task.film.added_charge_C(trace.time_s, trace.contact_area_m2, task.model.physics)
    return np.column_stack([1e3 * trace.dot_path_m, trace.contact_force_N[:, 2], trace.contact_area_m2, charge])
