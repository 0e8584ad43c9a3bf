"""Presses of a fingertip with eight P(VDF-TrFE) taxels (github.com/cosmiclabunige/Tactile_Heatmaps) as a recording.

    python examples/recordings/pvdf_presses.py DATA OUT

DATA holds Cube10_Seq1_Sp150_t01.npz ...: voltage codes (n, 8) with their step and offset, and force (m,). The two
streams were taken by two clocks at about 2 kHz each. They span the same time, so that the ratio of their lengths is
that of their clocks to a percent or two; there the force is put onto the voltage's clock where its rate is most like
taxel 1. Lag and clock ratio stay nuisances. Of the taxels the first is kept, which carries most of the signal, and
every fourth sample behind a low-pass: nothing of a press is faster than 100 Hz. The shape of the fingertip and the unit
of the force are not documented: geometry = "unknown", newtons by magnitude. The level of the first REST_S is taken off
force and voltages.
"""

import re
import sys
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import minimize_scalar
from scipy.signal import decimate

from diagnose.signals.align import Lag, lag_between
from geometry.arrays import Floats
from softdot.convert import run_text, write_recording

RATE_HZ = 2000.0
REST_S = 0.2
SMOOTH = 16  # samples: a low-pass near 20 Hz, for the alignment only
CLOCKS = (0.98, 1.02)  # of the ratio of lengths
CLOCK_ERROR = 1e-3
EVERY = 4  # samples
HEAD = """# Real presses; shape of the fingertip and unit of the force are not documented by the source.
format = "softdot-recording/1"
geometry = "unknown"

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of all files in data."""
    runs, files = [HEAD], {}
    for file in sorted(data.glob("Cube*_Seq*_Sp*_t*.npz")):
        whole, lag = read(file)
        columns = thinned({"time_s": whole["time_s"], "force_N": whole["force_N"], "voltage_V": whole["voltage_1_V"]})
        name = file.stem.lower().replace("_", "-") + ".csv"
        files[name] = columns
        lag_s = max(lag.sigma_s, 1.0 / RATE_HZ)
        nuisance = {"lag_s": lag_s, "clock_ratio": CLOCK_ERROR, "gain": 0.05, "offset_V": 0.01}
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
    first, ratio = gaussian_filter1d(voltage[:, 0], SMOOTH), len(voltage) / len(force)

    def lag_at(clock: float) -> Lag:
        rate = np.gradient(gaussian_filter1d(on_clock(force, ratio * clock), SMOOTH))
        return lag_between(rate, first, 1.0 / RATE_HZ)

    options = {"xatol": CLOCK_ERROR}
    found = minimize_scalar(lambda clock: -abs(lag_at(clock).correlation), bounds=CLOCKS, options=options)
    force, lag = on_clock(force, ratio * found.x), lag_at(found.x)
    time = np.arange(len(voltage)) / RATE_HZ
    at = (time - lag.lag_s) * RATE_HZ
    rest = time < REST_S
    columns = {"force_N": np.interp(at, np.arange(len(force)), force)}
    columns |= {f"voltage_{n}_V": values for n, values in enumerate(voltage.T, start=1)}
    return {"time_s": time} | {name: values - np.median(values[rest]) for name, values in columns.items()}, lag


def thinned(columns: dict[str, Floats]) -> dict[str, Floats]:
    """Every fourth sample; values behind an anti-aliasing filter without lag."""
    kept = {name: decimate(values, EVERY, ftype="fir") for name, values in columns.items() if name != "time_s"}
    return {"time_s": columns["time_s"][::EVERY], **kept}


def on_clock(values: Floats, ratio: float) -> Floats:
    """A stream (m,) sampled anew, with ratio samples for one."""
    count = int(ratio * len(values))
    return np.interp(np.arange(count) / ratio, np.arange(len(values)), values)


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
