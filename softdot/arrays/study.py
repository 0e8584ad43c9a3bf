"""The whole study of an array: its crosstalk, what stands for one of its segments, and the press of a cell."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy.interpolate import PchipInterpolator

from foundation.arrays import Floats
from foundation.executor import Executor
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel
from softdot.arrays.kernel_errors import KernelCheck, kernel_of
from softdot.arrays.matrix import CrosstalkMatrix, crosstalk, matrix_presses
from softdot.arrays.presses import ArrayPresses, Signals
from softdot.arrays.roles import representatives
from softdot.arrays.side_stiffness import EffectiveSides, effective_sides, lone_presses, lone_sides
from softdot.arrays.variants import Worth, variant_presses, worth
from softdot.prepared_press import PreparedPress
from softdot.progress import Progress
from solve.result import PressResult

Part = Literal["variants", "kernel"]


@dataclass(frozen=True)
class CellPress:
    """Press by all dots of a cell on one plate, beside the sum of the presses of each of them alone.

    superposed_pC : (s, n) sum of the charges of single dots at the same depth; NaN where one was not pressed so deep.
    """

    cell: str
    signals: Signals
    superposed_pC: Floats

    @property
    def errors_percent(self) -> Floats:
        """Error (n,) of superposition at full load, of the largest charge."""
        charge = self.signals.charge_pC[-1]
        return np.asarray(100.0 * (self.superposed_pC[-1] - charge) / np.abs(charge).max())

    def summary(self) -> dict[str, Any]:
        """The part of array.json that the cell gives."""
        return {
            "cell": self.cell,
            "indentation_mm": self.signals.depth_mm,
            "reaction_force_N": self.signals.force_N,
            "charge_pC": self.signals.charge_pC[-1],
            "voltage_V": self.signals.voltage_V[-1],
            "superposed_charge_pC": self.superposed_pC[-1],
            "superposition_error_percent": self.errors_percent,
        }


@dataclass(frozen=True)
class ArrayStudy:
    """All results of an array. shown : the press whose fields are drawn and written, with its result and its title.

    kernel, checks : where they were asked for, the kernel and its errors beside presses of the whole array.
    """

    matrix: CrosstalkMatrix
    sides: dict[str, EffectiveSides]
    cell: CellPress | None
    variants: list[Worth]
    shown: PreparedPress
    result: PressResult
    shown_title: str
    kernel: ArrayKernel | None
    checks: list[KernelCheck]


def study(case: ArrayCase, executor: Executor, progress: Progress, parts: frozenset[Part]) -> ArrayStudy:
    """Solve everything by an executor; parts : what is asked for beside the matrix.

    StoppedPressError where a press does not converge, InputError; of a kernel MeshingError too.
    """
    place = case.layout.places[next(iter(representatives(case.layout).values()))]
    by_cell = case.config.dot.cell is not None
    number = case.layout.places.index(place)
    shown = case.press_by_cell() if by_cell else case.press_over(case.layout.places[min(case.images(number))])
    title = f"The cell {case.config.dot.cell}" if by_cell else f"A dot over {place.label}"
    solve = ArrayPresses(executor, progress.step)
    progress.stage("presses")
    result = solve.with_fields(shown, title, _known_presses(case, parts))
    matrix = crosstalk(case, solve)
    cell = _cell_press(case, matrix, solve) if by_cell else None
    progress.stage("sides")
    sides = effective_sides(matrix, solve)
    variants = worth(case, solve) if "variants" in parts else []
    found = ArrayStudy(matrix, sides, cell, variants, shown, result, title, None, [])
    if "kernel" not in parts:
        return found
    progress.stage("kernel")
    told = progress.step
    kernel, checks = kernel_of(case, matrix, lambda name, done, count: told(done, count, name), executor)
    return replace(found, kernel=kernel, checks=checks)


def _known_presses(case: ArrayCase, parts: frozenset[Part]) -> dict[str, PreparedPress]:
    """Presses that are solved whatever comes out, in one go, so that no core waits in between."""
    presses = {**matrix_presses(case), **lone_presses(case, lone_sides(case.layout))}
    return {**presses, **variant_presses(case)[0]} if "variants" in parts else presses


def _cell_press(case: ArrayCase, matrix: CrosstalkMatrix, solve: ArrayPresses) -> CellPress:
    cell = case.config.dot.cell or ""
    (found,) = solve({f"the press of the cell {cell}": case.press_by_cell()}).values()
    alone = [
        PchipInterpolator(matrix.depth_mm[i], matrix.charge_pC[i], extrapolate=False)(found.depth_mm)
        for i in case.under_dots().values()
    ]
    return CellPress(cell, found, np.sum(alone, axis=0))
