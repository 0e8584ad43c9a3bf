"""softdot export robot: a kernel as the skin of a finger, with a model for MuJoCo."""

import shutil
import time
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from softdot.arrays.kernel import ArrayKernel, load_kernel
from softdot.json_files import write_json
from softdot.output import Product, staged_folder
from softdot.reading.kernels import check_kernel, electronics_of, readout_of
from softdot.robot.skin import RobotSkin
from solve.readout.amplifier import input_of

SCRIPTS = ("skin.py", "slide.py", "finger.xml")
ROBOT = Product("softdot-robot/1", "robot.json", frozenset({"robot.json", "kernel.npz", *SCRIPTS}))
TRIALS = 4000
STOP_SHARE, DAMPING_N_S_PER_M = 0.9, 20.0
"""Of the depth of the kernel, to which the finger sinks where nothing carries it; damping of its fall."""


def write_robot(source: Path, out: Path) -> dict[str, Any]:
    """Write a kernel, the code that reads it, and a finger for MuJoCo into the folder out; content of robot.json.

    source : a folder of softdot array --kernel. InputError.
    """
    kernel = check_kernel(load_kernel(source), f"'{source}'")
    summary = _about(kernel)
    with staged_folder(out, ROBOT) as folder:
        shutil.copyfile(source / "kernel.npz", folder / "kernel.npz")
        write_json(folder / ROBOT.summary, summary)
        _write_scripts(kernel, folder)
        summary["readings_per_s"] = readings_per_s(RobotSkin(folder))
        write_json(folder / ROBOT.summary, summary)
    return summary


def _about(kernel: ArrayKernel) -> dict[str, Any]:
    """Labels, capacitances and time constants, with the amplifier of the kernel's design, else that of a reading."""
    readout, _ = electronics_of(kernel, readout_of(kernel, None))
    inputs = [input_of(readout, 1e-12 * float(one)) for one in kernel.capacitance_pF]
    return {
        "format": ROBOT.format, "labels": kernel.about["labels"], "centres_mm": kernel.centres_mm,
        "capacitance_pF": [1e12 * capacitance for capacitance, _ in inputs], "gain": readout.gain,
        "time_constant_s": [capacitance * resistance for capacitance, resistance in inputs],
        "readout": readout.model_dump(mode="json"), "kernel_error": kernel.about.get("kernel_error"),
    }  # fmt: skip


def _write_scripts(kernel: ArrayKernel, folder: Path) -> None:
    here = files("softdot.robot")
    (folder / "skin.py").write_text(here.joinpath("skin.py").read_text("utf-8"), "utf-8")
    (folder / "slide.py").write_text(here.joinpath("slide.txt").read_text("utf-8"), "utf-8")
    deepest, dot = float(kernel.depth_mm[-1]), kernel.about.get("dot", {})
    tip, radius = float(dot.get("height_mm") or 0.5), float(dot.get("radius_mm") or 0.8)
    text = here.joinpath("finger.xml.txt").read_text("utf-8").format(
        centre_m=1e-3 * (tip - radius), radius_m=1e-3 * radius, tip_m=1e-3 * tip, damping=DAMPING_N_S_PER_M,
        lowest_m=1e-3 * (tip - STOP_SHARE * deepest), half_x_m=1e-3 * float(np.abs(kernel.x_mm).max()),
        half_y_m=1e-3 * float(np.abs(kernel.y_mm).max()), segments=len(kernel.capacitance_pF),
    )  # fmt: skip
    (folder / "finger.xml").write_text(text, "utf-8")


def readings_per_s(skin: RobotSkin) -> float:
    """Readings per second of processor time, a press and its voltages each, at places by chance."""
    random = np.random.default_rng(0)
    ends = [(axis[0], axis[-1]) for axis in skin.axes]
    places = np.column_stack([random.uniform(low, high, TRIALS) for low, high in ends]).tolist()
    begin = time.process_time()
    for x, y, depth in places:
        charge, _ = skin.press(x, y, depth)
        skin.read(charge, 5e-4)
    skin.reset()
    return TRIALS / (time.process_time() - begin)
