"""Presses that take no part in a kernel and tell how far it is from the whole array.

A dot at places and depths by chance, cells of one to six dots by chance beside their segments, and every cell of
Braille over its segments, to the depth of the kernel.
"""

from itertools import combinations, product

import numpy as np

from foundation.arrays import Floats
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel_presses import one_dot_config
from softdot.config.schema import Config

DOTS = 6
PLACES, CELLS = 12, 3
"""Presses at places by chance, and cells by chance of each number of dots. They are thirty, as nine of ten such presses
lie within the worst of 29 with a confidence of 95 % (Wilks, Ann. Math. Stat. 12, 1941, 91).
"""
SHALLOWEST, BESIDE = 0.6, 1.0 / 3.0
"""The least depth of these as a share of the kernel's, and how far cells are beside their segments at most, in pitches:
dots that hang over the rim are no part of a kernel.
"""
SEED = 0
COLUMNS_SWAPPED = dict(zip((1, 2, 3, 4, 5, 6), (4, 5, 6, 1, 2, 3), strict=True))
ROWS_SWAPPED = dict(zip((1, 2, 3, 4, 5, 6), (3, 2, 1, 6, 5, 4), strict=True))


def check_presses(case: ArrayCase) -> dict[str, Config]:
    """Name -> press, on the mesh of the kernel."""
    return {**places_by_chance(case, PLACES), **cells_by_chance(case, CELLS), **every_cell(case)}


def places_by_chance(case: ArrayCase, count: int, seed: int = SEED) -> dict[str, Config]:
    """Presses by one dot over the segments."""
    random, half = np.random.default_rng(seed), np.array(case.layout.half_mm)
    places = (random.uniform(-half, half) for _ in range(count))
    return {
        f"one dot, {number}": _at_depth(one_dot_config(case, float(x), float(y)), random)
        for number, (x, y) in enumerate(places, 1)
    }


def cells_by_chance(case: ArrayCase, each: int, seed: int = SEED) -> dict[str, Config]:
    """Cells of each number of dots beside their segments; none where the array has no segment for each dot of one."""
    random = np.random.default_rng([seed, DOTS])
    found = {}
    for number, count in product(range(1, each + 1), range(1, DOTS + 1)) if holds_a_cell(case) else ():
        dots = sorted(int(dot) for dot in random.choice(DOTS, count, replace=False) + 1)
        shift = random.uniform(-BESIDE, BESIDE, 2) * case.layout.pitch_mm
        found[f"cell of {count} beside its segments, {number}"] = _at_depth(by_cell(case, dots, shift), random)
    return found


def every_cell(case: ArrayCase) -> dict[str, Config]:
    """Presses by each of the 63 cells over its segments; of those that are mirror images of each other one."""
    swaps = [
        swap
        for axis, swap, fill in ((0, COLUMNS_SWAPPED, 2), (1, ROWS_SWAPPED, 3))
        if axis in case.mirrors and len(case.layout.centres(axis)) == fill
    ]
    found: dict[frozenset[frozenset[int]], list[int]] = {}
    for count in range(1, DOTS + 1) if holds_a_cell(case) else ():
        for dots in combinations(range(1, DOTS + 1), count):
            images = {frozenset(dots)}
            for swap in swaps:
                images |= {frozenset(swap[dot] for dot in one) for one in images}
            found.setdefault(frozenset(images), list(dots))
    return {f"cell {''.join(map(str, dots))}": by_cell(case, dots, np.zeros(2)) for dots in found.values()}


def holds_a_cell(case: ArrayCase) -> bool:
    """Whether the array has two columns and three rows at least."""
    return len(case.layout.centres(0)) >= 2 and len(case.layout.centres(1)) >= 3


def by_cell(case: ArrayCase, dots: list[int], shift_mm: Floats) -> Config:
    """A press of the kernel by a cell of these dots whose middle is this far from that of the array's first cell."""
    sign = chr(0x2800 + sum(1 << (dot - 1) for dot in dots))
    shifted = case.config.dot.lone(cell=sign, cell_dot=dots[0], offset_mm=tuple(shift_mm))
    dot = ArrayCase(case.config.model_copy(update={"dot": shifted})).press_by_cell().config.dot
    return one_dot_config(case, 0.0, 0.0).model_copy(update={"dot": dot})


def _at_depth(config: Config, random: np.random.Generator) -> Config:
    depth = float((config.press.indentation_mm or 0.0) * random.uniform(SHALLOWEST, 1.0))
    return config.model_copy(update={"press": config.press.model_copy(update={"indentation_mm": depth})})
