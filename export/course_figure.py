"""Figure of a press over time: depth, force, charge of each electrode, and what is read."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from foundation.arrays import Floats
from solve.readout.course import PressCourse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE_IN = (8.0, 5.0)
SINGLE_CURVE_COLOUR = "#33658a"


def course_figure(along: PressCourse, electrodes: Sequence[str]) -> "Figure":
    """Four panels over time; dots are the solved states.

    Voltages are those behind the amplifiers where there are any, else those of the open circuit.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE_IN, facecolor="white", layout="constrained")
    depth, force, charge, voltage = figure.subplots(2, 2, sharex=True).flat
    _draw_curves(depth, along, {"": 1e3 * along.indentation_m}, "indentation (mm)")
    _draw_curves(force, along, {"": along.reaction_force_N}, "reaction force (N)")
    _draw_curves(charge, along, dict(zip(electrodes, 1e12 * along.charge_C.T, strict=True)), "charge (pC)")
    read, label = along.voltage_V, "open-circuit voltage (V)"
    if along.channels_V is not None:
        read, label = along.channels_V, "read-out (V)"
    curves = dict(zip(electrodes, read.T, strict=True))
    if along.together_V is not None and len(electrodes) > 1:
        curves["together"] = along.together_V
    _draw_curves(voltage, along, curves, label)
    for axes in (charge, voltage):
        axes.set_xlabel("time (s)")
    return figure


def voltage_unit(voltage_V: Floats) -> tuple[float, str]:
    """Factor and unit in which voltages are easily read.

    >>> voltage_unit(np.array([0.0, 2.0])), voltage_unit(np.array([0.02])), voltage_unit(np.array([-2e-5]))
    ((1.0, 'V'), (1000.0, 'mV'), (1000000.0, 'µV'))
    """
    most = float(np.abs(voltage_V).max())
    return (1.0, "V") if most >= 1.0 else (1e6, "µV") if 0.0 < most < 1e-3 else (1e3, "mV")


def _draw_curves(axes: Any, along: PressCourse, curves: dict[str, Floats], label: str) -> None:
    """Curves over time with a dot at each solved state; volts in the unit in which they are easily read."""
    if label.endswith("(V)"):
        scale, unit = voltage_unit(np.concatenate(list(curves.values())))
        curves, label = {name: scale * values for name, values in curves.items()}, label.replace("(V)", f"({unit})")
    for name, values in curves.items():
        colour = SINGLE_CURVE_COLOUR if len(curves) == 1 else None
        (line,) = axes.plot(along.time_s, values, color=colour, lw=1.6, label=name)
        axes.plot(along.time_s[along.solved], values[along.solved], "o", ms=3.5, color=line.get_color())
    axes.set_ylabel(label)
    axes.locator_params(axis="x", nbins=6)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    if len(curves) > 1:
        axes.legend(frameon=False, fontsize=9)
