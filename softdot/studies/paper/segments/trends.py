"""The trends that the paper lists, put to the test in both readings."""

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from softdot.studies.paper.analytical.softness import output_m
from softdot.studies.paper.analytical.tables import formula_values
from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.section import Claim
from softdot.studies.paper.segment import Reading
from softdot.studies.paper.segments.cases import ADDED_PAIRS, PAIRS, title
from softdot.studies.paper.segments.presses import SolvedPress, Study

Presses = Mapping[str, SolvedPress]
Verdict = tuple[bool | None, str]
Test = Callable[[Presses], Verdict]
SHORT_NAMES: dict[Reading, str] = {"plane-strain": "cross-section", "solid": "true segment"}
READING_NAMES: dict[Reading, str] = {"plane-strain": "cross-section, 16 mm", "solid": "true segment, round dot"}
SERIES: tuple[tuple[str, ...], ...] = (
    ("F1", "F2", "F3"),
    ("F4", "F5", "F6"),
    ("C1", "C3", "C5"),
    ("C2", "C4", "C6"),
    ("final-free", "F4-E2-1"),
    ("final-clamped", "C1-E2-1"),
)
"""From the thinnest to the thickest medium 1, the rest equal."""
TIE = 0.02
"""Two values closer than this count as equal: sizes that nobody knows and the mesh are worth as much."""
FAR_BELOW = 5.0
"""How many times smaller "far below" and "much higher" mean here."""


def claims(study: Study) -> list[Claim]:
    """Claims on every trend in every reading."""
    return [
        Claim(text, *test(presses), SHORT_NAMES[reading])
        for text, test in TRENDS.items()
        for reading, presses in study.readings.items()
    ]


def _millivolts(presses: Presses, *names: str) -> str:
    return ", ".join(f"{title(name)}: {presses[name].calibrated_mV:.3g} mV" for name in names) + "."


def _newtons(presses: Presses, *names: str) -> str:
    return ", ".join(f"{title(name)}: {presses[name].force_N:.3g} N" for name in names) + "."


def in_order(values: Sequence[float]) -> bool | None:
    """Whether each value is above the next; None when two are equal within TIE and none is out of order."""
    ratios = [high / low for high, low in pairwise(values)]
    if min(ratios) < 1.0 - TIE:
        return False
    return True if min(ratios) > 1.0 + TIE else None


def all_hold(verdicts: Sequence[bool | None]) -> bool | None:
    """True when all hold, False when one does not, else undecided."""
    return False if False in verdicts else None if None in verdicts else True


def _falling(*names: str) -> Test:
    """The voltages fall in this order."""
    return lambda presses: (_falls(presses, names), _millivolts(presses, *names))


def _falls(presses: Presses, names: Sequence[str]) -> bool | None:
    return in_order([presses[name].calibrated_mV for name in names])


def _soft_far_below(presses: Presses) -> Verdict:
    soft = max(presses[name].calibrated_mV for name in ("F4", "F5", "F6"))
    hard = min(presses[name].calibrated_mV for name in ("F1", "F2", "F3"))
    return hard > FAR_BELOW * soft, _millivolts(presses, "F1", "F2", "F3", "F4", "F5", "F6")


def _clamped_above_free(times: float) -> Test:
    """Clamped voltages so many times the free ones of the same layers, or more."""

    def test(presses: Presses) -> Verdict:
        ratios = {pair: presses[pair[0]].calibrated_mV / presses[pair[1]].calibrated_mV for pair in PAIRS}
        words = ", ".join(f"{clamped}/{free} {ratio:.3g}" for (clamped, free), ratio in ratios.items())
        return all_hold([in_order((ratio, times)) for ratio in ratios.values()]), f"Ratios of voltage: {words}."

    return test


def _thinner_is_better(presses: Presses) -> Verdict:
    verdicts = {series: _falls(presses, series) for series in SERIES}
    doubtful = [series for series, holds in verdicts.items() if not holds]
    words = " ".join(_millivolts(presses, *series) for series in doubtful)
    return all_hold(list(verdicts.values())), f"Not clearly so: {words}" if doubtful else "So in all six series."


def _softer_backing(presses: Presses) -> Verdict:
    verdicts = [_falls(presses, names) for names in (("C1", "C2"), ("F1", "F4"))]
    return all_hold(verdicts), _millivolts(presses, "C1", "C2", "F1", "F4")


def _criterion(presses: Presses) -> Verdict:
    limit = published_numbers()["section4.criterion"].value
    sums = {pair: sum(presses[name].calibrated_mV for name in pair) for pair in ADDED_PAIRS}
    words = ", ".join(f"{' + '.join(pair)} {value:.3g} mV" for pair, value in sums.items())
    return min(sums.values()) >= limit, f"{words}, against {limit:g} mV."


def _final_is_better(presses: Presses) -> Verdict:
    verdicts = [_falls(presses, names) for names in (("final-free", "F4"), ("final-clamped", "C1"))]
    return all_hold(verdicts), _millivolts(presses, "final-free", "F4", "final-clamped", "C1")


def _force_of_harder_backing(presses: Presses) -> Verdict:
    names = ("F4-E2-1", "F4", "C1-E2-1", "C1")
    forces = [presses[name].force_N for name in names]
    return all_hold([in_order(forces[:2]), in_order(forces[2:])]), _newtons(presses, *names)


def _force_of_thinner_medium(presses: Presses) -> Verdict:
    """Whether a thinner medium 1 needs more force, as the paper has it."""
    names = ("final-clamped", "C1-E2-1")
    return in_order([presses[name].force_N for name in names]), _newtons(presses, *names)


def _proportional(presses: Presses) -> Verdict:
    names = ("F1", "final-free", "C1", "final-clamped")
    exponents = {name: presses[name].exponent for name in names}
    words = ", ".join(f"{title(name)} {value:.2f}" for name, value in exponents.items())
    return max(abs(value - 1) for value in exponents.values()) < 0.1, f"n of V ~ uⁿ from half to full depth: {words}."


def _bending_softness(presses: Presses) -> Verdict:
    """Ratios of voltage against ratios of bending softness, Eq. (12), over the soft medium 2."""
    softness = {case: row["S1b"] for case, row in formula_values("table4").items()}
    checks = [
        (f"{a}/{b}", presses[a].calibrated_mV / presses[b].calibrated_mV, softness[a] / softness[b])
        for a, b in (("C1", "C3"), ("C3", "C5"))
    ]
    words = ", ".join(f"{pair} {ratio:.3g} where S₁b asks for {law:.3g}" for pair, ratio, law in checks)
    return all(abs(ratio / law - 1.0) < 0.25 for _, ratio, law in checks), f"Ratios of voltage: {words}."


def _equation8(presses: Presses) -> Verdict:
    """Free outputs over soft backing against Eq. (8) with equal factors; F2 is the unit."""
    rows = formula_values("table3")
    checks = [
        (name, presses[name].calibrated_mV / presses["F2"].calibrated_mV, output_m(1.0, row["S1"], row["S2"]))
        for name, row in rows.items()
        if name in ("F4", "F5", "F6")
    ]
    words = ", ".join(f"{name}/F2 {ratio:.2g} against {law:.2g}" for name, ratio, law in checks)
    return all(0.5 < ratio / law < 2.0 for _, ratio, law in checks), f"{words}."


TRENDS: dict[str, Test] = {
    "Free sides, hard backing: F1 > F2 > F3.": _falling("F1", "F2", "F3"),
    f"Free sides: F4 to F6 lie far below F1 to F3 (by {FAR_BELOW:g} times or more).": _soft_far_below,
    "Free sides: the output is largest where S₂/S₁ ≈ 1, at F2.": lambda presses: (
        presses["F2"].calibrated_mV > max(presses[name].calibrated_mV for name in ("F1", "F3")),
        _millivolts(presses, "F1", "F2", "F3"),
    ),
    "Free sides: Eq. (8) estimates the output with a good approximation (within a factor of 2).": _equation8,
    "Clamped sides: C1 > C3, a thinner medium 1 gives more.": _falling("C1", "C3"),
    "Clamped sides: C1 > C2, a softer medium 2 gives more.": _falling("C1", "C2"),
    "Clamped sides: the output is proportional to the bending softness (within 25 %).": _bending_softness,
    "Clamped sides give more than free sides with the same layers.": _clamped_above_free(1.0),
    f"Clamped sides give far more, {FAR_BELOW:g} times or more, with the same layers.": _clamped_above_free(FAR_BELOW),
    "A thinner medium 1 gives more, with free and with clamped sides.": _thinner_is_better,
    "A softer medium 2 gives more with clamped and less with free sides.": _softer_backing,
    "C1 + F4, C2 + F1 and C4 + F2 all reach the 50 mV of the criterion.": _criterion,
    "The final design gives more than F4 free and more than C1 clamped.": _final_is_better,
    "A medium 2 of 1 MPa instead of 0.05 MPa raises the force, free and clamped.": _force_of_harder_backing,
    "A medium 1 of 0.5 mm instead of 0.8 mm raises the clamped force.": _force_of_thinner_medium,
    "The voltage is proportional to the depth, so that D = V/u₂ is a constant.": _proportional,
}
