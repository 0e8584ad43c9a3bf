"""One design: its kernel, coarse enough to be made in minutes, and the least force at which it reads a text.

The depth is bisected, in its logarithm, between the deepest that the kernel allows and a tenth of it. At each depth the
text is read as often as asked; the depth suffices where the share of right characters, of all repeats together, is at
least the accuracy. Force grows with depth, so that the least depth has the least force.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnose.statistics.proportions import wilson_interval
from foundation.arrays import Floats
from foundation.errors import InputError
from mesh.types import MeshingError
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel
from softdot.arrays.kernel_errors import with_about
from softdot.arrays.kernel_presses import KernelDetail, KernelPress, fill_kernel, grid_of, recall, solve_task
from softdot.config.hashes import config_hash
from softdot.config.schema import Config
from softdot.progress import Untold
from softdot.reading.cells import cells_of, text_of
from softdot.reading.conditions import ReadingConditions
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.kernels import check_kernel, readout_of
from softdot.reading.line_reading import LineReading, read_line
from softdot.reading.motion import dots_near
from softdot.reading.score import scores
from softdot.version import installed_version

COARSE_KERNEL = KernelDetail(coarser=4.0, steps=3, per_pitch=2)
"""20 presses for a cell of six. docs/design_by_reading.md compares it with the usual kernel."""
LEAST_DEPTH_SHARE, BISECTIONS = 0.1, 5
"""Least depth as a share of the deepest one, and number of bisections, which give the least depth to 8 %."""
FORCE_STRIDE = 5
"""Stride through the states of a path for its force."""


@dataclass(frozen=True)
class DesignTask:
    """One design and the reading that is asked of it. decoder : its name. conditions : without a depth."""

    config: Config
    conditions: ReadingConditions
    text: str
    table: str | None
    decoder: str
    repeats: int
    accuracy: float


class StoppedDesignError(RuntimeError):
    """Raised where a press of a design's kernel did not converge, with place and reason."""


def design_record(task: DesignTask) -> dict[str, Any]:
    """The record of a design: status as of a point of a sweep, readings by depth, and the least of these.

    Raises nothing. readings : each with depth, right characters, all characters, force, and crosstalk. least : the one
    with the least depth at which enough characters are read, None where there is none.
    """
    begun = time.perf_counter()
    try:
        kernel = coarse_kernel(task.config)
        pressed_s = time.perf_counter() - begun
        found: dict[str, Any] = {"status": "solved", "reason": None, **least_force(kernel, task)}
    except InputError as error:
        return _failure_record("refused", str(error), begun)
    except (StoppedDesignError, MeshingError) as error:
        return _failure_record("not-converged", str(error), begun)
    except Exception as error:
        return _failure_record("crashed", f"{type(error).__name__}: {error}", begun)
    seconds = time.perf_counter() - begun
    return {**found, "kernel_s": pressed_s, "reading_s": seconds - pressed_s, "seconds": seconds}


def _failure_record(status: str, reason: str, begun: float) -> dict[str, Any]:
    nothing: dict[str, Any] = {"readings": [], "least": None, "seconds": time.perf_counter() - begun}
    return {"status": status, "reason": " ".join(reason.split()), **nothing}


def coarse_kernel(config: Config, detail: KernelDetail = COARSE_KERNEL) -> ArrayKernel:
    """The kernel of a design by one process; presses that were solved before are taken from the cache.

    InputError for a design that cannot be built or read with, StoppedDesignError, MeshingError.
    """
    case = ArrayCase(config)
    case.warnings  # noqa: B018 - refuses
    case.refuse_kernel()
    grid = grid_of(case, detail)
    presses: dict[tuple[int, int], KernelPress] = {}
    for node, task in grid.tasks().items():
        presses[node] = recall(task) or solve_task(task)
        if presses[node].failure:
            raise StoppedDesignError(f"{task.where} did not converge: {presses[node].failure}")
    said = {
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "config": config.model_dump(mode="json"),
    }
    kernel = with_about(fill_kernel(grid, presses), case, case.capacitance_pF, [], said)
    return check_kernel(kernel, "the kernel of this design")


def least_force(kernel: ArrayKernel, task: DesignTask) -> dict[str, Any]:
    """The readings by depth and the least of them, as in design_record. InputError."""
    deepest = (
        replace(task.conditions, force_N=1.0).with_implied_values(kernel).depth_mm
    )  # that of the stop, at any force
    assert deepest is not None
    readings: list[dict[str, Any]] = []
    for depth_mm in depths(deepest, readings, task.accuracy):
        readings.append(reading_at(kernel, task, depth_mm))
    good = [one for one in readings if one["accuracy"] >= task.accuracy]
    least = min(good, key=lambda one: one["depth_mm"], default=None)
    return {"readings": sorted(readings, key=lambda one: one["depth_mm"]), "least": least}


def depths(deepest: float, readings: list[dict[str, Any]], accuracy: float) -> Iterator[float]:
    """The deepest depth, and then the next ones by the last reading. readings : appended by the caller in between."""
    yield deepest
    low, high = LEAST_DEPTH_SHARE * deepest, deepest
    if readings[-1]["accuracy"] < accuracy:
        return
    for _ in range(BISECTIONS):
        middle = float(np.sqrt(low * high))
        yield middle
        low, high = (low, middle) if readings[-1]["accuracy"] >= accuracy else (middle, high)


def reading_at(kernel: ArrayKernel, task: DesignTask, depth_mm: float) -> dict[str, Any]:
    """The reading of the text at one depth: characters with Wilson's 95 % interval, force, crosstalk. InputError.

    Repeats end where the others cannot lift the share of the characters to the accuracy any more.
    """
    cells = cells_of(task.text, task.table)
    length = len(text_of(cells, task.table))
    right, of, forces = 0, 0, []
    for number in range(task.repeats):
        conditions = replace(task.conditions, depth_mm=depth_mm, seed=task.conditions.seed + number)
        of += length
        try:
            reading = read_line(kernel, readout_of(kernel, None), conditions, [task.decoder], Untold(), cells)
        except NoDotError:  # nothing stands out of the noise
            break
        right += scores(cells, reading.first.cells, task.table)["character_accuracy"]["right"]
        forces.append(forces_N(kernel, reading))
        if of - right > (1.0 - task.accuracy) * length * task.repeats:
            break  # whatever the other repeats give, too few are read
    low, high = wilson_interval(right, of)
    force = np.concatenate(forces) if forces else None
    return {
        "depth_mm": depth_mm,
        "right": right,
        "of": of,
        "accuracy": right / of,
        "low": low,
        "high": high,
        "mean_force_N": None if force is None else float(force.mean()),
        "peak_force_N": None if force is None else float(force.max()),
        "crosstalk_percent": crosstalk_percent(kernel, depth_mm),
    }


def forces_N(kernel: ArrayKernel, reading: LineReading) -> Floats:
    """Force (t,) on all dots of the line, while the array's middle is between its first cell and its last."""
    path, line = reading.path, reading.line
    assert path is not None
    assert line is not None
    begin, end = np.searchsorted(path.time_s, [path.reached_s.min(), path.reached_s.max()])
    span = slice(int(begin), max(int(end), int(begin) + 1), FORCE_STRIDE)
    return kernel.of_many(*dots_near(kernel, line, path, span))[1]


def crosstalk_percent(kernel: ArrayKernel, depth_mm: float) -> float:
    """Largest open-circuit voltage of a segment over that of another one, above the middle of which a dot presses."""
    x, y = kernel.centres_mm.T
    voltage = kernel.of_one(x, y, np.full(len(x), depth_mm))[0] / kernel.capacitance_pF
    share = np.abs(voltage / np.diagonal(voltage)[:, None])
    return float(100.0 * share[~np.eye(len(x), dtype=bool)].max(initial=0.0))
