"""A text read from voltages that no kernel made: every state is a press of the whole array, solved by finite elements.

    python -m benchmarks.reading_in_full FOLDER OUT.npz --text by --slide
    python -m benchmarks.reading_in_full FOLDER OUT.npz --text "dots read" --friction 0.3

FOLDER holds the kernel of softdot array --kernel, for its design and standard alone. Without --slide the array is set
down on each cell, with Coulomb friction where asked for. With --slide the array is at places along the line, one press
each: without friction a slide passes through the same equilibria. Places, elements and depth are none of the kernel's.
OUT.npz holds place, depth and charges; softdot read --recording decodes the voltages that benchmarks.reading_table
makes of them.
"""

import argparse
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from foundation.executor import LocalProcesses, completed_calls
from foundation.thread_pools import usable_cores
from geometry.braille_cells import dot_offset_mm, raised_dots
from geometry.braille_standards import standard
from mesh.array.mesh import array_mesh
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import load_kernel
from softdot.braille_text.lines import translate
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from solve.mechanisms import Mechanism
from solve.press import press_segment

ELEMENT_MM, CONTACT_MM, STEPS = 0.9, 0.27, 3
REACH_MM = 0.9
"""Dots farther than this outside the array cannot touch it."""


@dataclass(frozen=True)
class FullPress:
    """The array's middle at x along the line, on dots (k, 2) that are given in its own frame."""

    config: Config
    x_mm: float
    dots_mm: Floats


def charges(press: FullPress) -> tuple[float, Floats, Floats, Floats]:
    """x, and depth (s,), charges (s, n), force (s,)."""
    count = len(ArrayCase(press.config).layout.places)
    if not len(press.dots_mm):
        return press.x_mm, np.zeros(1), np.zeros((1, count)), np.zeros(1)
    x, y = (float(v) for v in press.dots_mm[0])
    one = press.config.dot.lone(offset_mm=(x, y))
    case = ArrayCase(press.config)
    made = PreparedPress(press.config.model_copy(update={"dot": one}))
    tips = np.column_stack([press.dots_mm - press.dots_mm[0], np.zeros(len(press.dots_mm))])
    dot = replace(made.dot, tips_mm=tips)  # all dots of the line, not of one cell
    result = press_segment(made.model, array_mesh(case.layout, dot, press.config.mesh, ()), dot=dot)
    if result.failure is not None:
        raise RuntimeError(f"x = {press.x_mm:.3g} mm: {result.failure}")
    steps = result.steps
    return (
        press.x_mm,
        np.array([1e3 * s.indentation_m for s in steps]),
        np.array([1e12 * s.film_charge_C for s in steps]),
        np.array([s.reaction_force_N for s in steps]),
    )


def line_mm(text: str, name: str) -> tuple[str, Floats, float]:
    """Cells, places (d, 2) of their dots from the middle of the first cell, and the pitch of the cells."""
    chosen, cells = standard(name), translate(text).lines[0]
    pitch, cell_pitch = chosen.nominal_mm("dot_pitch_mm"), chosen.nominal_mm("cell_pitch_mm")
    middle = np.mean([dot_offset_mm(dot, pitch) for dot in range(1, 7)], axis=0)
    places = [
        dot_offset_mm(dot, pitch) - middle + [cell_pitch * number, 0.0]
        for number, sign in enumerate(cells)
        if sign != "\u2800"
        for dot in raised_dots(sign)
    ]
    return cells, np.array(places), cell_pitch


def main() -> None:
    """Solve all presses and write them."""
    from benchmarks.reading_in_full import FullPress, charges  # not those of __main__: other processes look them up

    asked = argparse.ArgumentParser()
    asked.add_argument("kernel", type=Path)
    asked.add_argument("out", type=Path)
    asked.add_argument("--text", required=True)
    asked.add_argument("--slide", action="store_true")
    asked.add_argument("--step-mm", type=float, default=0.3)
    asked.add_argument("--depth-mm", type=float, default=0.225)
    asked.add_argument("--friction", type=float, default=0.0)
    asked.add_argument("--offset-mm", type=float, default=0.15, help="of the array across the line")
    chosen = asked.parse_args()
    about = load_kernel(chosen.kernel).about
    cells, places, pitch = line_mm(chosen.text, about["standard"])
    config = config_from(about["config"])
    sizes = {"element_size_mm": ELEMENT_MM, "contact_element_size_mm": CONTACT_MM}
    slips = Mechanism(name="friction", component="dot", parameters={"coefficient": chosen.friction})
    config = config.model_copy(
        update={
            "mesh": config.mesh.model_copy(update=sizes),
            "press": config.press.model_copy(update={"indentation_mm": chosen.depth_mm, "load_steps": STEPS}),
            "mechanisms": (slips,) if chosen.friction else (),
        }
    )
    half = np.array(ArrayCase(config).layout.half_mm) + REACH_MM
    if chosen.slide:
        at = np.arange(places[0, 0] - half[0], places[-1, 0] + half[0] + pitch, chosen.step_mm)
    else:
        at = pitch * np.arange(len(cells))
    presses = {}
    for number, x in enumerate(at):
        dots = places - [x, chosen.offset_mm]
        presses[str(number)] = FullPress(config, float(x), dots[(np.abs(dots) < half).all(axis=1)])
    begun, found = time.perf_counter(), {}
    with LocalProcesses(usable_cores()) as executor:
        for name, future in completed_calls(executor, charges, {name: (press,) for name, press in presses.items()}):
            answer = found[int(name)] = future.result()
            print(f"{len(found)} of {len(presses)}: x = {answer[0]:.2f} mm, {answer[3][-1]:.3f} N", flush=True)
    most = STEPS + 1

    def filled(part: int, number: int) -> Floats:
        values = found[number][part]
        return np.resize(values, (most, *values.shape[1:])) if len(values) == 1 else values

    np.savez(
        chosen.out,
        x_mm=at,
        depth_mm=np.array([np.linspace(0.0, chosen.depth_mm, most) for _ in at]),
        charge_pC=np.array([filled(2, n) for n in range(len(at))]),
        force_N=np.array([filled(3, n) for n in range(len(at))]),
        cells=cells,
        text=chosen.text,
        slide=chosen.slide,
        offset_mm=chosen.offset_mm,
        friction=chosen.friction,
        solve_s=time.perf_counter() - begun,
    )


if __name__ == "__main__":
    main()
