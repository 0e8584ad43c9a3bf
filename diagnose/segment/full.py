"""A run by the 3D model itself: its drive as a waveform, its answer at the run's own times."""

import csv
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.forward import Report, Signals
from diagnose.recording import Run
from diagnose.segment.answer import FilmPlate, Mechanics, other_charge, shown
from diagnose.segment.drive import Drive
from diagnose.segment.knots import knots
from diagnose.segment.prepared import ungapped
from geometry.dot import resolve_dot
from geometry.processes import scratch_folder
from mesh.types import Floats, TetMesh
from solve.model import Model
from solve.parameters import Press, Waveform
from solve.press import press_segment
from solve.result import PressResult, Trace
from solve.solution.newton import NoEquilibriumError

LOAD_STEPS = 8  # of a press in which time does not count
TOLERANCE = 0.002  # of the largest drive, by which the thinned drive may differ
MOST_POINTS = 199  # what a waveform file may have
WAVEFORM = "drive.csv"
Shape = Callable[[Drive, Floats], Mechanics]


@dataclass(frozen=True)
class Task:
    """A run, its drive with values (t,) in mm or N, and the model with all mechanisms on its mesh.

    shape : the elastic answer of this mesh's table to any drive. Between the states of the 3D model only the
    difference from it is interpolated, which is smooth where force and charge bend. fine : the same of the table that
    is corrected by a finer mesh.
    """

    run: Run
    drive: Drive
    values: Floats
    model: Model
    tet_mesh: TetMesh
    film: FilmPlate
    shape: Shape
    fine: Shape


def solve(task: Task, report: Report) -> Signals:
    """Every answer of the run. NoEquilibriumError."""
    found = _through_time(task, report) if task.model.follows_time else _by_depth(task, report)
    # path, force and charge are those of the press itself: only the amplifier is still to come
    return shown(task.run, task.run.answers, task.drive, task.values, found, task.film, task.model)


def _press(task: Task, press: Press, report: Report) -> PressResult:
    """NoEquilibriumError where it stops short."""
    model, dot = task.model, resolve_dot(ungapped(task.model).dot, task.model.segment)
    result = press_segment(
        model.segment, model.materials, dot, press, task.tet_mesh,
        lambda _, number, count: report(f"3D press of {task.run.label}", number, count), model.physics,
    )  # fmt: skip
    if result.failure is not None:
        raise NoEquilibriumError(f"the 3D press of {task.run.label}: {result.failure}", np.zeros(0), None)
    return result


def _largest(task: Task) -> dict[str, float]:
    name = "indentation_mm" if task.drive.by_depth else "force_N"
    return {name: float(task.values.max())}


def _by_depth(task: Task, report: Report) -> Mechanics:
    """One press down; the run passes the same states, up and down."""
    trace = _press(task, Press(**_largest(task), load_steps=LOAD_STEPS), report).trace
    at = 1e3 * trace.indentation_m if task.drive.by_depth else trace.reaction_force_N
    at, first = np.unique(at, return_index=True)
    alike = Drive(np.arange(float(len(at))), at, task.drive.kind, np.ones(len(at), dtype=np.bool_))
    return _between(_columns(trace, task)[first], at, _of(task.shape(alike, at)), np.maximum(task.values, 0.0), task)


def _through_time(task: Task, report: Report) -> Mechanics:
    """Along the run's own waveform."""
    time = task.drive.time_s - task.drive.time_s[0]
    share = np.maximum(task.values, 0.0) / task.values.max()
    kept = knots(time, share, TOLERANCE, MOST_POINTS)
    with scratch_folder() as folder:
        path = folder / WAVEFORM
        with path.open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows([("time_s", "fraction"), *zip(time[kept], share[kept], strict=True)])
        press = Press(**_largest(task), waveform=Waveform(shape="file", file=str(path)))
        trace = _press(task, press, report).trace
    alike = _of(task.shape(task.drive, task.values))
    known = np.column_stack([np.interp(trace.time_s, time, column) for column in alike.T])
    return _between(_columns(trace, task), trace.time_s, known, time, task)


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
    """The same of a press, without the charge of heat and touch that the recorder has added."""
    charge = trace.film_charge_C - other_charge(trace.time_s, trace.contact_area_m2, task.film, task.model)
    return np.column_stack([1e3 * trace.dot_path_m, trace.contact_force_N[:, 2], trace.contact_area_m2, charge])
