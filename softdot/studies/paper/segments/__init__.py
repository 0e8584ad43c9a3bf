"""Part 3 of the study: the paper's simulations of one segment, in two readings.

What the presses say, in sentences made from their numbers.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path

from geometry.executor import Executor
from softdot.console import Progress
from softdot.studies.paper.published import EFFECTOR_HEIGHT_MM, RIDGE_RADIUS_MM, published, segment_config
from softdot.studies.paper.section import Block, Figure, Heading, Section
from softdot.studies.paper.segments import tables, trends
from softdot.studies.paper.segments.cases import (
    ADDED_PAIRS,
    CASES,
    CLAMPED,
    FORCE_CASES,
    FREE,
    LATER_PAIRS,
    PAIRS,
    SolvedPress,
    Study,
    answers,
    solve_study,
    title,
)
from softdot.studies.paper.segments.trends import SHORT_NAMES, claims

FINAL = "final-clamped"
VERDICTS = {True: "true", False: "false", None: "undecided"}
OUT_OF_REACH = 1.5
"""A voltage this many times the paper's is not reproduced."""


def findings(study: Study) -> list[str]:
    """For the top of the page."""
    slab, solid = (presses[FINAL] for presses in study.readings.values())
    forces = [press.force_N / published()[f"section4.force.{name}"].value for name, press in _stated_forces(study)]
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
    """What the true segment changes in the paper's conclusions."""
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
    """Where the film is stressed beyond its yield."""
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
    return [value / published()[key].value for key in keys if (value := ours[key].ours) is not None]


def _furthest(ratios: list[float]) -> str:
    return f"{100 * max(abs(ratio - 1) for ratio in ratios):.0f} %"


def _verdicts(study: Study) -> str:
    """How many trends hold in the cross-section."""
    verdicts = [claim.holds for claim in claims(study) if claim.reading == SHORT_NAMES["plane-strain"]]
    return (
        f"Of {len(verdicts)} statements on trends {verdicts.count(True)} hold, {verdicts.count(False)} fail and "
        f"{verdicts.count(None)} are not decided."
    )


def _passing(study: Study) -> str:
    """How many designs pass the criterion in a true segment."""
    rows = tables.criterion(study).rows
    passed = sum(row[-1] is True for row in rows)
    words = f"all {len(rows)} pairs" if passed == len(rows) else f"{passed or 'none'} of the {len(rows)} pairs"
    return f"{words} of designs then come up to the paper's criterion of 50 mV"


def _clamped_below_free(study: Study) -> str:
    """How often held sides give less in a true segment."""
    solid, pairs = study.readings["solid"], (*PAIRS, *LATER_PAIRS)
    below = sum(solid[clamped].voltage_V < solid[free].voltage_V for clamped, free in pairs)
    return f"held sides give less voltage than free ones in {below} of them"


def _span(study: Study, quantity: Callable[[SolvedPress], float]) -> str:
    """Smallest and largest ratio of cross-section over true segment."""
    slab, solid = study.readings.values()
    ratios = [quantity(slab[name]) / quantity(solid[name]) for name in CASES]
    return f"{min(ratios):.2g} to {max(ratios):.2g}"


def section(progress: Progress, folder: Path, executor: Executor) -> Section:
    """Press every segment of the paper. Figures go to folder / "figures". NotSolvedError."""
    progress.stage("segments")
    return section_of(solve_study(progress, executor), folder)


def section_of(study: Study, folder: Path) -> Section:
    """The section from presses that are solved."""
    return Section(
        name="segments",
        title="The simulated segments, pressed again",
        findings=findings(study),
        blocks=_blocks(study, folder),
        numbers=numbers(study),
        claims=trends.claims(study),
        answers=answers(study),
    )


def numbers(study: Study) -> dict[str, object]:
    """Every press, for paper.json."""
    return {
        "readings": {reading: _plain(presses) for reading, presses in study.readings.items()},
        "refined": {reading: press_numbers(press) for reading, press in study.refined.items()},
        "variants": {name: _plain(presses) for name, presses in study.variants.items()},
    }


def _plain(presses: Mapping[str, SolvedPress]) -> dict[str, object]:
    return {name: press_numbers(press) for name, press in presses.items()}


def press_numbers(press: SolvedPress) -> dict[str, object]:
    """One press as plain numbers."""
    derived = ("force_N", "voltage_V", "calibrated_mV", "calibrated_V_per_mm", "exponent")
    return {**asdict(press), **{name: getattr(press, name) for name in derived}}


def _blocks(study: Study, folder: Path) -> list[Block]:
    return [
        "The paper pressed twelve segments 0.3 mm deep in simulation: six with free sides (F1 to F6), six with clamped "
        "sides (C1 to C6), medium 1 being 0.8, 2 or 4 mm thick and medium 2 hard (5 MPa) or very soft (0.05 MPa). It "
        "then chose a medium 2 of 1 MPa and a medium 1 of 0.5 mm as its final design. All its voltages are "
        "simulated ones divided by the calibration factor 337; ours are divided by the same factor.",
        *_two_readings(study, folder),
        *_both_boundaries(study, folder),
        *_selected(study, folder),
        *_depth(study, folder),
        *_every_press(study),
    ]


def _two_readings(study: Study, folder: Path) -> list[Block]:
    """What the readings are, and their forces."""
    return [
        Heading("Two readings"),
        "The paper shows a drawing of a cross-section and gives forces in newtons, but no width. Cross-section: "
        "nothing varies across a width of 16 mm, the width of the film in the experiment, and the dot is a ridge. "
        "True segment: 2.5 × 2.5 mm, as the text says, under a round Braille dot of the Marburg standard (1.5 mm "
        "across, 0.5 mm high).",
        "Three things had to be fitted to the paper's eleven forces and voltages: the height of the effector "
        f"({EFFECTOR_HEIGHT_MM:g} mm), the radius of the ridge ({RIDGE_RADIUS_MM:g} mm), and which sides the case "
        "holds (effector, medium 1 and film; medium 2 stays free). The true segment uses the same effector and the "
        "same held layers, at all four sides; its dot is the standard's. Nothing else was adjusted: the film has the "
        "constants of a data sheet (d₃₁ 23, d₃₂ 2.3, d₃₃ −33 pC/N, relative permittivity 12).",
        tables.readings(study),
        Figure(
            tables.draw_forces(study, folder),
            "Forces",
            "Bars: ours, blue for free and red for clamped sides. Diamonds: the six forces that the paper states. The "
            "last one is not reached: the paper's force rises when medium 1 becomes thinner, ours falls.",
        ),
    ]


def _both_boundaries(study: Study, folder: Path) -> list[Block]:
    """The free and the clamped cases."""
    return [
        Heading("Free sides: the paper's Fig. 7"),
        Figure(
            tables.draw_cases(study, FREE, folder, "fig07-free"),
            "Segments with free sides",
            "Note the two scales. The paper prints no single values of its Fig. 7, only sums with the clamped cases. "
            "Its order F1 > F2 > F3, and F4 to F6 far below, is tested in both readings below.",
        ),
        Heading("Clamped sides: the paper's Fig. 8"),
        Figure(
            tables.draw_cases(study, CLAMPED, folder, "fig08-clamped"),
            "Segments with clamped sides",
            "The thinner medium 1 (0.8 mm in C1, C2; 4 mm in C5, C6), the more the film is stretched. C1, C3, C5 have "
            "the soft medium 2.",
        ),
    ]


def _selected(study: Study, folder: Path) -> list[Block]:
    """The designs that the paper chose from."""
    return [
        Heading("Selected designs: the paper's Fig. 10, and the 50 mV criterion"),
        Figure(
            tables.draw_selected(study, folder),
            "Free plus clamped voltage",
            "Bars: ours, free below and clamped on top. Diamonds: sums that the paper states. Dotted: its 50 mV limit.",
        ),
        tables.criterion(study),
        changes(study),
    ]


def _depth(study: Study, folder: Path) -> list[Block]:
    """How the voltage grows with depth."""
    return [
        Heading("The voltage is not proportional to the depth"),
        Figure(
            tables.draw_depth(study, folder),
            "Voltage against depth",
            "On these axes a straight line is a power of the depth; n is its slope in the second half. Held sides "
            "give a much larger n than free ones, since there the film is stretched and stretch grows with the square "
            "of the depth.",
        ),
    ]


def _every_press(study: Study) -> list[Block]:
    """All numbers, and how far to trust them."""
    return [
        Heading("Every press"),
        yielding(study),
        tables.presses(study, "plane-strain", "presses-cross-section", "Cross-section, 16 mm wide"),
        tables.presses(study, "solid", "presses-true-segment", "True segment, 2.5 × 2.5 mm, Marburg dot"),
        Heading("How far to trust these numbers"),
        "The fitted sizes matter as much as the thicknesses that the paper varies:",
        tables.variants(study),
        tables.errors(study),
    ]
