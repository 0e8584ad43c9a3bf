"""Treloar's rubber of 1944 in uniaxial tension (as digitised in github.com/LivingMatterLab/CANN) as a coupon recording.

    python examples/recordings/rubber_treloar.py DATA OUT

DATA holds CANNsRUBBERdata.xlsx: blocks of stretch F11 and nominal stress P11 (MPa), rows 1 and 2 naming the test. Used
are uniaxial tension at 20 and at 50 degrees. Equibiaxial tension and pure shear are no kinds of a coupon here. Time
was not recorded: the test was quasi-static, and one second per 0.01 of stretch is written.
"""

import sys
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from softdot.convert import read_sheet, run_text, write_recording

BLOCKS = {"20": (0, 2), "50": (10, 12)}  # temperature in degrees -> columns of F11 and P11
LENGTH_MM, AREA_MM2 = 10.0, 1.0
STRETCH_PER_S = 0.01
MODULUS = 1.0  # one sigma, relative: it is what the test is for
READING_ERROR = 0.005  # of the largest stress; assumed, for one reads a printed figure to about that
HEAD = """# Nominal stress and stretch of a unit strip; the time is not the experiment's.
format = "softdot-recording/1"

[specimen]
kind = "tension"
material = "natural-rubber"
length_mm = 10.0
width_mm = 1.0
thickness_mm = 1.0

[materials.natural-rubber]      # a start; a fit finds its own
model = "neo-hookean"
youngs_modulus_MPa = 1.2
poisson_ratio = 0.4999
density_kg_m3 = 930.0

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of the uniaxial tests."""
    cells = read_sheet(data / "CANNsRUBBERdata.xlsx", first_row=5)
    runs, files = [HEAD], {}
    for temperature, columns in BLOCKS.items():
        stretch, stress = block(cells[:, columns])
        name = f"tension-{temperature}-degrees.csv"
        files[name] = {
            "time_s": (stretch - 1.0) / STRETCH_PER_S,
            "displacement_mm": LENGTH_MM * (stretch - 1.0),
            "force_N": AREA_MM2 * stress,
        }
        noise = {"force_N": READING_ERROR * float(stress.max())}
        label = f"uniaxial tension, {temperature} degrees"
        runs.append(run_text(
            name, label, "displacement_mm", temperature_C=float(temperature),
            nuisance={"modulus.specimen": MODULUS}, noise=noise,
        ))  # fmt: skip
    write_recording(out, "\n".join(runs), files)


def block(cells: Floats) -> tuple[Floats, Floats]:
    """Stretch and stress (t,) of one test, in order of stretch: the block ends at its first empty cell."""
    full = np.isfinite(cells).all(axis=1)
    cells = cells[: int(np.argmin(full)) if not full.all() else len(cells)]
    stretch, first = np.unique(cells[:, 0], return_index=True)
    return stretch, cells[first, 1]


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
