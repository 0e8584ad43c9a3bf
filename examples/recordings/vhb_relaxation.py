"""Strips of VHB 4910 tape in tension (github.com/Chongran-Zhao/VHB4910_data) as a coupon recording.

    python examples/recordings/vhb_relaxation.py DATA OUT

Files of a tester, header in Chinese (not UTF-8), columns time s, displacement mm, force N. single-step-relaxation__3d0
is a step to stretch 3 and a hold; uniaxial-loading-unloading__0d01_2d0 goes to stretch 2 at 0.01 per second and back.
The free length is 80 mm. Width and thickness are not documented: 10 mm and the tape's nominal 1 mm are assumed, which
only scales the modulus. The holds last 1800 s; rows are thinned to 5 per second behind the first 20 s.
"""

import re
import sys
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from softdot.convert import run_text, white_noise, write_recording

MODULUS = 5.0  # one sigma, relative: what is stated is a start, and the modulus before anything relaxes is unknown
HEAD = """# Width is not documented and assumed here: it scales the modulus and nothing else.
format = "softdot-recording/1"

[specimen]
kind = "tension"
material = "vhb"
length_mm = 80.0
width_mm = 10.0
thickness_mm = 1.0

[materials.vhb]                 # a start; a fit finds its own
model = "neo-hookean"
youngs_modulus_MPa = 0.2
poisson_ratio = 0.4999
density_kg_m3 = 960.0

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of all files in data."""
    runs, files = [HEAD], {}
    for file in sorted(data.glob("*__*.csv")):
        table = thinned(read(file))
        name = file.stem.replace("__", "-") + ".csv"
        files[name] = dict(zip(("time_s", "displacement_mm", "force_N"), table.T, strict=True))
        noise = {"force_N": white_noise(table[:, 2])}
        nuisance = {"modulus.specimen": MODULUS, "offset_N": 0.01}
        runs.append(run_text(name, label(file.stem), "displacement_mm", nuisance=nuisance, noise=noise))
    write_recording(out, "\n".join(runs), files)


def label(stem: str) -> str:
    """What the tester did."""
    kind, _, numbers = stem.partition("__")
    values = [float(text.replace("d", ".")) for text in re.findall(r"\d+d\d+", numbers)]
    if kind == "single-step-relaxation":
        return f"relaxation at stretch {values[0]:g}"
    return f"to stretch {values[1]:g} and back at {values[0]:g}/s"


def read(file: Path) -> Floats:
    """Time, displacement and force (t, 3); header rows are those that do not begin with a digit."""
    text = file.read_text("latin1").replace('"', "")
    rows = [row.split(",") for row in text.splitlines() if row[:1].isdigit()]
    table = np.array([[float(cell) for cell in row] for row in rows])
    rising = np.concatenate([[True], np.diff(table[:, 0]) > 0.0])
    return np.asarray(table[rising])  # the last row of some files repeats its time


def thinned(table: Floats) -> Floats:
    """All rows of the first 20 s, then about 5 a second of a long hold."""
    time = table[:, 0]
    every = max(1, round(0.2 / float(np.median(np.diff(time)))))
    if time[-1] < 600.0:
        return table
    keep = (time < 20.0) | (np.arange(len(time)) % every == 0)
    return np.asarray(table[keep])


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
