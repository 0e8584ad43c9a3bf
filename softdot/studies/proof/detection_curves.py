"""The picture of a proof: rates of detection and naming against the size of the effect."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from softdot.studies.proof.world.cases import SIZES

CURVES = (
    ("detected", "detected", "#7a7a7a"),
    ("named", "named, or in a fair group", "#0a5c8a"),
    ("wrong", "wrongly named", "#b3412e"),
)


def draw(by_size: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Rates with Wilson's intervals, one point for each bin of sizes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    axes = figure.subplots()
    for shift, (key, words, colour) in enumerate(CURVES):
        place = [one["median"] * (1.0 + 0.03 * (shift - 1)) for one in by_size]
        rates = [100.0 * one[key]["rate"] for one in by_size]
        reach = [
            [max(0.0, 100.0 * (one[key]["rate"] - one[key]["low"])) for one in by_size],
            [max(0.0, 100.0 * (one[key]["high"] - one[key]["rate"])) for one in by_size],
        ]
        axes.errorbar(
            place, rates, reach, color=colour, marker="o", markersize=4, capsize=2, linewidth=1.2, label=words
        )
    axes.set(
        xscale="log",
        ylim=(-3, 103),
        xlabel="size of the effect: whitened rms per sample, nuisances removed",
        ylabel="share of cases, %",
    )
    axes.set_xticks(SIZES, labels=[f"{size:g}" for size in SIZES])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.savefig(path, dpi=150)
