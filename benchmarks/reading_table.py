"""Text read from the charges of benchmarks.reading_in_full: voltages behind the usual read-out with noise, decoded.

    python -m benchmarks.reading_table FOLDER IN.npz OUT --noise-mV 1

FOLDER holds the kernel of softdot array --kernel, with which the decoders work. OUT gets the voltages as a CSV file
and what softdot read --recording makes of them. Going up, a press is taken to pass the charges of its way down.
"""

import argparse
import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from foundation.arrays import Floats
from softdot.commands.read import run_read
from softdot.reading.conditions import ReadingConditions, standard_of
from softdot.reading.kernels import open_kernel, readout_of
from softdot.reading.line import cell_pitch_mm
from softdot.reading.motion import press_times
from softdot.reading.voltages import Reader, readout_voltages

SAMPLING_HZ, FINE = 500.0, 8


def charges_in_time(found: Any, conditions: ReadingConditions, pitch_mm: float) -> tuple[Floats, Floats]:
    """Times (t,) and charges (t, n) of the presses, or of the slide."""
    charge = found["charge_pC"]
    if found["slide"]:
        return (found["x_mm"] - found["x_mm"][0]) / conditions.speed_mm_per_s, charge[:, -1]
    times = press_times(conditions, pitch_mm)
    time = np.arange(0.0, (len(charge) + 0.5) * times.period_s, 1.0 / (FINE * SAMPLING_HZ))
    number = np.minimum((time / times.period_s).astype(int), len(charge) - 1)
    within = time - number * times.period_s
    deep = np.clip(np.minimum(within, 2.0 * times.down_s + times.hold_s - within) / times.down_s, 0.0, 1.0)
    depth = found["depth_mm"][0]
    over_depth = PchipInterpolator(depth, charge, axis=1)(deep * depth[-1])  # (cells, t, n)
    return time, over_depth[number, np.arange(len(time))]


def main() -> None:
    """Write the voltages and read them."""
    asked = argparse.ArgumentParser()
    asked.add_argument("kernel", type=Path)
    asked.add_argument("charges", type=Path)
    asked.add_argument("out", type=Path)
    asked.add_argument("--noise-mV", type=float, default=1.0, dest="noise_mV")
    asked.add_argument("--seed", type=int, default=1)
    chosen = asked.parse_args()
    found = np.load(chosen.charges)
    kernel = open_kernel(chosen.kernel)
    usual = ReadingConditions(noise_mV=chosen.noise_mV, sampling_Hz=SAMPLING_HZ)
    conditions = usual if found["slide"] else replace(usual, mode="press")
    known = conditions.with_implied_values(kernel)
    standard = standard_of(kernel, known.standard)
    time, charge = charges_in_time(found, known, cell_pitch_mm(standard))
    at = np.arange(time[0], time[-1], 1.0 / SAMPLING_HZ)
    clean = readout_voltages(
        Reader(kernel, standard, readout_of(kernel, None)), time, charge, at, 1.0 / SAMPLING_HZ / FINE
    )
    voltage = clean + 1e-3 * chosen.noise_mV * np.random.default_rng(chosen.seed).standard_normal(clean.shape)
    recording = chosen.out.with_suffix(".csv")
    with recording.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time_s", *(f"voltage_{number + 1}_V" for number in range(voltage.shape[1]))])
        rows.writerows([f"{value:.9g}" for value in row] for row in np.column_stack([at, voltage]))
    told = run_read(str(found["text"]), chosen.kernel, chosen.out, conditions, recording=recording)
    for name, own in told["decoders"].items():
        print(f"{name}: {own['text_read']!r}, {100 * own['character_accuracy']['value']:.1f} % of the characters")


if __name__ == "__main__":
    main()
