"""The frictionless press of the true segment against NGSolve: python -m benchmarks.press JSON [FINEST].

Both codes press the same meshes of a quarter, held at its mirror planes, from coarse to fine (FINEST: smallest factor
on the default element sizes), each in the number of equal load steps in which it is quickest. The error is that of the
force and of the voltage against the limit of both codes' finest meshes at second order. Time at equal error is read
from straight lines through (log error, log time). Rows that the file has are not measured again.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.timing import Table, run_alone

FACTORS = (2.8, 2.0, 1.4, 1.0)
CODES = ("softdot", "NGSolve")
OUR_STEPS = (1, 2, 3)
STEPS = (3, 4, 6, 12)  # of NGSolve, the first of which is the quickest; it converged in 1 or 2 on none of the meshes
ANSWERS = ("force_N", "voltage_V")


def of_code(rows: list[dict], code: str) -> list[dict]:
    """From coarse to fine."""
    own = (row for row in rows if row["code"] == code and row["load_steps"] is not None)
    return sorted(own, key=lambda row: -row["factor"])


def limit(rows: list[dict], name: str) -> float:
    """Mean of the codes' limits at second order from their two finest meshes (Richardson)."""
    values = []
    for code in CODES:
        coarse, fine = of_code(rows, code)[-2:]
        ratio = (coarse["factor"] / fine["factor"]) ** 2
        values.append((ratio * fine[name] - coarse[name]) / (ratio - 1.0))
    return float(np.mean(values))


def errors(rows: list[dict], code: str) -> np.ndarray:
    """Larger of the relative errors of force and voltage, from coarse to fine."""
    own = of_code(rows, code)
    each = [[abs(row[name] / limit(rows, name) - 1.0) for row in own] for name in ANSWERS]
    return np.max(each, axis=0)


def seconds_at(rows: list[dict], code: str, error: float) -> float:
    """Time to reach an error, by the straight line through the logarithms."""
    own = np.log([row["seconds"] for row in of_code(rows, code)])
    slope, intercept = np.polyfit(np.log(errors(rows, code)), own, 1)
    return float(np.exp(intercept + slope * np.log(error)))


def show(rows: list[dict]) -> None:
    """Errors and times, and their ratio at the errors of our meshes."""
    for code in CODES:
        for row, error in zip(of_code(rows, code), errors(rows, code), strict=True):
            answers = f"{row['force_N']:.5f} N {row['voltage_V']:.4f} V"
            work = f"{row['newton_iterations']} iterations {row['seconds']:.1f} s"
            name = f"{code:<8} factor {row['factor']:<4} {row['unknowns']:>7}"
            print(f"{name} {answers} error {100 * error:.2f} % {work}")
    for row, error in zip(of_code(rows, "softdot"), errors(rows, "softdot"), strict=True):
        ratio = seconds_at(rows, "softdot", error) / seconds_at(rows, "NGSolve", error)
        print(f"at {100 * error:.2f} % (our factor {row['factor']}): ours/theirs {ratio:.2f}")


def by_softdot(factor: float, case: Path) -> dict:
    """Its press in the quickest of its load steps; the mesh is written for NGSolve."""
    return min((run_alone("press_ours", factor, steps, case) for steps in OUR_STEPS), key=lambda row: row["seconds"])


def by_ngsolve(case: Path) -> dict:
    """Its press in the first of its load steps that converges; no answers where none does."""
    for steps in STEPS:
        try:
            return run_alone("press_ngsolve", case, steps)
        except SystemExit as failure:
            print(f"NGSolve, {steps} steps: {str(failure).strip().splitlines()[-1]}", flush=True)
    return {"load_steps": None}


def main(path: Path, finest: float) -> None:
    """Measure what is missing."""
    table = Table(path, "press")
    for factor in (f for f in FACTORS if f >= finest):
        if all(table.has(factor=factor, code=code) for code in CODES):
            continue
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.npz"
            ours = by_softdot(factor, case)
            if not table.has(factor=factor, code="softdot"):
                table.add({"code": "softdot", "factor": factor, **ours})
            if not table.has(factor=factor, code="NGSolve"):
                table.add({"code": "NGSolve", "factor": factor, **by_ngsolve(case)})
    show(table.rows)


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else min(FACTORS))
