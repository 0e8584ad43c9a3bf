"""The picture of the speed measurements: python -m benchmarks.plot docs/speed.json docs/pictures/speed.png."""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from benchmarks.growth import exponents, of_precision
from benchmarks.press import CODES, errors, of_code
from benchmarks.timing import file_argument

PHASES = ("assemble", "factorise", "back substitute", "gmres")


def newton_step(axes: plt.Axes, rows: list[dict]) -> None:
    """Assembly and the whole step of each code on the mixed element."""
    rows = [row for row in rows if row["law"] == "mixed" and row["code"] != "scikit-fem"]
    names = [f"{row['unknowns'] // 1000} k  {row['code']}" for row in rows]
    assembly = np.array([row["seconds"]["assemble"] for row in rows])
    axes.plot(assembly, names, "o", ms=8, label="assembly")
    axes.plot([row["seconds"]["total"] for row in rows], names, "s", ms=8, label="whole step")
    axes.set(xscale="log", xlabel="seconds of one Newton step", xlim=(0.5 * assembly.min(), None))
    axes.invert_yaxis()
    axes.legend(frameon=False)


def growth(axes: plt.Axes, rows: list[dict]) -> None:
    """Time of each phase and peak memory against the unknowns, with fitted exponents, as a press factorises."""
    rows = of_precision(rows, "single")
    unknowns, slope = [row["unknowns"] for row in rows], exponents(rows)
    for phase in PHASES:
        seconds = [row["seconds"][phase] for row in rows]
        axes.loglog(unknowns, seconds, "o-", label=f"{phase} (s), exponent {slope.get(phase, np.nan):.2f}")
    memory = [row["peak_GB"] for row in rows]
    axes.loglog(unknowns, memory, "k:", label=f"peak memory (GB), exponent {slope.get('peak_GB', np.nan):.2f}")
    axes.set(xlabel="unknowns")
    axes.legend(frameon=False, fontsize=11)


def press(axes: plt.Axes, rows: list[dict]) -> None:
    """Time of the whole press against its error."""
    for code in CODES:
        seconds = [row["seconds"] for row in of_code(rows, code)]
        axes.loglog(100.0 * errors(rows, code), seconds, "o-", label=code)
    axes.set(xlabel="error of force or voltage (%)", ylabel="seconds of the whole press")
    axes.legend(frameon=False)


PANELS = {"newton_step": newton_step, "growth": growth, "press": press}


def main(table: Path, picture: Path) -> None:
    """One panel for each section that the file has."""
    sections = json.loads(table.read_text(encoding="utf-8"))
    present = [name for name in PANELS if name in sections]
    plt.rcParams["font.size"] = 13
    figure, axes = plt.subplots(len(present), 1, figsize=(9.0, 5.0 * len(present)), layout="constrained", squeeze=False)
    for name, panel in zip(present, axes[:, 0], strict=True):
        PANELS[name](panel, sections[name]["rows"])
        panel.grid(alpha=0.3)
    figure.savefig(picture, dpi=130)


if __name__ == "__main__":
    main(file_argument(), file_argument(2))
