"""Tables of the segment studies."""

from collections.abc import Mapping

from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.section import Cell, PaperTable
from softdot.studies.paper.segment import Reading
from softdot.studies.paper.segments.answers import FORCE_CASES
from softdot.studies.paper.segments.cases import ADDED_PAIRS, CASES, LATER_PAIRS, PAIRS, title, together
from softdot.studies.paper.segments.presses import CHECKED, VARIED, SolvedPress, Study
from softdot.studies.paper.segments.trends import SHORT_NAMES


def presses(study: Study, reading: Reading, name: str, words: str) -> PaperTable:
    """Force, voltage and film strain of every case."""
    return PaperTable(
        name,
        words,
        [
            "case",
            "sides",
            "h₁ (mm)",
            "E₂ (MPa)",
            "force (N)",
            "open-circuit voltage (V)",
            "over 337 (mV)",
            "over 337, per depth (V/mm)",
            "n of V ~ uⁿ",
            "largest film strain (%)",
            "largest film stress (MPa)",
        ],
        [_row(case, study.readings[reading][case]) for case in CASES],
        "At 0.3 mm. n from half to full depth. Strain and stress are principal values of the film; at the rim of a "
        "held film they grow as the mesh is refined, so read them as estimates.",
    )


def _row(name: str, press: SolvedPress) -> list[Cell]:
    case = CASES[name]
    numbers = (
        press.force_N,
        press.voltage_V,
        press.calibrated_mV,
        press.calibrated_V_per_mm,
        press.exponent,
        100 * press.film_strain,
        press.film_stress_MPa,
    )
    return [title(name), case.boundary, case.h1_mm, case.e2_MPa, *map(digits, numbers)]


def criterion(study: Study) -> PaperTable:
    """The sum of free and clamped voltage against 50 mV, in both readings."""
    limit = published_numbers()["section4.criterion"].value
    rows: list[list[Cell]] = []
    for pair in (*PAIRS, *LATER_PAIRS):
        slab, solid = (sum(each[name].calibrated_mV for name in pair) for each in study.readings.values())
        rows.append([together(pair), _printed_sum(pair), digits(slab), slab >= limit, digits(solid), solid >= limit])
    return PaperTable(
        "criterion",
        "The 50 mV criterion: free plus clamped voltage over 337",
        [
            "layers",
            "paper (mV)",
            "cross-section (mV)",
            "reaches 50 mV (cross-section)",
            "true segment (mV)",
            "reaches 50 mV (true segment)",
        ],
        rows,
        "The paper asks that the sum be at least 50 mV. Its sums beyond the first three and the final design stand "
        "only in figures.",
    )


def _printed_sum(pair: tuple[str, str]) -> float | None:
    if pair in ADDED_PAIRS:
        return published_numbers()[f"section4.sum.{'+'.join(pair)}"].value
    if pair == LATER_PAIRS[1]:
        return sum(published_numbers()[f"fig10.{name}"].value for name in pair)
    return None


def readings(study: Study) -> PaperTable:
    """Table of both readings side by side."""
    slab, solid = study.readings["plane-strain"], study.readings["solid"]
    rows: list[list[Cell]] = []
    for name in CASES:
        printed = published_numbers()[f"section4.force.{name}"].value if name in FORCE_CASES else None
        rows.append(
            [
                title(name),
                printed,
                digits(slab[name].force_N),
                digits(solid[name].force_N),
                digits(slab[name].force_N / solid[name].force_N),
                digits(slab[name].calibrated_mV),
                digits(solid[name].calibrated_mV),
                digits(slab[name].calibrated_mV / solid[name].calibrated_mV),
            ]
        )
    return PaperTable(
        "both-readings",
        "Both readings side by side",
        [
            "case",
            "force, paper (N)",
            "force, cross-section (N)",
            "force, true segment (N)",
            "ratio of forces",
            "voltage over 337, cross-section (mV)",
            "true segment (mV)",
            "ratio of voltages",
        ],
        rows,
    )


def errors(study: Study) -> PaperTable:
    """Table of the changes that a finer mesh makes in one press."""
    rows: list[list[Cell]] = []
    for reading, words in SHORT_NAMES.items():
        coarse, fine = study.readings[reading][CHECKED], study.refined[reading]
        rows += [
            [words, "force (N)", digits(coarse.force_N), digits(fine.force_N), _percent(coarse.force_N, fine.force_N)],
            [
                words,
                "voltage over 337 (mV)",
                digits(coarse.calibrated_mV),
                digits(fine.calibrated_mV),
                _percent(coarse.calibrated_mV, fine.calibrated_mV),
            ],
            [words, "unknowns", coarse.unknowns, fine.unknowns, ""],
        ]
    return PaperTable(
        "discretisation",
        "Influence of the mesh: the final design, clamped",
        ["reading", "quantity", "mesh of this study", "a finer mesh", "difference"],
        rows,
    )


def variants(study: Study) -> PaperTable:
    """Table of the cases with one thing changed that the paper leaves open."""
    base = study.readings["plane-strain"]
    groups = {"as used here": {name: base[name] for name in VARIED}, **study.variants}
    forces, voltages = (
        [printed.value if (printed := published_numbers().get(f"{place}.{name}")) else None for name in VARIED]
        for place in ("section4.force", "fig10")
    )
    return PaperTable(
        "open-questions",
        "What the paper leaves open, changed one at a time (cross-section)",
        ["change", *(f"force {title(n)} (N)" for n in VARIED), *(f"voltage {title(n)} (mV)" for n in VARIED)],
        [["the paper prints", *forces, *voltages], *(_variant_row(words, group) for words, group in groups.items())],
        "Voltages over 337. Of C1 and C4 the paper prints sums with free cases only: C1 + F4 363 mV, C4 + F2 105 mV.",
    )


def _variant_row(words: str, group: Mapping[str, SolvedPress]) -> list[Cell]:
    presses = [group[name] for name in VARIED]
    return [words, *(digits(p.force_N) for p in presses), *(digits(p.calibrated_mV) for p in presses)]


def digits(value: float) -> float:
    """Four significant digits."""
    return float(f"{value:.4g}")


def _percent(coarse: float, fine: float) -> str:
    return f"{100 * (coarse / fine - 1):+.1f} %"
