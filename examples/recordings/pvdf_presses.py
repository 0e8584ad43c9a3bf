"""Presses of a fingertip with eight P(VDF-TrFE) taxels (github.com/cosmiclabunige/Tactile_Heatmaps) as a recording.

    python examples/recordings/pvdf_presses.py DATA OUT

DATA holds Cube10_Seq1_Sp150_t01.npz ...: voltage codes (n, 8) with their step and offset, and force (m,). The two
streams were taken by two clocks at about 2 kHz each, so the force is shifted onto the voltage here by the lag of its
rate behind taxel 1, and the lag stays a nuisance. The shape of the fingertip and the unit of the force are not
documented: geometry = "unknown", newtons by magnitude. The level of the first REST_S is taken off force and voltages.
"""

import re
import sys
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter1d

from diagnose.align import Lag, lag_between
from mesh.types import Floats
from softdot.convert import run_text, write_recording

RATE_HZ = 2000.0
REST_S = 0.2
SMOOTH = 16  # samples: a low-pass near 20 Hz, for the alignment only
HEAD = """# Real presses; shape of the fingertip and unit of the force are not documented by the source.
format = "softdot-recording/1"
geometry = "unknown"

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of all files in data."""
    runs, files = [HEAD], {}
    for file in sorted(data.glob("Cube*_Seq*_Sp*_t*.npz")):
        columns, lag = read(file)
        name = file.stem.lower().replace("_", "-") + ".csv"
        files[name] = columns
        nuisance = {"lag_s": max(lag.sigma_s, 1.0 / RATE_HZ), "gain": 0.05, "offset_V": 0.01}
        runs.append(run_text(name, label(file.stem), "force_N", nuisance=nuisance))
    write_recording(out, "\n".join(runs), files)


def label(stem: str) -> str:
    """Cube10_Seq1_Sp150_t01 -> cube 10, sequence 1, speed 150, trial 1."""
    words = ("cube", "sequence", "speed", "trial")
    return ", ".join(f"{w} {int(n)}" for w, n in zip(words, re.findall(r"\d+", stem), strict=True))


def read(file: Path) -> tuple[dict[str, Floats], Lag]:
    """Columns on the clock of the voltages, and the lag of the voltage behind the rate of the force."""
    with np.load(file) as data:
        voltage = data["voltage_code"] * float(data["lsb_V"]) + float(data["offset_V"])
        force = data["force"].astype(np.float64)
    rate = np.gradient(gaussian_filter1d(force, SMOOTH))
    lag = lag_between(rate, gaussian_filter1d(voltage[:, 0], SMOOTH), 1.0 / RATE_HZ)
    time = np.arange(len(voltage)) / RATE_HZ
    at = (time - lag.lag_s) * RATE_HZ
    rest = time < REST_S
    columns = {"force_N": np.interp(at, np.arange(len(force)), force)}
    columns |= {f"voltage_{n}_V": values for n, values in enumerate(voltage.T, start=1)}
    return {"time_s": time} | {name: values - np.median(values[rest]) for name, values in columns.items()}, lag


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
