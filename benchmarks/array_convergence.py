"""Convergence of crosstalk matrices with the mesh: the paper's final design as an array (the table of docs/array.md).

    python -m benchmarks.array_convergence OUT.json

Presses end at 0.3 mm. Errors are those of the largest entry: the largest difference of any charge from that on the
finest mesh, over the largest charge. What was solved is in softdot's cache, so that a run that was stopped goes on.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from softdot.arrays.case import ArrayCase
from softdot.arrays.matrix import CrosstalkMatrix, crosstalk
from softdot.arrays.presses import ArrayPresses
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from

SIZES_MM = ((0.8, 0.25), (0.55, 0.17), (0.4, 0.12))
ARRAYS = {"2 columns, 3 rows": (2, 3), "5 columns, 1 row": (5, 1)}
JOINED: dict[str, dict[str, list[str]]] = {
    "film and media run through": {"shared": ["film", "medium1", "medium2"]},
    "only the film runs through": {"shared": ["film"]},
    "a grid holds all but medium 2": {
        "shared": ["film", "medium2"],
        "grid_layers": ["effector", "medium1", "film"],
    },
}


def matrix(columns: int, rows: int, joined: dict[str, list[str]], sizes_mm: tuple[float, float]) -> CrosstalkMatrix:
    """Of segments of 2.3 mm with a free rim, on elements of two sizes."""
    tables = {
        "segment": {"length_mm": 2.3, "width_mm": 2.3, "boundary": "free"},
        "array": {"columns": columns, "rows": rows, **joined},
        "press": {"indentation_mm": 0.3, "load_steps": 2},
        "mesh": dict(zip(("element_size_mm", "contact_element_size_mm"), sizes_mm, strict=True)),
    }
    return crosstalk(ArrayCase(config_from(with_default_design(tables))), ArrayPresses())


def row(found: CrosstalkMatrix) -> dict[str, Any]:
    """What is told of one mesh."""
    return {
        "charge_pC": found.charge_pC[:, -1].tolist(),
        "force_N": found.force_N[:, -1].tolist(),
        "crosstalk_percent": found.crosstalk_percent.tolist(),
        "largest_crosstalk_percent": found.largest_crosstalk_percent,
        "unknowns": max(press.unknowns for press in found.solved.values()),
        "solve_s": [press.solve_s for press in found.solved.values()],
    }


def main(path: Path) -> None:
    """Solve all and write the table, one design after the other."""
    table: dict[str, Any] = {}
    for shape, (columns, rows) in ARRAYS.items():
        for name, joined in JOINED.items():
            begun = time.time()
            meshes = {f"{sizes[0]}/{sizes[1]}": row(matrix(columns, rows, joined, sizes)) for sizes in SIZES_MM}
            finest = np.array(list(meshes.values())[-1]["charge_pC"])
            for one in meshes.values():
                one["error_percent"] = float(
                    100 * np.abs(np.array(one["charge_pC"]) - finest).max() / np.abs(finest).max()
                )
            table[f"{shape}: {name}"] = meshes
            path.write_text(json.dumps(table, indent=1), "utf-8")
            errors = ", ".join(f"{size} mm {one['error_percent']:.2f} %" for size, one in meshes.items())
            print(f"{shape}, {name}: {errors} ({time.time() - begun:.0f} s)", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
