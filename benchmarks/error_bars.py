"""Stated against true discretisation errors of random designs: python -m benchmarks.error_bars JSON [FIRST COUNT].

The true error is that against the same press on a mesh with four times the unknowns. Designs are drawn anew from their
number; rows that the file has are not computed again.
"""

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.timing import Table, file_argument
from softdot.case import Case
from softdot.discretisation import RATIOS, Answers, answers_of, discretisation_error
from softdot.summary import press_part

FOUR_TIMES = {"solid": 4.0 ** (-1.0 / 3.0), "plane-strain": 4.0 ** (-1.0 / 2.0)}
MEDIA = ("vnr", "vnr-soft", "ecoflex-00-30", "ecoflex-00-50", "dragon-skin-30", "rtv615")


def design(number: int) -> dict[str, Any]:
    """Tables of a random design: every second one a slice; shapes, sizes, materials, sides, dots and depths vary."""
    rng = np.random.default_rng([18, number])
    solid = number % 2 == 0

    def between(low: float, high: float) -> float:
        return round(float(rng.uniform(low, high)), 3)

    length = between(2.0, 3.2)
    shape = str(rng.choice(["layer", "block", "cylinder", "dome", "none"] if solid else ["layer", "block", "none"]))
    segment: dict[str, Any] = {
        "length_mm": length,
        "width_mm": length if solid else between(4.0, 16.0),
        "section": "solid" if solid else "plane-strain",
        "boundary": str(rng.choice(["clamped", "free", "elastic"])),
        "medium1": {"thickness_mm": between(0.3, 0.9), "material": str(rng.choice(MEDIA))},
        "medium2": {"thickness_mm": between(1.0, 2.5), "material": str(rng.choice(MEDIA))},
        "film": {"thickness_um": float(rng.choice([28.0, 52.0, 110.0]))},
    }
    if shape != "none":
        table = effector(shape, length, between, str(rng.choice(["rubber", "dragon-skin-30"])))
        segment["effector"] = table if solid else {key: value for key, value in table.items() if key != "width_mm"}
    if segment["boundary"] == "elastic":
        segment["side_stiffness_N_per_mm3"] = between(1.0, 8.0)
    if solid and rng.random() < 0.3:
        half = round(0.5 * length - 0.1, 3)
        segment["film"]["electrodes"] = [
            {"name": name, "center_mm": [side * 0.25 * length, 0.0], "size_mm": [half, length]}
            for name, side in (("left", -1), ("right", 1))
        ]
    dot = {"shape": "cap", "standard": str(rng.choice(["marburg-medium", "ada"]))} if solid else {"shape": "ridge"}
    if not solid:
        dot["radius_mm"] = between(0.6, 1.5)
    offset = between(0.05, 0.3) if rng.random() < 0.25 else 0.0
    mesher = "layered" if shape != "dome" and rng.random() < 0.6 else "pytetwild"
    return {
        "segment": segment,
        "dot": {**dot, "offset_mm": [offset, 0.0]},
        "press": {"indentation_mm": between(0.1, 0.3), "load_steps": 3},
        "mesh": {"mesher": mesher},
    }


def effector(shape: str, length: float, between: Any, material: str) -> dict[str, Any]:
    """Its table."""
    table: dict[str, Any] = {"shape": shape, "height_mm": between(0.4, 0.6), "material": material}
    if shape == "block":
        table |= {"length_mm": 0.6 * length, "width_mm": 0.6 * length}
    if shape in ("cylinder", "dome"):
        table["diameter_mm"] = 0.6 * length
    return table


def pressed(tables: dict[str, Any], factor: float) -> tuple[Answers, int]:
    """Answers on elements that are larger by the factor, and the number of unknowns."""
    config = Case(**tables).config
    larger = config.model_copy(update={"mesh": config.mesh.scaled(factor)})
    result = Case(larger).solve()
    if not result.converged:
        raise SystemExit(f"{tables}: {result.failure}")
    return answers_of(press_part(None, result, None)), result.unknowns


def compared(tables: dict[str, Any]) -> dict[str, Any]:
    """Stated and true errors in percent, of the force and of each voltage."""
    fine, unknowns = pressed(tables, 1.0)
    larger = {ratio: pressed(tables, ratio)[0] for ratio in RATIOS}
    reference, reference_unknowns = pressed(tables, FOUR_TIMES[tables["segment"]["section"]])
    stated = discretisation_error(fine, larger)
    return {
        "unknowns": unknowns,
        "reference unknowns": reference_unknowns,
        "stated": [stated.force_percent, *stated.electrodes_percent],
        "true": [off(fine.force_N, reference.force_N), *off(fine.electrode_voltages_V, reference.electrode_voltages_V)],
    }


def off(found: np.ndarray, reference: np.ndarray) -> Any:
    """Error at the last step in percent."""
    return 100.0 * abs(found[-1] / reference[-1] - 1.0)


def counted(rows: list[dict]) -> dict[str, float]:
    """Of the force and the voltages of all designs: how many bars cover, and the median of how many times too wide."""
    pairs = [pair for row in rows for pair in distinct(zip(row["stated"], row["true"], strict=True))]
    stated, true = np.array(pairs).T
    return {
        "numbers": len(pairs),
        "covered %": round(100.0 * float(np.mean(stated >= true)), 1),
        "median of stated over true": round(float(np.median(stated / true)), 2),
    }


def distinct(pairs: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Mirrored electrodes have the same voltage, which counts once."""
    return list({(round(stated, 6), round(true, 6)): (stated, true) for stated, true in pairs}.values())


def main(path: Path, first: int = 0, count: int = 40) -> None:
    """Compute what the file has not."""
    table = Table(path, "error bars")
    for number in range(first, first + count):
        if table.has(design=number):
            continue
        tables = design(number)
        table.add({
            "design": number,
            "mesher": tables["mesh"]["mesher"],
            "section": tables["segment"]["section"],
            "boundary": tables["segment"]["boundary"],
            "shape": tables["segment"].get("effector", {}).get("shape"),
            **compared(tables),
        })  # fmt: skip
    print(counted(table.rows))


if __name__ == "__main__":
    main(file_argument(), *(int(one) for one in sys.argv[2:4]))
