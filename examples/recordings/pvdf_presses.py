"""Presses of a fingertip with eight P(VDF-TrFE) taxels (github.com/cosmiclabunige/Tactile_Heatmaps) as a recording.

    python examples/recordings/pvdf_presses.py DATA OUT

DATA holds Cube10_Seq1_Sp150_t01.npz ...: voltage codes (n, 8) with their step and offset, and force (m,). The two
streams were taken by two clocks at about 2 kHz each. They span the same time, so that the ratio of their lengths is
that of their clocks to a percent or two; there the force is put onto the voltage's clock where, behind a high-pass, it
is most like taxel 1. The time constant of the high-pass is the same for all trials and the one that makes them most
alike: one much shorter than a press gives the rate of the force, a much longer one the force itself. Lag and clock
ratio stay nuisances. A trial whose streams are much less alike than those of the others is left out. Of the taxels the
first is kept, which carries most of the signal, and every 16th sample behind a low-pass at 62 Hz: a press takes a tenth
of a second or more. The shape of the fingertip and the unit of the force are not documented: geometry = "unknown",
newtons by magnitude. The level of the first REST_S is taken off force and voltages.
"""

import re
import sys
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import minimize_scalar
from scipy.signal import decimate, lfilter

from diagnose.signals.align import Lag, lag_between
from foundation.arrays import Floats
from softdot.convert import run_text, write_recording

RATE_HZ = 2000.0
REST_S = 0.2
SMOOTH = 16  # samples: a low-pass near 20 Hz, for the alignment only
COARSE = 8  # samples, behind that low-pass
CLOCKS = (0.98, 1.02)  # of the ratio of lengths
CLOCK_ERROR = 1e-3
TIME_CONSTANTS_S = np.geomspace(1e-3, 10.0, 13)
LAG_ERROR_S = 0.01  # one sigma: the time constant moves the lag by about as much
ALIKE = 0.8  # correlation of the two streams in terms of the median trial's, below which one is left out
EVERY = 16  # samples
HEAD = """# Real presses; shape of the fingertip and unit of the force are not documented by the source.
format = "softdot-recording/1"
geometry = "unknown"

"""


def convert(data: Path, out: Path) -> None:
    """Write the recording of all files in data whose streams are alike."""
    runs, files = [HEAD], {}
    trials = aligned({file.stem: read(file) for file in sorted(data.glob("Cube*_Seq*_Sp*_t*.npz"))})
    usual = float(np.median([abs(lag.correlation) for _, lag in trials.values()]))
    for stem, (columns, lag) in trials.items():
        if abs(lag.correlation) < ALIKE * usual:
            said = f"force and voltage correlate by {lag.correlation:.2f}, usually by {usual:.2f}"
            print(f"{stem} is left out: {said}", file=sys.stderr)
            continue
        name = stem.lower().replace("_", "-") + ".csv"
        files[name] = thinned(columns)
        lag_s = max(lag.sigma_s, LAG_ERROR_S)
        nuisance = {"lag_s": lag_s, "clock_ratio": CLOCK_ERROR, "gain": 0.05, "offset_V": 0.01}
        runs.append(run_text(name, label(stem), "force_N", nuisance=nuisance))
    write_recording(out, "\n".join(runs), files)


def label(stem: str) -> str:
    """Cube10_Seq1_Sp150_t01 -> cube 10, sequence 1, speed 150, trial 1."""
    words = ("cube", "sequence", "speed", "trial")
    return ", ".join(f"{w} {int(n)}" for w, n in zip(words, re.findall(r"\d+", stem), strict=True))


def read(file: Path) -> tuple[Floats, Floats]:
    """Voltage of taxel 1 and force of a trial, each on its own clock and from its own rest."""
    with np.load(file) as data:
        voltage = data["voltage_code"][:, 0] * float(data["lsb_V"]) + float(data["offset_V"])
        force = data["force"].astype(np.float64)
    rest = int(REST_S * RATE_HZ)
    return voltage - np.median(voltage[:rest]), force - np.median(force[:rest])


def aligned(streams: dict[str, tuple[Floats, Floats]]) -> dict[str, tuple[dict[str, Floats], Lag]]:
    """Columns of each trial on the clock of its voltage, and the lag of the voltage, by the best time constant."""
    each = [{stem: on_one_clock(*pair, tau_s) for stem, pair in streams.items()} for tau_s in TIME_CONSTANTS_S]
    return max(each, key=lambda found: sum(abs(lag.correlation) for _, lag in found.values()))


def on_one_clock(voltage: Floats, force: Floats, tau_s: float) -> tuple[dict[str, Floats], Lag]:
    """Columns of a trial, by the force behind a high-pass."""
    first, load = (gaussian_filter1d(one, SMOOTH)[::COARSE] for one in (voltage, force))
    step_s, ratio = COARSE / RATE_HZ, len(voltage) / len(force)
    keep = np.exp(-step_s / tau_s)

    def lag_at(clock: float) -> Lag:
        return lag_between(lfilter([1.0, -1.0], [1.0, -keep], on_clock(load, ratio * clock)), first, step_s)

    options = {"xatol": CLOCK_ERROR}
    found = minimize_scalar(lambda clock: -abs(lag_at(clock).correlation), bounds=CLOCKS, options=options)
    same, lag = on_clock(force, ratio * found.x), lag_at(found.x)
    time = np.arange(len(voltage)) / RATE_HZ
    at = (time - lag.lag_s) * RATE_HZ
    return {"time_s": time, "force_N": np.interp(at, np.arange(len(same)), same), "voltage_V": voltage}, lag


def thinned(columns: dict[str, Floats]) -> dict[str, Floats]:
    """Every 16th sample; values behind an anti-aliasing filter without lag."""
    kept = {name: decimate(values, EVERY, ftype="fir") for name, values in columns.items() if name != "time_s"}
    return {"time_s": columns["time_s"][::EVERY], **kept}


def on_clock(values: Floats, ratio: float) -> Floats:
    """A stream (m,) sampled anew, with ratio samples for one."""
    count = int(ratio * len(values))
    return np.interp(np.arange(count) / ratio, np.arange(len(values)), values)


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
