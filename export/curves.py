"""Reaction force and voltage against indentation or time."""

from pathlib import Path
from typing import Any

import numpy as np

from export.view import DPI, HEIGHT_IN, INK, WIDTH_IN, save
from mesh.types import Floats

RED, GREEN = "#b5263b", "#3f7a4d"


def draw_curves(
    abscissa: tuple[Floats, str],
    reaction_force_N: Floats,
    open_circuit_voltage_V: Floats,
    readout_voltage_V: Floats | None,
    path: Path,
) -> None:
    """Two panels over the abscissa, its values (s,) and label. Arrays of shape (s,)."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    x, below = abscissa
    figure = Figure(
        figsize=(WIDTH_IN, HEIGHT_IN * 0.6),
        dpi=DPI,
        facecolor="white",
        layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.1),
    )
    force, voltage = figure.subplots(1, 2)
    force.plot(x, reaction_force_N, "o-", color="#33658a", lw=1.8, ms=4)
    _label(force, below, "reaction force (N)")
    scale, unit = _voltage_unit(open_circuit_voltage_V)
    lines = voltage.plot(x, scale * open_circuit_voltage_V, "o-", color=RED, lw=1.8, ms=4, label="open circuit")
    _label(voltage, below, f"voltage ({unit})")
    if readout_voltage_V is not None:
        lines += _plot_readout(voltage, x, open_circuit_voltage_V, readout_voltage_V)
    voltage.legend(handles=lines, frameon=False, fontsize=11, loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
    save(figure, path)


def _plot_readout(axes: Any, x: Floats, open_V: Floats, readout_V: Floats) -> list[Any]:
    """Beside the open-circuit voltage, or on a scale of its own where it would look like nothing."""
    scale, unit = _voltage_unit(open_V)
    label = "read-out"
    if np.abs(readout_V).max() < 0.1 * np.abs(open_V).max():
        axes = axes.twinx()
        scale, unit = _voltage_unit(readout_V)
        axes.set_ylabel(f"read-out voltage ({unit})", fontsize=12, color=GREEN)
        axes.tick_params(labelsize=11, colors=GREEN)
        axes.spines["top"].set_visible(False)
        label += " (right)"
    return list(axes.plot(x, scale * readout_V, "s--", color=GREEN, lw=1.6, ms=4, label=label))


def _voltage_unit(voltage_V: Floats) -> tuple[float, str]:
    return (1e3, "mV") if np.abs(voltage_V).max() < 1.0 else (1.0, "V")


def _label(axes: Any, below: str, label: str) -> None:
    axes.set_xlabel(below, fontsize=12, color=INK)
    axes.set_ylabel(label, fontsize=12, color=INK)
    axes.grid(alpha=0.3)
    axes.locator_params(axis="x", nbins=5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=11)
