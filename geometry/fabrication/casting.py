"""The moulds of all components that are cast."""

from dataclasses import dataclass

from geometry.errors import InputError
from geometry.fabrication.cavity_check import CavityCheck, check_cavity
from geometry.fabrication.mould import Mould, mould_of
from geometry.fabrication.mould_checks import check_mould_sizes, styled_cavity
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import PROCESSES, FabricationPart, fabrication_part
from geometry.fabrication.pours import Pour, pour_of
from geometry.fabrication.routes import cast_components
from geometry.parameters import Segment
from geometry.printers import printer_profile

PURPOSES = {
    "plate": "Holds the cavities of {component}; the cast parts leave it upwards.",
    "floor": "Carries the bars of the mould of {component} on its pins.",
    "bar": "Forms the sides of {component}; is drawn off sideways before the parts are lifted.",
    "lid": "Presses the poured {component} flat; line it with acetate film, or use a glass slide in its place.",
}
IN_WORDS = {"effector": "the effector", "medium1": "medium 1", "medium2": "medium 2"}


@dataclass(frozen=True)
class CastingKit:
    """parts : printable; pours and checks : one for each cast component, from the top down."""

    parts: tuple[FabricationPart, ...]
    pours: tuple[Pour, ...]
    checks: tuple[CavityCheck, ...]


def casting_kit(segment: Segment, fabrication: Fabrication) -> CastingKit:
    """Moulds and pours of a segment that has passed its checks.

    InputError for what cannot be cast, printed or taken out of its mould, and for a cavity that deviates from
    the design by more than tolerance_mm.
    """
    components = cast_components(segment, fabrication)
    if components:
        check_mould_sizes(fabrication, printer_profile(fabrication.printer))
    cavities = [styled_cavity(one.name, segment, one.recipe.shrinkage, fabrication) for one in components]
    moulds = [
        mould_of(component.name, style, cavity, fabrication)
        for component, (style, cavity) in zip(components, cavities, strict=True)
    ]
    return CastingKit(
        parts=tuple(part for mould in moulds for part in _mould_parts(mould, fabrication)),
        pours=tuple(pour_of(*pair, fabrication) for pair in zip(components, moulds, strict=True)),
        checks=tuple(_within_tolerance(check_cavity(mould, fabrication)) for mould in moulds),
    )


def _mould_parts(mould: Mould, fabrication: Fabrication) -> list[FabricationPart]:
    found = []
    for name, solid in mould.solids.items():
        kind = name.partition("-")[0]
        lid = kind == "lid"
        found.append(
            fabrication_part(
                label=f"mould-{mould.component}-{name}",
                solid=solid,
                kind="lid" if lid else "mould",
                purpose=PURPOSES[kind].format(component=IN_WORDS[mould.component]),
                process="either" if lid else PROCESSES[fabrication.printer],
            )
        )
    return found


def _within_tolerance(check: CavityCheck) -> CavityCheck:
    if check.deviation_mm > check.tolerance_mm:
        raise InputError(
            f"fabrication.tolerance_mm = {check.tolerance_mm:g}: the cast {check.component} deviates by "
            f"{check.deviation_mm:.3g} mm; allow more or choose another mould_style"
        )
    return check
