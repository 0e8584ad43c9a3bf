"""Draw force and voltage of a configuration with and without its mechanisms.

    python examples/compare.py examples/mechanisms/friction.toml -o friction.png

Without mechanisms also means: every material of the file becomes a neo-Hookean one with the same small-strain moduli.
With several electrodes the voltage is that of the first one. On a slide the force is the one along x; where a force
is prescribed, the depth takes its place.
"""

import argparse
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from scipy.interpolate import PchipInterpolator

from geometry.arrays import Floats
from softdot.case import Case
from softdot.config import Config, load_config
from solve.materials.parameters import Hyperfoam, Material, NeoHookean, PiezoelectricFilm
from solve.model import Readout
from solve.readout.recording import channel_voltages, record

BLUE, ORANGE = "#2a6db0", "#d1600a"


class Curves(NamedTuple):
    """Histories (t,): what the rig's sensors read, and the voltage at times and depths (v,) of its own."""

    time_s: Floats
    depth_mm: Floats
    force_N: Floats
    voltage_time_s: Floats
    voltage_depth_mm: Floats
    voltage_V: Floats


def solve(config: Config) -> Curves:
    """Press the segment of a configuration. SystemExit where it does not converge."""
    case = Case(config)
    told, physics, result = case.model, case.model.physics, case.solve()
    if not result.converged:
        raise SystemExit(result.failure)
    electrodes, amplifier = len(result.capacitance_F), told.readout or Readout()
    recording = record(result, told.press, amplifier, np.ones(electrodes), physics)
    slides, trace = bool(told.press.path_xy_mm), result.trace
    if result.follows_time or slides:
        time, depth = trace.time_s, 1e3 * trace.indentation_m
        force = trace.contact_force_N[:, 0] if slides else trace.reaction_force_N
    else:  # the way back is the way in
        time = recording.time_s
        depth = 1e3 * _along(np.array([step.indentation_m for step in result.steps]), recording.progress)
        force = _along(np.array([step.reaction_force_N for step in result.steps]), recording.progress)
    at, voltage = recording.time_s, recording.voltage_V
    if electrodes > 1:
        at = np.array([step.time_s for step in result.steps])
        voltage = channel_voltages(result, told.press, amplifier, physics)[0]
    return Curves(time, depth, force, at, np.interp(at, time, depth), voltage)


def _along(values: Floats, progress: Floats) -> Floats:
    """Values of the load steps (s,) at fractions of their number (t,)."""
    return np.asarray(PchipInterpolator(np.arange(len(values)), values)(progress))


def baseline(config: Config) -> Config:
    """The same without mechanisms and with neo-Hookean media."""
    materials = {name: _neo_hookean(material) for name, material in config.materials.items()}
    return config.model_copy(update={"mechanisms": (), "materials": materials})


def _neo_hookean(material: Material) -> Material:
    if isinstance(material, NeoHookean | PiezoelectricFilm):
        return material
    shear = material.shear_modulus_MPa
    ratio = material.poisson_ratio[0] if isinstance(material, Hyperfoam) else material.poisson_ratio
    return NeoHookean(youngs_modulus_MPa=2.0 * shear * (1.0 + ratio), poisson_ratio=ratio)


def draw(config: Config, over: str, title: str, picture: Path) -> None:
    """Both presses, force (or depth) on the left and voltage on the right. 800 pixels wide."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), dpi=100, layout="constrained")
    for case, colour, width, label in ((baseline(config), BLUE, 2.2, "baseline"), (config, ORANGE, 1.6, title)):
        found = solve(case)
        x, v = (found.time_s, found.voltage_time_s) if over == "time" else (found.depth_mm, found.voltage_depth_mm)
        up = found.force_N if config.press.force_N is None else found.depth_mm
        left.plot(x, up, color=colour, linewidth=width, label=label)
        right.plot(v, found.voltage_V, color=colour, linewidth=width)
    across = "time in s" if over == "time" else "depth in mm, at the sensor"
    _finish(left, across, _left_label(config))
    _finish(right, across, _right_label(config))
    left.legend(frameon=False)
    figure.savefig(picture)
    plt.close(figure)


def _left_label(config: Config) -> str:
    if config.press.force_N is not None:
        return "depth in mm"
    return "force along x on the dot in N" if config.press.path_xy_mm else "force in N"


def _right_label(config: Config) -> str:
    electrodes = config.segment.film.electrodes
    return f"voltage of '{electrodes[0].name}' in V" if len(electrodes) > 1 else "voltage in V"


def _finish(axes: Axes, across: str, up: str) -> None:
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.margins(x=0.01)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="force and voltage with and without the mechanisms of a file")
    parser.add_argument("config", type=Path)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the picture, a PNG")
    parser.add_argument("--over", choices=("time", "depth"), help="default: time where there is a waveform")
    given = parser.parse_args()
    config = load_config(given.config)
    over = given.over or ("time" if config.press.waveform or config.press.path_xy_mm else "depth")
    draw(config, over, given.config.stem, given.out)


if __name__ == "__main__":
    main()
