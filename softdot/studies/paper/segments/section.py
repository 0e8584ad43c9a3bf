"""The page of part 3: the paper's simulations of one segment, in two readings."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.section import Block, Figure, Heading, Section
from softdot.studies.paper.segment import EFFECTOR_HEIGHT_MM, RIDGE_RADIUS_MM
from softdot.studies.paper.segments import figures, tables
from softdot.studies.paper.segments.answers import answers
from softdot.studies.paper.segments.cases import CLAMPED, FREE
from softdot.studies.paper.segments.findings import changes, findings, yielding
from softdot.studies.paper.segments.presses import SolvedPress, Study, solve_study
from softdot.studies.paper.segments.trends import claims


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
        claims=claims(study),
        answers=answers(study),
    )


def numbers(study: Study) -> dict[str, object]:
    """Values of every press for paper.json."""
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
        *_selected_designs(study, folder),
        *_depth(study, folder),
        *_every_press(study),
    ]


def _two_readings(study: Study, folder: Path) -> list[Block]:
    """Blocks on the two readings of the paper and their forces."""
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
            figures.draw_forces(study, folder),
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
            figures.draw_cases(study, FREE, folder, "fig07-free"),
            "Segments with free sides",
            "Note the two scales. The paper prints no single values of its Fig. 7, only sums with the clamped cases. "
            "Its order F1 > F2 > F3, and F4 to F6 far below, is tested in both readings below.",
        ),
        Heading("Clamped sides: the paper's Fig. 8"),
        Figure(
            figures.draw_cases(study, CLAMPED, folder, "fig08-clamped"),
            "Segments with clamped sides",
            "The thinner medium 1 (0.8 mm in C1, C2; 4 mm in C5, C6), the more the film is stretched. C1, C3, C5 have "
            "the soft medium 2.",
        ),
    ]


def _selected_designs(study: Study, folder: Path) -> list[Block]:
    """Blocks on the designs that the paper chose from."""
    return [
        Heading("Selected designs: the paper's Fig. 10, and the 50 mV criterion"),
        Figure(
            figures.draw_selected(study, folder),
            "Free plus clamped voltage",
            "Bars: ours, free below and clamped on top. Diamonds: sums that the paper states. Dotted: its 50 mV limit.",
        ),
        tables.criterion(study),
        changes(study),
    ]


def _depth(study: Study, folder: Path) -> list[Block]:
    """Blocks on the growth of the voltage with depth."""
    return [
        Heading("The voltage is not proportional to the depth"),
        Figure(
            figures.draw_depth(study, folder),
            "Voltage against depth",
            "On these axes a straight line is a power of the depth; n is its slope in the second half. Held sides "
            "give a much larger n than free ones, since there the film is stretched and stretch grows with the square "
            "of the depth.",
        ),
    ]


def _every_press(study: Study) -> list[Block]:
    """Blocks with all numbers, and how far to trust them."""
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
