"""A word under a sliding array with friction: one path of equilibria of the whole array, solved by finite elements.

    python -m benchmarks.reading_slides examples/array-cell.toml OUT.npz --text by --friction 0.3

All dots of the line are one rigid body that is dragged under the array at one depth, on elements and at an offset that
are none of a kernel's. The rim of the array is rounded as a fingertip's is: within RIM_MM of an end a dot presses less
by a parabola, and clears the surface at the very end, so that it enters and leaves without a sharp edge.
OUT.npz is as that of benchmarks.reading_in_full, for benchmarks.reading_table.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.reading_in_full import line_mm
from foundation.arrays import Floats
from geometry.dot_size import DEFAULT_STANDARD
from mesh.array.mesh import array_mesh
from softdot.arrays.case import ArrayCase
from softdot.config.loading import load_config
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from solve.mechanisms import Mechanism
from solve.model import Press
from solve.recorder import Recorder
from solve.result import Step
from solve.setup import Setup, discretise
from solve.solution.linear import LinearSolver
from solve.solution.march import march, rest_state
from solve.solution.schedule import Target
from solve.system import Load
from solve.terms.contact import ContactFacets
from solve.terms.friction import FrictionalContact
from solve.terms.rigid_dot import RigidDot

SIZES = {"element_size_mm": 1.5, "film_element_size_mm": 0.9, "contact_element_size_mm": 0.45}
RIM_MM, CLEAR_MM = 0.7, 0.05
"""Length of the rounded rim; how far a dot stays clear of the surface at the very end."""
BESIDE_MM = 0.4
"""Of the first dot from the array when the slide begins, and of the last when it ends."""


@dataclass(frozen=True)
class DraggedDots(RigidDot):
    """Dots that rise from the array near its ends. half_mm : of the array along x; drop_mm : at the very end."""

    half_mm: float
    drop_mm: float

    def distance(self, points: Floats, move: Floats) -> tuple[Floats, Floats, Floats]:
        """As RigidDot, of those dots that are over the array, each as high as its place says."""
        x = self.shape.origin_mm[0] + self.shape.tips_mm[:, 0] + move[0] * self.unit_mm
        into = np.clip((np.abs(x) - self.half_mm + RIM_MM) / RIM_MM, 0.0, None)
        near = into < 1.5
        tips = self.shape.tips_mm + np.column_stack([np.zeros((len(x), 2)), self.drop_mm * into**2])
        far_away = np.array([[1e3, 0.0, 0.0]])
        over = RigidDot(replace(self.shape, tips_mm=tips[near] if near.any() else far_away), self.unit_mm)
        return over.distance(points, move)


@dataclass(frozen=True)
class Slide:
    """The array's middle at each x (n,) along the line, which has dots at places (d, 2)."""

    config: Config
    places_mm: Floats
    x_mm: Floats
    offset_mm: float

    def setup(self) -> Setup:
        """The discretised press, fine along the rows of dots, with the dragged dots in its contact."""
        case = ArrayCase(self.config)
        half = case.layout.half_mm[0]
        rows = np.unique(np.round(self.places_mm[:, 1] - self.offset_mm, 9))
        one = self.config.dot.lone(offset_mm=(0.0, float(rows[0])))
        press = PreparedPress(self.config.model_copy(update={"dot": one}))
        along = np.arange(-half, half + 0.2, 0.4)
        passed = np.array([[x, row - rows[0], 0.0] for row in rows for x in along])
        mesh = array_mesh(case.layout, replace(press.dot, tips_mm=passed), self.config.mesh, ())
        setup = discretise(press.model, mesh, press.dot)
        flat = self.places_mm - [self.x_mm[0], self.offset_mm + rows[0]]
        shape = replace(press.dot, tips_mm=np.column_stack([flat, np.zeros(len(flat))]))
        drop = self.config.press.depth_mm + CLEAR_MM
        return touched_by(setup, DraggedDots(shape, 1e3 * setup.system.units.length, half, drop))

    def steps(self, setup: Setup) -> Iterator[Step]:
        """Converged states at all x; the first is clear of all dots. RuntimeError."""
        system, unit_mm = setup.system, 1e3 * setup.system.units.length
        depth, linear = self.config.press.depth_mm / unit_mm, LinearSolver(setup.system.factorisation_shift)
        targets = [
            Target(float(number), Load((float(self.x_mm[0] - x) / unit_mm, 0.0), depth), number < 2)
            for number, x in enumerate(self.x_mm)
        ]
        past = [rest_state(system, linear, targets[0])]
        setup.recorder.start(past[0])
        yield setup.recorder.steps[-1]
        for target, x in zip(targets[1:], self.x_mm[1:], strict=True):
            failure = march(system, linear, past, target, target.kink, setup.recorder.record)
            if failure is not None:
                raise RuntimeError(f"before x = {x:.2f} mm: {failure}")
            setup.recorder.report()
            yield setup.recorder.steps[-1]


def touched_by(setup: Setup, dots: RigidDot) -> Setup:
    """The same press by other dots."""
    contact = replace(setup.system.contact, dot=dots)

    def exchanged(term: object) -> object:
        if isinstance(term, FrictionalContact):
            return replace(term, contact=contact)
        return contact if isinstance(term, ContactFacets) else term

    system = replace(setup.system, contact=contact, terms=tuple(map(exchanged, setup.system.terms)))
    model = setup.model
    recorder = Recorder(system, setup.tet_mesh, model.physics, model.segment, model.materials)
    return replace(setup, system=system, recorder=recorder)


def slide_of(chosen: argparse.Namespace) -> tuple[Slide, str]:
    """What is asked for, and the cells of the line."""
    config = load_config(chosen.config, chosen.set)
    cells, places, _ = line_mm(chosen.text, config.dot.standard or DEFAULT_STANDARD)
    slips = Mechanism(name="friction", component="dot", parameters={"coefficient": chosen.friction})
    update = {
        "mesh": config.mesh.model_copy(update=SIZES),
        "press": Press(indentation_mm=chosen.depth_mm),
        "mechanisms": (slips,) if chosen.friction else (),
    }
    config = config.model_copy(update=update)
    beside = ArrayCase(config).layout.half_mm[0] + BESIDE_MM
    first, last = places[:, 0].min() - beside, places[:, 0].max() + beside
    x_mm = np.linspace(first, last, 1 + int(np.ceil((last - first) / chosen.step_mm)))
    return Slide(config, places, x_mm, chosen.offset_mm), cells


def main() -> None:
    """Drag the line under the array and write what each segment gave."""
    asked = argparse.ArgumentParser()
    asked.add_argument("config", type=Path)
    asked.add_argument("out", type=Path)
    asked.add_argument("--text", required=True)
    asked.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    asked.add_argument("--step-mm", type=float, default=0.2)
    asked.add_argument("--depth-mm", type=float, default=0.225)
    asked.add_argument("--friction", type=float, default=0.3)
    asked.add_argument("--offset-mm", type=float, default=0.15, help="of the array across the line")
    chosen = asked.parse_args()
    slide, cells = slide_of(chosen)
    setup, steps, begun = slide.setup(), [], time.perf_counter()
    print(f"{setup.system.count} unknowns", flush=True)
    for x, step in zip(slide.x_mm, slide.steps(setup), strict=True):
        steps.append(step)
        seconds = time.perf_counter() - begun
        print(
            f"{len(steps)} of {len(slide.x_mm)}: x = {x:.2f} mm, {step.reaction_force_N:.3f} N, {seconds:.0f} s",
            flush=True,
        )
    np.savez(
        chosen.out,
        x_mm=slide.x_mm,
        depth_mm=np.full((len(steps), 1), chosen.depth_mm),
        charge_pC=np.array([[1e12 * step.film_charge_C] for step in steps]),
        force_N=np.array([[step.reaction_force_N] for step in steps]),
        cells=cells,
        text=chosen.text,
        slide=True,
        offset_mm=chosen.offset_mm,
        friction=chosen.friction,
        solve_s=time.perf_counter() - begun,
    )


if __name__ == "__main__":
    main()
