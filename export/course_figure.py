"""Figure of a press over time: depth, force, charge of each electrode, and what is read."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

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


def _draw_curves(axes: Any, along: PressCourse, curves: dict[str, Floats], label: str) -> None:
    for name, values in curves.items():
        colour = SINGLE_CURVE_COLOUR if len(curves) == 1 else None
        (line,) = axes.plot(along.time_s, values, color=colour, lw=1.6, label=name)
        axes.plot(along.time_s[along.solved], values[along.solved], "o", ms=3.5, color=line.get_color())
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    if len(curves) > 1:
        axes.legend(frameon=False, fontsize=9)
