"""A made-up recording to try softdot diagnose on: the paper's segment, whose charge leaks away faster than believed.

    python examples/recordings/leaky_amplifier.py OUT

No real sensor was pressed. The 3D model presses a plane-strain slice on a finer mesh than rig.toml asks for; its charge
goes through the stated amplifier of 10 GOhm and a leak of 1 GOhm beside it, which rig.toml does not mention. On top are
noise, 50 Hz hum and a step of the converter, and gains that are a few per cent off, as rig.toml allows them to be.
"""

import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from softdot.case import Case
from softdot.config.loading import config_from
from softdot.config.toml import parse_toml
from softdot.convert import run_text, write_recording
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify

RIG = """# Made up by examples/recordings/leaky_amplifier.py; no real sensor was pressed.
format = "softdot-recording/1"

[segment]
section = "plane-strain"
length_mm = 2.5
width_mm = 16.0
boundary = "clamped"
held_layers = ["effector", "medium1", "film"]

[segment.effector]
height_mm = 1.0
material = "rubber"

[segment.medium1]
thickness_mm = 0.5
material = "vnr"

[segment.film]
thickness_um = 28.0

[segment.medium2]
thickness_mm = 2.0
material = "vnr-soft"

[dot]
shape = "ridge"
radius_mm = 1.15

[readout]
input_resistance_MOhm = 10000.0   # data sheet of the electrometer
input_capacitance_pF = 100.0      # amplifier and cable

"""
RUNS = {
    "slow, 0.2 mm": (0.2, 0.5, 1.0),  # depth in mm, rise and hold in s
    "slow, 0.3 mm": (0.3, 0.5, 1.0),
    "quick, 0.2 mm": (0.2, 0.1, 0.5),
    "quick, 0.3 mm": (0.3, 0.1, 0.5),
}
LEAK_MOHM = 1000.0
RATE_HZ, LASTS_S, TOUCH_S = 200.0, 6.0, 1.5
SIZES_MM = 0.2, 0.05  # of elements, and of those in contact
NUISANCE = {"gain": 0.03, "force_gain": 0.02}
NOISE_V, HUM_V, STEP_V, NOISE_N = 0.2, 0.1, 0.01, 0.02


def make(
    out: Path, seed: int = 1, rig: str = RIG, runs: Mapping[str, tuple[float, float, float]] = RUNS,
    rate_Hz: float = RATE_HZ, lasts_s: float = LASTS_S, sizes_mm: tuple[float, float] = SIZES_MM,
) -> None:  # fmt: skip
    """Write the recording folder. rig : rig.toml without its runs, with this amplifier. sizes_mm : of the mesh."""
    rng = np.random.default_rng(seed)
    depth, force, charge, capacitance = pressed(rig, max(run[0] for run in runs.values()), sizes_mm)
    stated = Readout(input_resistance_MOhm=10000.0, input_capacitance_pF=100.0)
    leaking = stated.model_copy(update={"input_resistance_MOhm": 1.0 / (1.0 / 10000.0 + 1.0 / LEAK_MOHM)})
    time = np.arange(0.0, lasts_s, 1.0 / rate_Hz)
    files, texts = {}, [rig]
    for number, (label, run) in enumerate(runs.items(), start=1):
        drive = motion(time, *run)
        at = np.clip(drive, 0.0, None)
        voltage = amplify(time, np.interp(at, depth, charge), capacitance, leaking, Physics())
        gain, force_gain = 1.0 + rng.standard_normal(2) * list(NUISANCE.values())
        hum = HUM_V * np.sin(2.0 * np.pi * (50.0 * time + rng.random()))
        voltage = gain * voltage + hum + NOISE_V * rng.standard_normal(len(time))
        noisy_force = force_gain * np.interp(at, depth, force) + NOISE_N * rng.standard_normal(len(time))
        name = f"press-{number}.csv"
        files[name] = {
            "time_s": time, "displacement_mm": np.round(drive, 5), "force_N": np.round(noisy_force, 4),
            "voltage_V": STEP_V * np.round(voltage / STEP_V),
        }  # fmt: skip
        texts.append(run_text(name, label, "displacement_mm", nuisance=NUISANCE))
    write_recording(out, "\n".join(texts), files)


@cache
def pressed(rig: str, depth_mm: float, sizes_mm: tuple[float, float]) -> tuple[Floats, Floats, Floats, float]:
    """Depth (mm), force (N) and charge (C) of a press, (s,) each, and the film's capacitance (F)."""
    tables = parse_toml(rig, "rig.toml") | {
        "press": {"indentation_mm": depth_mm, "load_steps": 30},
        "mesh": {"element_size_mm": sizes_mm[0], "contact_element_size_mm": sizes_mm[1]},
    }
    del tables["format"]
    result = Case(config_from(tables)).solve()
    columns = [(1e3 * step.indentation_m, step.reaction_force_N, step.film_charge_C.sum()) for step in result.steps]
    depth, force, charge = np.array(columns).T
    return depth, force, charge, float(result.capacitance_F.sum())


def motion(time_s: Floats, depth_mm: float, rise_s: float, hold_s: float) -> Floats:
    """From 0.1 mm clear of the dot to a depth and back at one speed, (t,)."""
    clear = -0.1
    reach = rise_s * -clear / depth_mm
    corners = TOUCH_S + np.array([-reach, rise_s, rise_s + hold_s, 2.0 * rise_s + hold_s + reach])
    return np.interp(time_s, corners, [clear, depth_mm, depth_mm, clear])


if __name__ == "__main__":
    make(Path(sys.argv[1]))
