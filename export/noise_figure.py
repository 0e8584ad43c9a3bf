"""Figure of the noise of an amplifier: the spectrum of each part of it in the recorded voltage."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from export.course_figure import voltage_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE_IN = (8.0, 4.2)
FAINTEST = 1e-4
"""Of the largest density: below it nothing is drawn."""


def noise_figure(noise: Mapping[str, Any]) -> "Figure":
    """Densities over the frequency, both logarithmic; noise : that of summary.json.

    What has no spectrum, steps of a converter and hum, stands in the legend alone.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE_IN, facecolor="white", layout="constrained")
    axes = figure.subplots()
    frequency, densities = np.array(noise["frequency_Hz"]), noise["density_V_per_rtHz"]
    together = np.sqrt(sum((np.array(one) ** 2 for one in densities.values()), np.zeros_like(frequency)))
    for name, density in densities.items():
        axes.loglog(frequency, 1e9 * np.array(density), lw=1.5, label=_label(name, noise["parts_V"].get(name, 0.0)))
    for name in noise["parts_V"].keys() - densities.keys():
        axes.plot([], [], " ", label=_label(name, noise["parts_V"][name]))
    axes.loglog(frequency, 1e9 * together, "k--", lw=1.2, label=_label("together", noise["rms_V"]))
    axes.set(xlabel="frequency (Hz)", ylabel="density (nV/√Hz)")
    seen = frequency[together > FAINTEST * together.max()]
    axes.set_xlim(frequency[0], seen[-1])
    axes.set_ylim(FAINTEST * 1e9 * together.max(), 3.0 * 1e9 * together.max())
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9, title="root mean square", loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _label(name: str, value_V: float) -> str:
    """A part with its root mean square, such as 'resistor 2.03 µV'."""
    scale, unit = voltage_unit(np.array([value_V]))
    return f"{name} {scale * value_V:.3g} {unit}"
