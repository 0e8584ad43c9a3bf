"""Presses that nobody solved, with round numbers, for tests of words, tables and pages."""

from softdot.studies.paper.segments.cases import CASES, PaperCase
from softdot.studies.paper.segments.presses import CHECKED, VARIANTS, VARIED, SolvedPress, Study


def press(force_N: float = 1.0, millivolts: float = 100.0, exponent: float = 2.0) -> SolvedPress:
    """A press to 0.3 mm whose voltage is a power of the depth."""
    depths = (0.0, 0.15, 0.3)
    volts = tuple(0.337 * millivolts * (depth / 0.3) ** exponent for depth in depths)
    return SolvedPress(depths, tuple(force_N * depth / 0.3 for depth in depths), volts, 0.01, 20.0, 5000)


def study(**changes: SolvedPress) -> Study:
    """Every trend of the paper holds, but for the changed presses of the cross-section."""
    presses = {name: _paper_like(case) for name, case in CASES.items()}
    return Study(
        {"plane-strain": presses | changes, "solid": presses},
        {"plane-strain": presses[CHECKED], "solid": presses[CHECKED]},
        {variant: {name: presses[name] for name in VARIED} for variant in VARIANTS},
    )


def _paper_like(case: PaperCase) -> SolvedPress:
    """Thinner gives more; clamped far more; softer backing more when clamped and less when free."""
    if case.boundary == "free":
        return press(0.5 + case.e2_MPa, 20 * case.e2_MPa**0.7 / case.h1_mm, 1.0)
    return press(10 + case.e2_MPa - case.h1_mm, 400 * case.h1_mm**-1.5 / (1 + 0.3 * case.e2_MPa), 2.5)
