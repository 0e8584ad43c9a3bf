"""The coarse kernel of the search for designs beside presses that softdot array --kernel makes: at every EVERY-th of
its places, on its mesh.

    python -m benchmarks.design_kernel CONFIG.toml OUT.json EVERY [KEY=VALUE ...]

The difference of force and of each segment's charge is told at each load step, in percent of the force and of the
largest charge of that step; places beyond those of the coarse kernel are left to its interpolation.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel
from softdot.arrays.kernel_presses import KernelPress, KernelTask, grid_of, recall, solve_task
from softdot.config.loading import load_config
from softdot.reading.designs.operating import coarse_kernel


def differences(kernel: ArrayKernel, task: KernelTask, press: KernelPress) -> dict[str, Any]:
    """Of one place: depth, and how far the coarse kernel is off."""
    x, y = task.config.dot.offset_mm
    depth, force_N, charge_pC = press.depth_mm[1:], press.force_N[1:], press.charge_pC[1:]
    charge, force = kernel.of_one(np.full(len(depth), x), np.full(len(depth), y), depth)
    return {
        "x_mm": x,
        "y_mm": y,
        "depth_mm": depth.tolist(),
        "force_N": force_N.tolist(),
        "force_percent": (100.0 * (force / force_N - 1.0)).tolist(),
        "charge_percent": (100.0 * np.abs(charge - charge_pC).max(axis=1) / np.abs(charge_pC).max(axis=1)).tolist(),
    }


def main(config: str, out: str, every: str, *settings: str) -> None:
    """Press, compare, and write OUT.json with the root mean squares at each load step."""
    case = ArrayCase(load_config(config, settings))
    kernel = coarse_kernel(case.config)
    rows = []
    for task in list(grid_of(case).tasks().values())[:: int(every)]:
        rows.append(differences(kernel, task, recall(task) or solve_task(task)))
        print(rows[-1], flush=True)
    names = ("force_percent", "charge_percent")
    rms = {name: np.sqrt(np.mean(np.square([row[name] for row in rows]), axis=0)).tolist() for name in names}
    Path(out).write_text(
        json.dumps({"config": config, "settings": settings, "rms": rms, "places": rows}, indent=1), "utf-8"
    )
    print(rms)


if __name__ == "__main__":
    main(*sys.argv[1:])
