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

from foundation.arrays import Floats
from softdot.case import Case
from softdot.config.loading import load_config
from softdot.config.schema import Config
from solve.materials.parameters import Hyperfoam, Material, NeoHookean, PiezoelectricFilm

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
    told, result = case.model, case.solve()
    if not result.converged:
        raise SystemExit(result.failure)
    along, slides = case.course(result), bool(told.press.path_xy_mm)
    force = along.reaction_force_N
    if slides:
        force = np.interp(along.time_s, result.trace.time_s, result.trace.contact_force_N[:, 0])
    read = along.voltage_V[:, 0] if along.channels_V is None else along.channels_V[:, 0]
    depth = 1e3 * along.indentation_m
    return Curves(along.time_s, depth, force, along.time_s, depth, read)


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
