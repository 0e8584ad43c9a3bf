"""How time and memory of a Newton step grow with the unknowns: python -m benchmarks.growth JSON [LARGEST].

LARGEST : thousands of unknowns, 1000 if not given; in double precision 500 at most. Each size runs in a process of its
own, so the peak of memory is its own too; sizes that the file has are not measured again. Exponents are fitted to the
sizes above 25 000 unknowns.
"""

import sys
from pathlib import Path

import numpy as np

from benchmarks.timing import Table, file_argument, run_alone

CELLS = {7: 6, 15: 8, 30: 10, 60: 13, 100: 15, 160: 18, 300: 22, 500: 27, 1000: 34}  # thousands of unknowns: cells
UP_TO = {"double": 500, "single": 1000}


def exponents(rows: list[dict]) -> dict[str, float]:
    """Slope of the logarithms against that of the unknowns, for each phase, the memory and the factor."""
    large = [row for row in rows if row["unknowns"] > 25_000]
    if len(large) < 2:
        return {}
    size = np.log([row["unknowns"] for row in large])
    series = {name: [row["seconds"][name] for row in large] for name in large[0]["seconds"]}
    for name in ("peak_GB", "factor_entries", "factor_gflop"):
        series[name] = [row[name] for row in large]
    return {name: float(np.polyfit(size, np.log(values), 1)[0]) for name, values in series.items()}


def of_precision(rows: list[dict], precision: str) -> list[dict]:
    """Of the factorisation."""
    return [row for row in rows if row["precision"] == precision]


def efficiency(row: dict) -> tuple[float, float]:
    """Share of the dense product's speed in the factorisation, and of the read's in the back substitution.

    The back substitution reads the factor twice, eight bytes an entry in double precision; the product is in double.
    """
    speed = row["factor_gflop"] / row["seconds"]["factorise"]
    entry_GB = 8e-9 if row["precision"] == "double" else 4e-9
    traffic = 2 * entry_GB * row["factor_entries"] / row["seconds"]["back substitute"]
    return speed / row["dgemm_gflops"], traffic / row["read_gb_s"]


def show(rows: list[dict]) -> None:
    """Where the time goes, and how close it is to what the machine can do."""
    for row in rows:
        text = "  ".join(f"{name} {value:.3f}" for name, value in row["seconds"].items())
        flops, bytes_ = efficiency(row)
        shares = f"{100 * flops:.0f} % of dgemm, {100 * bytes_:.0f} % of read"
        print(f"{row['unknowns']:>7} {text}  {row['peak_GB']:.2f} GB  {shares}")
    print({name: round(value, 2) for name, value in exponents(rows).items()})


def main(path: Path, largest: int) -> None:
    """Measure what is missing."""
    table = Table(path, "growth")
    for precision, most in UP_TO.items():
        for size, cells in CELLS.items():
            if size <= min(largest, most) and not table.has(cells=cells, precision=precision):
                table.add(run_alone("growth_point", cells, precision))
        show(of_precision(table.rows, precision))


if __name__ == "__main__":
    main(file_argument(), int(sys.argv[2]) if len(sys.argv) > 2 else max(CELLS))
