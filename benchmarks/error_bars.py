"""Stated against true discretisation errors of random designs: python -m benchmarks.error_bars JSON [FIRST COUNT].

The true error is that against the same press on a mesh with four times the unknowns. Designs are drawn anew from their
number; rows that the file has are not computed again. The constants of the estimate were chosen on designs 0 to 39 and
100 to 123, so that 40 others are counted.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.timing import Table, file_argument
from softdot.case import Case
from softdot.summary import press_part
from softdot.tolerances.discretisation import SIZE_RATIOS, Answers, answers_from_summary, discretisation_error

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


def pressed(tables: dict[str, Any], factor: float) -> tuple[list[float], int]:
    """Force and the voltage of each electrode at full depth on elements larger by the factor, and the unknowns."""
    config = Case(**tables).config
    case = Case(config.model_copy(update={"mesh": config.mesh.scale_sizes(factor)}))
    result = case.solve()
    if not result.converged:
        raise SystemExit(f"{tables}: {result.failure}")
    found = answers_from_summary(press_part(case.model, result, case.course(result)))
    return [float(found.force_N[-1]), *map(float, found.electrode_voltages_V[-1])], result.unknowns


def answers(row: dict, mesh: str) -> Answers:
    """As the product compares them; all electrodes in parallel are not kept."""
    force, *voltages = row[mesh]
    return Answers(np.array([force]), np.zeros(1), np.array([voltages]))


def errors(row: dict) -> set[tuple[float, float]]:
    """Stated and true error in percent of force and voltages; mirrored electrodes count once."""
    stated = discretisation_error(answers(row, "1"), {ratio: answers(row, f"{ratio:g}") for ratio in SIZE_RATIOS})
    true = 100.0 * np.abs(np.array(row["1"]) / np.array(row["reference"]) - 1.0)
    both = zip([stated.force_percent, *stated.electrodes_percent], true, strict=True)
    return {(round(float(one), 6), round(float(other), 6)) for one, other in both}


def counted(rows: list[dict]) -> dict[str, float]:
    """How many of all numbers their bars cover, and how many times too wide they are in the median."""
    stated, true = np.array([pair for row in rows for pair in errors(row)]).T
    return {
        "numbers": len(true),
        "covered %": round(100.0 * float(np.mean(stated >= true)), 1),
        "median of stated over true": round(float(np.median(stated / true)), 2),
    }


def main(path: Path, first: int = 40, count: int = 40) -> None:
    """Compute what the file has not."""
    table = Table(path, "error bars")
    for number in range(first, first + count):
        if table.has(design=number):
            continue
        tables = design(number)
        row: dict[str, Any] = {
            "design": number,
            "mesher": tables["mesh"]["mesher"],
            "section": tables["segment"]["section"],
            "boundary": tables["segment"]["boundary"],
            "shape": tables["segment"].get("effector", {}).get("shape"),
        }
        factors = {"1": 1.0, **{f"{ratio:g}": ratio for ratio in SIZE_RATIOS}, "reference": FOUR_TIMES[row["section"]]}
        for name, factor in factors.items():
            row[name], row[f"{name} unknowns"] = pressed(tables, factor)
        table.add(row)
    print(counted(table.rows))


if __name__ == "__main__":
    main(file_argument(), *(int(one) for one in sys.argv[2:4]))
