"""What the presses say, in sentences made from their numbers."""

from collections.abc import Callable

from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.segment import segment_config
from softdot.studies.paper.segments import tables
from softdot.studies.paper.segments.answers import FORCE_CASES, answers
from softdot.studies.paper.segments.cases import ADDED_PAIRS, CASES, LATER_PAIRS, PAIRS, title
from softdot.studies.paper.segments.presses import SolvedPress, Study
from softdot.studies.paper.segments.trends import SHORT_NAMES, claims

FINAL = "final-clamped"
VERDICTS = {True: "true", False: "false", None: "undecided"}
OUT_OF_REACH = 1.5
"""A voltage this many times the paper's is not reproduced."""


def findings(study: Study) -> list[str]:
    """Findings for the top of the page."""
    slab, solid = (presses[FINAL] for presses in study.readings.values())
    forces = [
        press.force_N / published_numbers()[f"section4.force.{name}"].value for name, press in _stated_forces(study)
    ]
    ratios = _voltage_ratios(study)
    near = [ratio for ratio in ratios if ratio < OUT_OF_REACH]
    return [
        "Read as a cross-section 16 mm wide, the simulated numbers come back: six forces within "
        f"{_furthest(forces)}, {len(near)} of {len(ratios)} voltages within {_furthest(near)}. Three sizes that the "
        f"paper does not state had to be fitted for this. {_verdicts(study)}",
        f"A true segment of 2.5 × 2.5 mm under a round dot gives {slab.force_N / solid.force_N:.0f} times less force "
        f"and {slab.voltage_V / solid.voltage_V:.0f} times less voltage in the final clamped design; "
        f"{_passing(study)}, and {_clamped_below_free(study)}.",
        f"With held sides the voltage grows with depth to the power {slab.exponent:.1f} (cross-section) or "
        f"{solid.exponent:.1f} (true segment): volts per millimetre are not a constant of such a sensor.",
    ]


def changes(study: Study) -> str:
    """Paragraph on the conclusions of the paper that the true segment changes."""
    both = claims(study)
    other = [
        f"“{slab.text}” ({VERDICTS[slab.holds]} in cross-section, {VERDICTS[solid.holds]} in a true segment)"
        for slab, solid in zip(both[::2], both[1::2], strict=True)
        if slab.holds is not solid.holds
    ]
    words = f"Verdicts that change: {'; '.join(other)}." if other else "No verdict on a trend changes."
    return (
        f"What the true segment changes: forces are {_span(study, lambda press: press.force_N)} times smaller and "
        f"voltages {_span(study, lambda press: press.voltage_V)} times, since a round dot presses a small part of the "
        f"film where a ridge presses its whole width; {_passing(study)}. {words} The factor 337 was found for a film "
        "of 16 × 16 mm; it belongs to that film and its amplifier, so even the calibrated voltages of a true segment "
        "are not what an amplifier would show."
    )


def yielding(study: Study) -> str:
    """Sentence on the cases whose film is stressed beyond its yield."""
    film = segment_config("free", 0.8, 5.0).layer_materials()["film"]
    limit = film.model_dump()["yield_stress_MPa"]
    beyond = {
        SHORT_NAMES[reading]: [title(name) for name in CASES if presses[name].film_stress_MPa > limit]
        for reading, presses in study.readings.items()
    }
    words = "; ".join(f"{reading}: {', '.join(names) if names else 'none'}" for reading, names in beyond.items())
    return (
        f"PVDF film begins to yield at some {limit:g} MPa; neither the paper's simulation nor these presses let it. "
        f"Cases whose largest film stress is beyond that: {words}."
    )


def _stated_forces(study: Study) -> list[tuple[str, SolvedPress]]:
    return [(name, study.readings["plane-strain"][name]) for name in FORCE_CASES]


def _voltage_ratios(study: Study) -> list[float]:
    """Ours over the paper's: three sums, final free, final clamped."""
    ours = answers(study)
    keys = [f"section4.sum.{'+'.join(pair)}" for pair in ADDED_PAIRS] + ["fig10.final-free", "fig10.final-clamped"]
    return [value / published_numbers()[key].value for key in keys if (value := ours[key].ours) is not None]


def _furthest(ratios: list[float]) -> str:
    return f"{100 * max(abs(ratio - 1) for ratio in ratios):.0f} %"


def _verdicts(study: Study) -> str:
    """Sentence on how many trends hold in the cross-section."""
    verdicts = [claim.holds for claim in claims(study) if claim.reading == SHORT_NAMES["plane-strain"]]
    return (
        f"Of {len(verdicts)} statements on trends {verdicts.count(True)} hold, {verdicts.count(False)} fail and "
        f"{verdicts.count(None)} are not decided."
    )


def _passing(study: Study) -> str:
    """Sentence on how many designs pass the criterion in a true segment."""
    rows = tables.criterion(study).rows
    passed = sum(row[-1] is True for row in rows)
    words = f"all {len(rows)} pairs" if passed == len(rows) else f"{passed or 'none'} of the {len(rows)} pairs"
    return f"{words} of designs then come up to the paper's criterion of 50 mV"


def _clamped_below_free(study: Study) -> str:
    """Sentence on how often held sides give less in a true segment."""
    solid, pairs = study.readings["solid"], (*PAIRS, *LATER_PAIRS)
    below = sum(solid[clamped].voltage_V < solid[free].voltage_V for clamped, free in pairs)
    return f"held sides give less voltage than free ones in {below} of them"


def _span(study: Study, quantity: Callable[[SolvedPress], float]) -> str:
    """Smallest and largest ratio of cross-section over true segment."""
    slab, solid = study.readings.values()
    ratios = [quantity(slab[name]) / quantity(solid[name]) for name in CASES]
    return f"{min(ratios):.2g} to {max(ratios):.2g}"
