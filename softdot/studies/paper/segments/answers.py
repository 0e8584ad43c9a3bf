"""Our values of the numbers that the paper prints of its simulations, from the plane-strain reading."""

from collections.abc import Mapping

from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.section import Answer
from softdot.studies.paper.segment import INDENTATION_MM, segment_config
from softdot.studies.paper.segments.cases import ADDED_PAIRS
from softdot.studies.paper.segments.presses import SolvedPress, Study
from solve.materials.parameters import Material

FORCE_CASES = ("F4", "C1", "F4-E2-1", "C1-E2-1", "final-free", "final-clamped")
TWICE_TOO_HIGH = (
    "Not reached. A sharper ridge or held sides of medium 2 would lower it, but then the others miss; see what the "
    "paper leaves open."
)
FALLS = "The force of the paper rises when medium 1 gets thinner; ours falls, as expected of a thinner layer."


def answers(study: Study) -> dict[str, Answer]:
    """Forces, sums and single voltages, and the inputs that we took over."""
    presses = study.readings["plane-strain"]
    return {**_forces(presses), **_voltages(presses), **_inputs(), **_materials()}


def _forces(presses: Mapping[str, SolvedPress]) -> dict[str, Answer]:
    remarks = {"final-clamped": FALLS}
    return {f"section4.force.{name}": Answer(presses[name].force_N, remarks.get(name, "")) for name in FORCE_CASES}


def _voltages(presses: Mapping[str, SolvedPress]) -> dict[str, Answer]:
    found: dict[str, Answer] = {}
    for pair in ADDED_PAIRS:
        key = f"section4.sum.{'+'.join(pair)}"
        remark = TWICE_TOO_HIGH if pair == ("C4", "F2") else ""
        found |= _with_rate(key, sum(presses[name].calibrated_mV for name in pair), remark)
    for name in ("final-free", "final-clamped"):
        found |= _with_rate(f"fig10.{name}", presses[name].calibrated_mV)
    return found


def _with_rate(key: str, millivolts: float, remark: str = "") -> dict[str, Answer]:
    """A voltage and the same per depth."""
    return {key: Answer(millivolts, remark), f"{key}.per-mm": Answer(1e-3 * millivolts / INDENTATION_MM, remark)}


def _inputs() -> dict[str, Answer]:
    config = segment_config("free", 0.8, 5.0)
    segment = config.segment
    return {
        "section2.film-thickness_um": Answer(segment.film.thickness_um),
        "section2.film-width_mm": Answer(segment.width_mm, "taken as the width of the cross-section too"),
        "section4.length_mm": Answer(segment.length_mm),
        "section4.u2_mm": Answer(config.press.depth_mm),
        "section4.h2_mm": Answer(segment.medium2.thickness_mm),
        "section4.criterion": Answer(published_numbers()["section4.criterion"].value, "taken over"),
    }


def _materials() -> dict[str, Answer]:
    """Table 2. The dot is rigid here; densities play no part in a slow press."""
    columns = ("E_MPa", "nu", "density_kg_m3")
    found = {f"table2.dot.{column}": Answer(None, "the dot is rigid here") for column in columns}
    for layer, material in segment_config("free", 0.8, 5.0).layer_materials().items():
        found |= _material(f"table2.{layer}", material)
    return found


def _material(key: str, material: Material) -> dict[str, Answer]:
    values = material.model_dump()
    return {
        f"{key}.E_MPa": Answer(values["youngs_modulus_MPa"]),
        f"{key}.nu": Answer(values["poisson_ratio"]),
        f"{key}.density_kg_m3": Answer(values["density_kg_m3"], "no part in a slow press"),
    }
