"""The presses from which the kernel of an array is made, and the table they fill.

One dot presses the array at the nodes of a grid, on a mesh coarser than the configured one; places that are mirror
images of each other are pressed once. Between the nodes the table is interpolated without overshoot (Akima, J. ACM 17,
1970, 589, as modified by MATLAB's makima), onto axes so fine that what reads it may interpolate linearly.
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise, product
from pathlib import Path

import numpy as np
from scipy.interpolate import Akima1DInterpolator, LinearNDInterpolator, NearestNDInterpolator, PchipInterpolator

from foundation.arrays import Floats
from foundation.cache import cache_folder, data_hash, read_arrays, write_arrays
from foundation.executor import Executor, completed_calls
from foundation.progress import Report
from foundation.source_hash import source_hash
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel
from softdot.arrays.presses import StoppedPressError
from softdot.config.hashes import input_hash
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from solve.result import PressResult

FINE_MM, FINE_STEPS = 0.1, 20
"""Spacing of the table in x and y at most, and its intervals over the depth."""


@dataclass(frozen=True)
class KernelDetail:
    """Fineness of a kernel.

    coarser : element sizes of its presses over the configured ones; steps : depths of each press at least; per_pitch :
    intervals of the grid from segment to segment.
    """

    coarser: float = 2.0
    steps: int = 4
    per_pitch: int = 6


USUAL_DETAIL = KernelDetail()
KEPT = ("depth_mm", "force_N", "charge_pC", "sinking_mm")


@dataclass(frozen=True)
class KernelPress:
    """One press of a kernel. depth_mm, force_N (s,); charge_pC (s, n); sinking_mm (s, p, q) of the resting surface at
    the nodes of the grid.

    failure : why it stopped, "" where it converged.
    """

    depth_mm: Floats
    force_N: Floats
    charge_pC: Floats
    sinking_mm: Floats
    failure: str = ""


@dataclass(frozen=True)
class KernelTask:
    """One press by the dot, or the cell of dots, of a configuration, and where its surface is asked for: axes in mm."""

    config: Config
    nodes_mm: tuple[tuple[float, ...], tuple[float, ...]]

    @property
    def where(self) -> str:
        """Words for the place of the press."""
        x, y = self.config.dot.offset_mm
        return f"the press at x = {x:.3g} mm, y = {y:.3g} mm"

    @property
    def press(self) -> PreparedPress:
        """The press that is solved."""
        return PreparedPress(self.config)


def one_dot_config(case: ArrayCase, x_mm: float, y_mm: float, detail: KernelDetail = USUAL_DETAIL) -> Config:
    """Configuration of a press of the kernel: on a coarser mesh, by one dot at a place in the frame of the array."""
    config = case.config
    names = ("element_size_mm", "contact_element_size_mm")
    sizes = {name: detail.coarser * getattr(config.mesh, name) for name in names}
    return config.model_copy(
        update={
            "dot": config.dot.lone(offset_mm=(x_mm, y_mm)),
            "mesh": config.mesh.model_copy(update=sizes),
            "press": config.press.model_copy(update={"load_steps": max(detail.steps, config.press.load_steps)}),
        }
    )


def recall(task: KernelTask) -> KernelPress | None:
    """The press of a task from the disk, None where it was not solved before."""
    return read_arrays(_path(task), lambda arrays: KernelPress(**{name: arrays[name] for name in KEPT}))


def solve_task(task: KernelTask) -> KernelPress:
    """Solve the press of a task; one that converges is kept. InputError, MeshingError."""
    found = _solve(task)
    _keep(task, found)
    return found


def _keep(task: KernelTask, found: KernelPress) -> None:
    if not found.failure:
        with suppress(OSError):  # a cache that cannot be written is no cache
            write_arrays(_path(task), {name: getattr(found, name) for name in KEPT})


def _path(task: KernelTask) -> Path:
    """The file in which the press of a task is kept."""
    return cache_folder() / f"kernel-{data_hash([source_hash(__name__), input_hash(task.config), task.nodes_mm])}.npz"


def _solve(task: KernelTask) -> KernelPress:
    result = task.press.solve()
    steps = result.steps
    return KernelPress(
        np.array([1e3 * step.indentation_m for step in steps]),
        np.array([step.reaction_force_N for step in steps]),
        np.array([1e12 * step.film_charge_C for step in steps]),
        np.array([sinking_mm(result, number, task.nodes_mm) for number in range(len(steps))]),
        result.failure or "",
    )


def sinking_mm(result: PressResult, step: int, nodes_mm: tuple[tuple[float, ...], tuple[float, ...]]) -> Floats:
    """Depth (p, q) in mm by which the surface that a dot can touch has sunk at the nodes of a grid."""
    fields = result.steps[step].fields
    xy = result.tet_mesh.points_mm[fields.contact_nodes, :2]
    sunk = -1e3 * fields.displacement_m[fields.contact_nodes, 2]
    for axis in result.planes:
        image = xy.copy()
        image[:, axis] *= -1.0
        xy, sunk = np.vstack([xy, image]), np.concatenate([sunk, sunk])
    at = np.array(list(product(*nodes_mm)))
    found = LinearNDInterpolator(xy, sunk)(at)
    outside = np.isnan(found)
    found[outside] = NearestNDInterpolator(xy, sunk)(at[outside])
    return np.asarray(found.reshape([len(axis) for axis in nodes_mm]))


def grid_mm(case: ArrayCase, axis: int, per_pitch: int = USUAL_DETAIL.per_pitch) -> tuple[float, ...]:
    """Nodes along x or y: over the segments and the gaps between them to the rim, and as far beyond as a dot touches.

    Beyond the rim none is pressed: the edge under the dot gives way at once, and the walls below it touch too.
    """
    middles = case.layout.centres(axis)
    edge, pitch = case.layout.half_mm[axis], case.layout.pitch_mm
    between = np.concatenate(
        [np.linspace(a, b, 1 + round(per_pitch * (b - a) / pitch)) for a, b in pairwise(middles)] or [middles]
    )
    outer = np.linspace(middles[-1], edge, 1 + max(2, round(per_pitch * (edge - middles[-1]) / pitch)))[1:]
    half = np.concatenate([between[between >= -1e-9], outer, [edge + reach_mm(case)]])
    return tuple(float(value) for value in np.unique(np.round(np.concatenate([-half, half]), 9) + 0.0))


def reach_mm(case: ArrayCase) -> float:
    """Half the width of the dot at the deepest level that the resting surface meets."""
    depth = case.config.press.indentation_mm or 0.0
    radius = case.press_over(case.layout.places[0]).dot.radius_mm
    return float(np.sqrt(depth * (2.0 * radius - depth)))


GridNode = tuple[int, int]


@dataclass(frozen=True)
class KernelGrid:
    """Nodes at which the array is pressed for a kernel, and how finely. nodes_mm : axes."""

    case: ArrayCase
    nodes_mm: tuple[tuple[float, ...], tuple[float, ...]]
    detail: KernelDetail

    def stands_for(self, index: GridNode) -> GridNode:
        """The node that is pressed for one, the last of its images."""
        return tuple(  # type: ignore[return-value]
            max(i, len(nodes) - 1 - i) if axis in self.case.mirrors else i
            for axis, (i, nodes) in enumerate(zip(index, self.nodes_mm, strict=True))
        )

    @property
    def all(self) -> list[GridNode]:
        """Numbers of every node at which a dot touches."""
        columns, rows = (range(1, len(nodes) - 1) for nodes in self.nodes_mm)
        return list(product(columns, rows))

    def tasks(self) -> dict[GridNode, KernelTask]:
        """The presses that are solved, by their nodes."""
        x, y = self.nodes_mm
        return {
            (i, j): KernelTask(one_dot_config(self.case, x[i], y[j], self.detail), self.nodes_mm)
            for i, j in dict.fromkeys(map(self.stands_for, self.all))
        }

    def image(self, index: GridNode, press: KernelPress) -> KernelPress:
        """The press at a node from the one that stands for it."""
        rows, columns = len(self.case.layout.centres(1)), len(self.case.layout.centres(0))
        charge = press.charge_pC.reshape(-1, rows, columns)
        sinking = press.sinking_mm
        for axis, (own, other) in enumerate(zip(index, self.stands_for(index), strict=True)):
            if own != other:
                charge, sinking = np.flip(charge, 2 - axis), np.flip(sinking, 1 + axis)
        return KernelPress(press.depth_mm, press.force_N, charge.reshape(len(charge), -1), sinking)


def grid_of(case: ArrayCase, detail: KernelDetail = USUAL_DETAIL) -> KernelGrid:
    """The grid of nodes over an array."""
    return KernelGrid(case, (grid_mm(case, 0, detail.per_pitch), grid_mm(case, 1, detail.per_pitch)), detail)


def solve_all(tasks: Mapping[str, KernelTask], report: Report, executor: Executor) -> dict[str, KernelPress]:
    """Solve each task. StoppedPressError for one that does not converge; the others are kept."""
    found = {name: press for name, task in tasks.items() if (press := recall(task)) is not None}
    left = {name: (task,) for name, task in tasks.items() if name not in found}
    for name, future in completed_calls(executor, solve_task, left):
        press = future.result()
        if press.failure:
            raise StoppedPressError(f"{tasks[name].where} did not converge: {press.failure}")
        _keep(tasks[name], press)
        found[name] = press
        report(name, len(found), len(tasks))
    return found


def fill_kernel(grid: KernelGrid, presses: Mapping[GridNode, KernelPress]) -> ArrayKernel:
    """The kernel of these presses, with nothing said of it yet."""
    shape, first = [len(nodes) for nodes in grid.nodes_mm], next(iter(presses.values()))
    depth, count = first.depth_mm, first.charge_pC.shape[1]
    values = np.zeros((*shape, len(depth), count + 1))
    sinking = np.zeros((*shape, len(depth), *shape))
    for index in grid.all:
        press = grid.image(index, presses[grid.stands_for(index)])
        values[index] = np.column_stack([press.charge_pC, press.force_N])
        sinking[index] = press.sinking_mm
    axes = [_fine(nodes) for nodes in grid.nodes_mm]
    deep = np.linspace(0.0, depth[-1], FINE_STEPS + 1)
    table = PchipInterpolator(depth, values, axis=2)(deep)
    for axis, (nodes, fine) in enumerate(zip(grid.nodes_mm, axes, strict=True)):
        table = Akima1DInterpolator(nodes, table, axis=axis, method="makima")(fine)
    force = np.maximum(table[..., -1], 0.0)
    x, y = (np.array(nodes) for nodes in grid.nodes_mm)
    return ArrayKernel(axes[0], axes[1], deep, table[..., :-1], force, x, y, depth, sinking, {})


def _fine(nodes: tuple[float, ...]) -> Floats:
    """Even nodes between the first and the last, at most FINE_MM apart."""
    count = int(np.ceil((nodes[-1] - nodes[0]) / FINE_MM - 1e-9))
    return np.linspace(nodes[0], nodes[-1], count + 1)
