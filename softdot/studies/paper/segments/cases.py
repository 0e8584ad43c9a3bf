"""The presses of the paper's section 4, by the names that it gives them."""

from dataclasses import dataclass

from softdot.studies.paper.segment import Boundary

SOFT_MPA, RUBBER_MPA, HARD_MPA = 0.05, 1.0, 5.0
"""Young's modulus of medium 2: both values of the tables, and the example in the text."""


@dataclass(frozen=True)
class PaperCase:
    """One press: sides, thickness of medium 1 and Young's modulus of medium 2."""

    name: str
    boundary: Boundary
    h1_mm: float
    e2_MPa: float


CASES = {
    case.name: case
    for case in (
        PaperCase("F1", "free", 0.8, HARD_MPA),
        PaperCase("F2", "free", 2.0, HARD_MPA),
        PaperCase("F3", "free", 4.0, HARD_MPA),
        PaperCase("F4", "free", 0.8, SOFT_MPA),
        PaperCase("F5", "free", 2.0, SOFT_MPA),
        PaperCase("F6", "free", 4.0, SOFT_MPA),
        PaperCase("C1", "clamped", 0.8, SOFT_MPA),
        PaperCase("C2", "clamped", 0.8, HARD_MPA),
        PaperCase("C3", "clamped", 2.0, SOFT_MPA),
        PaperCase("C4", "clamped", 2.0, HARD_MPA),
        PaperCase("C5", "clamped", 4.0, SOFT_MPA),
        PaperCase("C6", "clamped", 4.0, HARD_MPA),
        PaperCase("F4-E2-1", "free", 0.8, RUBBER_MPA),
        PaperCase("C1-E2-1", "clamped", 0.8, RUBBER_MPA),
        PaperCase("final-free", "free", 0.5, RUBBER_MPA),
        PaperCase("final-clamped", "clamped", 0.5, RUBBER_MPA),
    )
}
FREE, CLAMPED = ("F1", "F2", "F3", "F4", "F5", "F6"), ("C1", "C2", "C3", "C4", "C5", "C6")
PAIRS = (("C1", "F4"), ("C2", "F1"), ("C4", "F2"), ("C3", "F5"), ("C5", "F6"), ("C6", "F3"))
"""Clamped and free case of the same layers; the paper adds the voltages of the first three."""
ADDED_PAIRS = PAIRS[:3]
LATER_PAIRS = (("C1-E2-1", "F4-E2-1"), ("final-clamped", "final-free"))
TITLES = {
    "F4-E2-1": "F4 at E₂ = 1",
    "C1-E2-1": "C1 at E₂ = 1",
    "final-free": "final free",
    "final-clamped": "final clamped",
}


def title(name: str) -> str:
    """The name of a case for people."""
    return TITLES.get(name, name)


def together(pair: tuple[str, str]) -> str:
    """The name of a pair for people."""
    return {LATER_PAIRS[0]: "C1 + F4 at E₂ = 1", LATER_PAIRS[1]: "final"}.get(pair, " + ".join(pair))
