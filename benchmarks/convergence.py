"""How force and voltage of the default segment change with the element size, with a figure for the documents.

    python -m benchmarks.convergence docs/convergence.json docs/pictures/convergence.png

Every finished size is written at once, and a size that the file already holds is not run again. The sizes are factors
on the default ones (0.3 mm, 0.1 mm under the dot). The error of a mesh is its distance from the extrapolation of the
two finest meshes at second order, the order that the differences show.
"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from benchmarks.timing import file_argument
from softdot.case import Case
from softdot.config.loading import load_config

FACTORS = (2.0, 1.4, 1.0, 0.7, 0.5)


def measure(factor: float) -> dict:
    """Force and voltage of the default press on a mesh scaled by a factor, of a quarter."""
    config = load_config(None, ["press.load_steps=3"])  # elastic and frictionless: the path does not matter
    result = Case(config.model_copy(update={"mesh": config.mesh.scale_sizes(factor)})).solve()
    if not result.converged:
        raise SystemExit(result.failure)
    return {
        "factor": factor,
        "unknowns": result.unknowns,
        "force_N": result.steps[-1].reaction_force_N,
        "voltage_V": float(result.steps[-1].open_circuit_voltage_V[0]),
    }


def extrapolate(rows: list[dict], name: str) -> float:
    """Limit at second order from the two finest meshes (Richardson)."""
    coarse, fine = rows[-2], rows[-1]
    ratio = (coarse["factor"] / fine["factor"]) ** 2
    return (ratio * fine[name] - coarse[name]) / (ratio - 1.0)


def plot(rows: list[dict], path: Path) -> None:
    """Distance from the extrapolated value against the element size."""
    figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
    size = np.array([0.1 * row["factor"] for row in rows])
    for name, label in (("force_N", "reaction force"), ("voltage_V", "open-circuit voltage")):
        limit = extrapolate(rows, name)
        axes.loglog(size, [100 * abs(row[name] / limit - 1) for row in rows], "o-", label=label)
    axes.loglog(size, 0.4 * (size / 0.1) ** 2, "k:", label="second order")
    axes.set_xticks(size, [f"{s:g}" for s in size])
    percent = (0.1, 0.2, 0.5, 1, 2, 5)
    axes.set_yticks(percent, [f"{p:g}" for p in percent])
    axes.minorticks_off()
    axes.set(xlabel="element size under the dot (mm)", ylabel="distance from the limit (%)")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    figure.savefig(path, dpi=150)


def main(table: Path, picture: Path) -> None:
    """Run what is missing, then draw."""
    rows = json.loads(table.read_text(encoding="utf-8")) if table.exists() else []
    for factor in FACTORS:
        if all(row["factor"] != factor for row in rows):
            rows.append(measure(factor))
            table.write_text(json.dumps(rows, indent=1) + "\n", "utf-8")
            print(rows[-1], flush=True)
    rows.sort(key=lambda row: -row["factor"])
    for row in rows:
        change = [100 * (row[name] / extrapolate(rows, name) - 1) for name in ("force_N", "voltage_V")]
        print(f"factor {row['factor']:<4} force {change[0]:+.2f} %  voltage {change[1]:+.2f} %")
    plot(rows, picture)


if __name__ == "__main__":
    main(file_argument(), file_argument(2))
