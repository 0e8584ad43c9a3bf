"""Statements of the paper that its formulas alone decide."""

from softdot.studies.paper.analytical.composite import bending_stiffness_Nm
from softdot.studies.paper.analytical.softness import output_m
from softdot.studies.paper.analytical.stack import FILM, medium1, stiffness_ratio
from softdot.studies.paper.analytical.tables import FORMULAS, formula_values, is_misprint
from softdot.studies.paper.published import published_numbers, table_rows
from softdot.studies.paper.section import Claim


def claims() -> list[Claim]:
    """Tables, maximum of Eq. (8), neglect of the film."""
    return [_tables(), _aspect(), _maximum(), _neglect()]


def _tables() -> Claim:
    wrong = [
        f"{key.split('.', 1)[1]} = {number.value:g} is {ours:.3g}"
        for table in ("table3", "table4")
        for case in table_rows(table)
        for column, ours in formula_values(table)[case].items()
        if column in FORMULAS and is_misprint(number := published_numbers()[key := f"{table}.{case}.{column}"], ours)
    ]
    return Claim("Tables 3 and 4 follow from Eqs. (3) to (11).", not wrong, "All but: " + "; ".join(wrong) + ".")


def _aspect() -> Claim:
    ratios = [2.5 / (row["h1_mm"] + row["h2_mm"]) for row in table_rows("table3").values()]
    low, high = min(ratios), max(ratios)
    inside = low > 0.5 and high < 1
    return Claim("0.5 < l/(h₁ + h₂) < 1 for all segments.", inside, f"It lies between {low:.3f} and {high:.3f}.")


def _maximum() -> Claim:
    outputs = [output_m(1.0, 1.0, ratio) for ratio in (0.2, 0.5, 1.0, 2.5, 5.0)]
    return Claim(
        "Eq. (8) gives the largest free output where S₂/S₁ ≈ 1.",
        outputs[2] > max(outputs[:2] + outputs[3:]) * (1 + 1e-9),
        "With equal factors α the two deflections add up to u₂ at every S₂/S₁ of the middle line; S₂/S₁ from 0.2 to 5 "
        f"gives {min(outputs):.3g} to {max(outputs):.3g} of α u₂.",
    )


def _neglect() -> Claim:
    ratio = bending_stiffness_Nm([FILM, medium1(0.8)]) / medium1(0.8).own_bending_stiffness_Nm
    return Claim(
        "The film can be neglected beside medium 1, since S₁b ≪ S_Pb.",
        ratio < 1.1,
        f"On one side of 0.8 mm of medium 1 the film makes the beam {ratio:.1f} times stiffer in bending and "
        f"{1 + stiffness_ratio(0.8):.0f} times in the plane.",
    )
