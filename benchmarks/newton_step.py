"""One Newton step against NGSolve, FElupe and scikit-fem on the same mesh: python -m benchmarks.newton_step JSON.

Same nodes, state, law and quadrature points; every code must arrive at the same step, or the program stops. Medians
of five; each code in a process of its own, one after the other, with all cores. A row that the file has is not
measured again.
"""

import sys
from pathlib import Path

from benchmarks.timing import Table, file_argument, run_alone

CELLS = {30: 10, 100: 15, 300: 22}  # thousands of unknowns: cells along an edge
PEERS = (
    ("softdot", "mixed", "step_ours", ("mixed",), 300),
    ("NGSolve tuned", "mixed", "step_ngsolve", ("tuned",), 300),
    ("NGSolve default", "mixed", "step_ngsolve", ("default",), 30),  # minimum degree: minutes beyond
    ("FElupe u-p-J", "mixed", "step_felupe", ("mixed",), 100),
    ("scikit-fem", "mixed", "step_skfem", (), 30),
    ("softdot", "displacement", "step_ours", ("displacement",), 100),
    ("FElupe", "displacement", "step_felupe", ("displacement",), 100),
)
AGREEMENT = 1e-6


def check(rows: list[dict]) -> None:
    """SystemExit where two codes differ in the step."""
    first: dict = {}
    for row in rows:
        reference = first.setdefault((row["size"], row["law"]), row)
        difference = abs(row["step"]["corners"] / reference["step"]["corners"] - 1.0)
        if not difference < AGREEMENT:
            raise SystemExit(f"{row['code']} and {reference['code']} differ by {difference:.1e} in the step")


def show(rows: list[dict]) -> None:
    """Seconds of each code, and ours over theirs: whole step, assembly."""
    ours = {(r["size"], r["law"]): r["seconds"] for r in rows if r["code"] == "softdot"}
    for row in rows:
        own, seconds = ours[row["size"], row["law"]], row["seconds"]
        text = "  ".join(f"{phase} {value:.3f}" for phase, value in seconds.items())
        step, assembly = (own[phase] / seconds[phase] for phase in ("total", "assemble"))
        name = f"{row['unknowns']:>7} {row['law']:>12} {row['code']:<16}"
        print(f"{name} {text}   ours/theirs {step:.2f}, {assembly:.2f}")


def main(path: Path, largest: int) -> None:
    """Measure what is missing."""
    table = Table(path, "newton_step")
    for size, cells in CELLS.items():
        for code, law, program, arguments, limit in PEERS:
            if size <= min(limit, largest) and not table.has(size=size, code=code, law=law):
                table.add({"size": size, "code": code, "law": law, **run_alone(program, cells, *arguments)})
                check(table.rows)
    show(table.rows)


if __name__ == "__main__":
    main(file_argument(), int(sys.argv[2]) if len(sys.argv) > 2 else max(CELLS))
