"""An optically clear adhesive in shear (github.com/Chongran-Zhao/Viscoelastic-fitting) as a coupon recording.

    python examples/recordings/adhesive_shear.py DATA OUT

Spreadsheets without header. Monotonic shear: time s, E, stress kPa, shear; of 0d05 the fourth column is the shear and
the fifth the stress. Cyclic shear with relaxation: time s, -, -, stress kPa, shear. Stress and shear are nominal, so
a layer of 10 mm x 10 mm x 1 mm is stated, of which shear in mm and stress times 100 mm2 are displacement and force.

The time of 0d01, 0d1 and 1 is not used. Those files are named by the shear rate, as 0d05 is, whose time times 0.05 1/s
is its shear g. In the three others E = g / sqrt(1 + g^2 / 4), which never exceeds 2, and time times the rate is E to
some per cent: the machine would have had to pull forty times as fast at a shear of 10 as at first. That time was
calculated from E, so it is g over the rate here.
"""

import sys
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from softdot.convert import read_sheet, run_text, white_noise, write_recording

AREA_MM2, THICKNESS_MM = 100.0, 1.0
MODULUS = 5.0  # one sigma, relative: what is stated is a start, and the modulus before anything relaxes is unknown
SPECIMENS = 0.2  # one sigma, relative: what layers of soft materials usually differ by, each run having its own
READING_ERROR = 0.002  # of the largest force, assumed at least: some of the curves were smoothed by their source
RATE_PER_S = {"shear_0d01": 0.01, "shear_0d1": 0.1, "monotonic_shear_1": 1.0}
STRESS_AND_SHEAR = {"monotonic_shear_0d05": (4, 3), "monotonic": (2, 3), "cyclic": (3, 4)}
HEAD = """# Stress and shear are nominal: the layer's sizes are those of a unit specimen.
format = "softdot-recording/1"

[specimen]
kind = "shear"
material = "adhesive"
length_mm = 10.0
width_mm = 10.0
thickness_mm = 1.0

[materials.adhesive]            # a start; a fit finds its own
model = "neo-hookean"
youngs_modulus_MPa = 0.06
poisson_ratio = 0.499
density_kg_m3 = 1000.0

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of all files in data."""
    runs, files = [HEAD], {}
    for file in sorted(data.glob("*shear*.xlsx")):
        columns = read(file)
        name = file.stem.partition("__")[2].replace("_", "-") + ".csv"
        files[name] = columns
        force = columns["force_N"]
        noise = {"force_N": max(white_noise(force), READING_ERROR * float(force.max()))}
        label = name.removesuffix(".csv").replace("0d", "0.").replace("-", " ")
        nuisance = {"modulus.specimen": MODULUS, "force_gain": SPECIMENS}
        runs.append(run_text(name, label, "displacement_mm", nuisance=nuisance, noise=noise))
    write_recording(out, "\n".join(runs), files)


def read(file: Path) -> dict[str, Floats]:
    """Time, displacement and force of one spreadsheet; rows without all three are left out."""
    stress, shear = next(columns for part, columns in STRESS_AND_SHEAR.items() if part in file.stem)
    table = read_sheet(file)[:, [0, shear, stress]]
    table = table[np.isfinite(table).all(axis=1)]
    rate_per_s = next((rate for end, rate in RATE_PER_S.items() if file.stem.endswith(end)), None)
    if rate_per_s is not None:
        table[:, 0] = table[:, 1] / rate_per_s
    table = table[np.concatenate([[True], np.diff(table[:, 0]) > 0.0])]
    return {
        "time_s": table[:, 0],
        "displacement_mm": THICKNESS_MM * table[:, 1],
        "force_N": 1e-3 * AREA_MM2 * table[:, 2],
    }


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
