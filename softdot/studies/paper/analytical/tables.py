"""Tables 3 and 4 of the paper from its formulas, each printed value beside ours."""

from collections.abc import Callable, Mapping

from softdot.studies.paper.analytical.beam import bending_softness
from softdot.studies.paper.analytical.softness import index_of_modulus, index_of_thickness, output_m, regime, softness
from softdot.studies.paper.published import Published, published_numbers, table_rows
from softdot.studies.paper.section import Answer, Cell, PaperTable
from softdot.studies.paper.segment import LENGTH_MM

MM, MPA, PER_MPA = 1e-3, 1e6, 1e6
Row = Mapping[str, float]


def softness_per_MPa(thickness_mm: float, modulus_MPa: float) -> float:
    """Eq. (6) for the segment's length, in 1e-6/Pa."""
    return PER_MPA * softness(MM * thickness_mm, MM * LENGTH_MM, MPA * modulus_MPa)


def bending_softness_per_MPa(height_mm: float, modulus_MPa: float) -> float:
    """Eq. (11) for the segment's length, in 1e-6/Pa."""
    return PER_MPA * bending_softness(MM * LENGTH_MM, MPA * modulus_MPa, MM * height_mm)


def _s1(row: Row) -> float:
    return softness_per_MPa(row["h1_mm"], row["E1_MPa"])


def _s2(row: Row) -> float:
    return softness_per_MPa(row["h2_mm"], row["E2_MPa"])


FORMULAS: dict[str, Callable[[Row], float]] = {
    "f": lambda row: index_of_thickness(row["h1_mm"], row["h2_mm"]),
    "e": lambda row: index_of_modulus(row["E1_MPa"], row["E2_MPa"]),
    "S1": _s1,
    "S2": _s2,
    "S2/S1": lambda row: _s2(row) / _s1(row),
    "S1b": lambda row: bending_softness_per_MPa(row["h1_mm"], row["E1_MPa"]),
}
HEADS = {"S1": "S₁ (10⁻⁶/Pa)", "S2": "S₂ (10⁻⁶/Pa)", "S2/S1": "S₂/S₁", "S1b": "S₁b (10⁻⁶/Pa)"}


def formula_values(table: str) -> dict[str, dict[str, float]]:
    """Values by the paper's formulae, case -> column -> value, of "table3" or "table4"."""
    return {
        case: {column: FORMULAS[column](row) for column in row if column in FORMULAS}
        for case, row in table_rows(table).items()
    }


def answers(table: str) -> dict[str, Answer]:
    """Our values of a table's cells; what the authors chose is taken over."""
    ours = formula_values(table)
    return {
        f"{table}.{case}.{column}": Answer(ours[case].get(column, printed))
        for case, row in table_rows(table).items()
        for column, printed in row.items()
    }


def comparison(table: str) -> PaperTable:
    """One row a case; a printed value that the formula does not give is marked beside ours."""
    rows = table_rows(table)
    columns = [column for column in next(iter(rows.values())) if column in FORMULAS]
    ours = formula_values(table)
    given = ["h1_mm", "E2_MPa"]
    return PaperTable(
        f"paper-{table}",
        f"Table {table[-1]} of the paper, from its formulas",
        ["case", "h₁ (mm)", "E₂ (MPa)", *(HEADS.get(column, column) for column in columns)],
        [
            [case, *(row[name] for name in given), *(_cell(f"{table}.{case}.{c}", ours[case][c]) for c in columns)]
            for case, row in rows.items()
        ],
        "E₁ = 5 MPa and h₂ = 2 mm in every case. A cell with an arrow: printed value → value by the paper's own "
        "formula; all others agree within the digits that are printed.",
    )


def regime_table() -> PaperTable:
    """Eq. (8) for the free cases, with both unknown factors taken as 1."""
    words = {"medium1": "S₂ ≫ S₁: medium 1 alone", "both": "S₂ ≈ S₁: both", "medium2": "S₁ ≫ S₂: medium 2 alone"}
    rows: list[list[Cell]] = []
    for case, row in formula_values("table3").items():
        pair = row["S1"], row["S2"]
        rows.append([case, row["S2/S1"], words[regime(*pair)], float(f"{output_m(1.0, *pair):.4g}")])
    return PaperTable(
        "free-regimes",
        "Which line of Eq. (8) holds for the free cases",
        ["case", HEADS["S2/S1"], "line of Eq. (8)", "predicted output / (α u₂)"],
        rows,
        "The paper gives no number for ≫; ten times is taken. Its factors α₁, α₂ are unknown and taken as 1.",
    )


def _cell(key: str, ours: float) -> Cell:
    number = published_numbers()[key]
    return f"{number.value:g} → {ours:.3g} (misprint)" if is_misprint(number, ours) else float(f"{ours:.6g}")


def is_misprint(number: Published, ours: float) -> bool:
    """Whether the printed digits are not those of our value, rounded."""
    digits = f"{number.value:g}"
    decimals = len(digits.partition(".")[2])
    return abs(ours - number.value) > 0.5000001 * 10.0**-decimals
