"""How far a kernel is from the whole array.

Presses that took no part in it are solved as a whole and laid beside it at all their load steps. The error of the
charges is the largest difference of any segment, of the largest charge of that press; that of the force is relative to
its last one.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from foundation.arrays import Floats
from foundation.executor import HERE, Executor
from foundation.progress import Report
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel
from softdot.arrays.kernel_checks import check_presses
from softdot.arrays.kernel_presses import KernelTask, fill_kernel, grid_of, solve_all
from softdot.arrays.matrix import CrosstalkMatrix
from softdot.config.schema import Config

MESH = "the same press on the configured mesh"


@dataclass(frozen=True)
class KernelCheck:
    """One press beside the kernel. dots : how many; x_mm, y_mm : of the first one."""

    what: str
    dots: int
    x_mm: float
    y_mm: float
    depth_mm: float
    charge_percent: float
    force_percent: float


def check(
    kernel: ArrayKernel, what: str, places_mm: Floats, depth_mm: Floats, charge_pC: Floats, force_N: Floats
) -> KernelCheck:
    """Lay a press (s,) by dots at places (k, 2) beside the kernel."""
    shape = (len(depth_mm), len(places_mm))
    x, y = (np.broadcast_to(places_mm[:, axis], shape) for axis in (0, 1))
    charge, force = kernel.of_many(x, y, np.broadcast_to(depth_mm[:, None], shape))
    return KernelCheck(
        what,
        len(places_mm),
        float(places_mm[0, 0]),
        float(places_mm[0, 1]),
        float(depth_mm[-1]),
        float(100.0 * np.abs(charge - charge_pC).max() / np.abs(charge_pC).max()),
        float(100.0 * np.abs(force - force_N).max() / np.abs(force_N).max()),
    )


def measure_errors(
    kernel: ArrayKernel, presses: Mapping[str, Config], report: Report, executor: Executor = HERE
) -> list[KernelCheck]:
    """Solve presses and lay them beside the kernel; the errors of each. StoppedPressError."""
    tasks = {name: KernelTask(config, ((0.0,), (0.0,))) for name, config in presses.items()}
    solved = solve_all(tasks, report, executor)
    return [
        check(kernel, name, dot_places_mm(task), solved[name].depth_mm, solved[name].charge_pC, solved[name].force_N)
        for name, task in tasks.items()
    ]


def dot_places_mm(task: KernelTask) -> Floats:
    """Places (k, 2) in mm of the dots of a press."""
    dot = task.press.dot
    return np.asarray(dot.origin_mm[:2] + dot.tips_mm[:, :2])


def beside_matrix(kernel: ArrayKernel, matrix: CrosstalkMatrix) -> list[KernelCheck]:
    """Errors of the kernel beside the presses of the matrix, which are on the configured mesh."""
    case = matrix.case
    found = []
    for number in matrix.solved:
        place, press = case.layout.places[number], matrix.press(number)
        at = np.array([[place.x_mm, place.y_mm]]) + case.config.dot.offset_mm
        found.append(check(kernel, f"{place.label}, {MESH}", at, press.depth_mm, press.charge_pC, press.force_N))
    return found


def kernel_of(
    case: ArrayCase, matrix: CrosstalkMatrix, report: Report, executor: Executor = HERE
) -> tuple[ArrayKernel, list[KernelCheck]]:
    """The kernel of an array with its errors; about is left to be filled. StoppedPressError."""
    grid = grid_of(case)
    tasks = grid.tasks()
    x, y = grid.nodes_mm
    names = {f"a dot at {x[i]:.2f}, {y[j]:.2f} mm": (i, j) for i, j in tasks}
    presses = solve_all({name: tasks[index] for name, index in names.items()}, report, executor)
    kernel = fill_kernel(grid, {names[name]: press for name, press in presses.items()})
    return kernel, [*measure_errors(kernel, check_presses(case), report, executor), *beside_matrix(kernel, matrix)]


UNITS = {
    "x_mm, y_mm": "place of the dot's tip, the middle of the array is the origin",
    "depth_mm": "of the tip below the resting top of the array",
    "charge_pC": "[x, y, depth, segment]",
    "force_N": "[x, y, depth]",
    "place_x_mm, place_y_mm, load_mm": "axes of sinking_mm: place and depth of a dot, place of the surface",
    "sinking_mm": "[x, y, depth, x, y] of the surface beside a dot",
}


def with_about(
    kernel: ArrayKernel, case: ArrayCase, capacitance_pF: Floats, checks: list[KernelCheck], said: Mapping[str, object]
) -> ArrayKernel:
    """The kernel with the content of kernel.json: where the segments are, the dot, units, and the errors; said : what
    the command adds.
    """
    layout, dot = case.layout, case.press_over(case.layout.places[0]).dot
    about = {
        "labels": [place.label for place in layout.places],
        "centres_mm": layout.middles.tolist(),
        "size_mm": list(layout.size_mm),
        "pitch_mm": layout.pitch_mm,
        "capacitance_pF": capacitance_pF.tolist(),
        "standard": case.config.dot.standard,
        "dot": {
            "radius_mm": dot.radius_mm,
            "height_mm": dot.height_mm,
            "base_diameter_mm": dot.base_diameter_mm,
        },
        "units": UNITS,
        "kernel_error": worst(checks) if checks else None,
        "checks": [vars(one) for one in checks],
        **said,
    }
    return replace(kernel, about=about)


def worst(checks: list[KernelCheck]) -> dict[str, float]:
    """Largest errors of all presses in percent, of force and charge."""
    return {
        "force_percent": max(one.force_percent for one in checks),
        "charge_percent": max(one.charge_percent for one in checks),
    }
