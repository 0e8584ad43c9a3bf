"""The kernel of an array beside the whole array: ten places by chance, and all 63 cells over their segments.

    python -m benchmarks.kernel_error FOLDER OUT.json

FOLDER is that of softdot array --kernel for an array of two columns and three rows. None of these presses took part in
the kernel; cells that are mirror images of each other are pressed once. Their elements are those of the kernel.
"""

import json
import sys
from itertools import combinations
from pathlib import Path

import numpy as np

from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import load_kernel
from softdot.arrays.kernel_errors import by_cell, by_chance, measured
from softdot.config import config_from

PLACES = 10
COLUMNS_SWAPPED, ROWS_SWAPPED = {1: 4, 2: 5, 3: 6, 4: 1, 5: 2, 6: 3}, {1: 3, 2: 2, 3: 1, 4: 6, 5: 5, 6: 4}


def distinct_cells() -> list[list[int]]:
    """Dots of each cell, one of those that are mirror images of each other."""
    found: dict[frozenset[frozenset[int]], list[int]] = {}
    for count in range(1, 7):
        for dots in combinations(range(1, 7), count):
            images = {frozenset(dots)}
            for swapped in (COLUMNS_SWAPPED, ROWS_SWAPPED):
                images |= {frozenset(swapped[dot] for dot in one) for one in images}
            found.setdefault(frozenset(images), list(dots))
    return list(found.values())


def main(folder: Path, out: Path) -> None:
    """Press all, print the worst of each number of dots, write every one."""
    kernel = load_kernel(folder)
    case = ArrayCase(config_from(kernel.about["config"]))
    presses = by_chance(case, PLACES, 0)
    for dots in distinct_cells():
        presses["cell " + "".join(map(str, dots))] = by_cell(case, dots, np.zeros(2))
    checks = measured(kernel, presses, lambda name, number, count: print(f"{number} of {count}: {name}", flush=True))
    out.write_text(json.dumps([vars(one) for one in checks], indent=1), "utf-8")
    for count in range(1, 7):
        for kind in ("one dot", "cell"):
            of = [one for one in checks if one.dots == count and one.what.startswith(kind)]
            if of:
                charge, force = (max(getattr(one, name) for one in of) for name in ("charge_percent", "force_percent"))
                print(f"{kind}, {count} dots, {len(of)} presses: charges {charge:.2f} %, force {force:.2f} %")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
