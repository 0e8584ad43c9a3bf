"""Read the kernel of an array with NumPy alone: charges in pC and force in N of one dot at a place and depth in mm.

softdot array examples/array-cell.toml --kernel -o out
python examples/robot/kernel_numpy.py out
"""

import json
import sys
from itertools import product
from pathlib import Path

import numpy as np


class Kernel:
    """kernel.npz has the tables, kernel.json the places of the segments, units and errors."""

    def __init__(self, folder):
        folder = Path(folder)
        self.about = json.loads((folder / "kernel.json").read_text("utf-8"))
        with np.load(folder / "kernel.npz") as tables:
            self.axes = [tables[name].astype(float) for name in ("x_mm", "y_mm", "depth_mm")]
            # charges of the n segments and the force, side by side: (x, y, depth, n + 1)
            self.table = np.concatenate([tables["charge_pC"], tables["force_N"][..., None]], axis=-1).astype(float)
        self.capacitance_pF = np.array(self.about["capacitance_pF"])

    def press(self, x_mm, y_mm, depth_mm):
        """Charges (n,) and force of a dot whose tip is there, in the frame of the array; nothing beside the table."""
        at, low, share = (x_mm, y_mm, depth_mm), [], []
        if depth_mm <= 0.0 or any(not a[0] <= v <= a[-1] for a, v in zip(self.axes[:2], at, strict=False)):
            return np.zeros(self.table.shape[-1] - 1), 0.0
        if depth_mm > self.axes[2][-1]:
            raise ValueError(f"depth_mm = {depth_mm:.4g}: the kernel ends at {self.axes[2][-1]:.4g}")
        for axis, value in zip(self.axes, at, strict=True):
            number = min(int(np.searchsorted(axis, value, side="right")) - 1, len(axis) - 2)
            low.append(number)
            share.append((value - axis[number]) / (axis[number + 1] - axis[number]))
        found = 0.0
        for corner in product((0, 1), repeat=3):
            weight = np.prod([s if up else 1.0 - s for s, up in zip(share, corner, strict=True)])
            found = found + weight * self.table[tuple(n + up for n, up in zip(low, corner, strict=True))]
        return found[:-1], float(found[-1])


def main(folder):
    """Print what the segments read."""
    kernel = Kernel(folder)
    deepest = kernel.axes[2][-1]
    print(f"a dot {deepest:.2f} mm deep over each segment; errors {kernel.about['kernel_error']}")
    for label, (x, y) in zip(kernel.about["labels"], kernel.about["centres_mm"], strict=True):
        charge, force = kernel.press(x, y, deepest)
        print(f"{label}: {force:.3f} N, open circuit", np.round(charge / kernel.capacitance_pF, 2), "V")


if __name__ == "__main__":
    main(sys.argv[1])
