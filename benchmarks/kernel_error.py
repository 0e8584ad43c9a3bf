"""The kernel of an array beside the whole array at places, and for cells, at which it was not checked.

    python -m benchmarks.kernel_error FOLDER OUT.json

FOLDER is that of softdot array --kernel. It prints what the kernel states, the worst of ten other places and of thirty
other cells beside their segments, on elements of the same size, and how many of these are within what is stated. None
of them took part in the kernel or in what it states.
"""

import json
import sys
from pathlib import Path

from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import load_kernel
from softdot.arrays.kernel_checks import cells_by_chance, places_by_chance
from softdot.arrays.kernel_errors import measure_errors, worst
from softdot.config.loading import config_from

PLACES, SEEDS = 10, range(1, 6)


def main(folder: Path, out: Path) -> None:
    """Press all, print the worst of each number of dots, write every one."""
    kernel = load_kernel(folder)
    case = ArrayCase(config_from(kernel.about["config"]))
    presses = places_by_chance(case, PLACES, SEEDS[0])
    for seed in SEEDS:
        presses |= {f"{name}, seed {seed}": press for name, press in cells_by_chance(case, 1, seed).items()}
    checks = measure_errors(
        kernel, presses, lambda name, number, count: print(f"{number} of {count}: {name}", flush=True)
    )
    out.write_text(json.dumps([vars(one) for one in checks], indent=1), "utf-8")
    stated = kernel.about["kernel_error"]
    within = {name: sum(getattr(one, name) <= value for one in checks) for name, value in stated.items()}
    print(f"stated: {stated}; of {len(checks)} presses are within: {within}")
    for count in range(1, 7):
        for kind in ("one dot", "cell"):
            of = [one for one in checks if one.dots == count and one.what.startswith(kind)]
            if of:
                found = worst(of)
                print(f"{kind}, {count} dots, {len(of)} presses: {found}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
