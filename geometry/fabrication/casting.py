"""Moulds of all cast components, the check of their cavities against the designed parts, and the amounts to pour."""

from dataclasses import dataclass
from typing import Any

from foundation.errors import InputError
from geometry.fabrication.cavity import check_mould_sizes, styled_cavity
from geometry.fabrication.device import Device
from geometry.fabrication.mould import LID_THICKNESS_MM, Mould, mould_of
from geometry.fabrication.parameters import CastComponent, Fabrication, cast_components
from geometry.fabrication.part import (
    PROCESSES,
    FabricationPart,
    box,
    fabrication_part,
    printer_profile,
    scale_solid,
    shape_volume_mm3,
    subtract_solids,
)


@dataclass(frozen=True)
class Pour:
    """One mould full of one material. Masses in g, volumes in mm^3.

    component : "effector", "medium1" or "medium2".
    material : its material in the configuration.
    recipe : name of what is poured; another one than the material where that cannot be cast.
    cavities : number of them in the mould.
    cavity_volume_mm3 : of all cavities together, enlarged for shrinkage.
    poured_volume_mm3 : with the overfill.
    poured_mass_g : of the poured volume.
    mixed_mass_g : the poured mass, or the smallest batch that can be mixed.
    mixed_masses_g : (name, mass) of each component of the mix, such as (("A", 5.0), ("B", 5.0)).
    shrinkage_percent : linear, by which the cavities are enlarged.
    pot_life_min, cure_time_h : None where not known.
    release : note on the release agent.
    note : what else to know.
    source : of the numbers.
    """

    component: str
    material: str
    recipe: str
    cavities: int
    cavity_volume_mm3: float
    poured_volume_mm3: float
    poured_mass_g: float
    mixed_mass_g: float
    mixed_masses_g: tuple[tuple[str, float], ...]
    shrinkage_percent: float
    pot_life_min: float | None
    cure_time_h: float | None
    release: str
    note: str
    source: str


def pour_of(component: CastComponent, mould: Mould, fabrication: Fabrication) -> Pour:
    """The amounts to pour into one mould.

    The liquid is counted at the density of the cured part and the volume of the cavity.
    """
    recipe, cavities = component.recipe, len(mould.gang.centers)
    cavity_volume = cavities * float(mould.cavity.solid.volume)
    poured_volume = cavity_volume * (1.0 + fabrication.overfill_percent / 100.0)
    poured = poured_volume * 1e-3 * recipe.density_g_cm3
    mixed = max(poured, fabrication.smallest_batch_g)
    return Pour(
        component=component.name,
        material=component.material,
        recipe=recipe.name,
        cavities=cavities,
        cavity_volume_mm3=cavity_volume,
        poured_volume_mm3=poured_volume,
        poured_mass_g=poured,
        mixed_mass_g=mixed,
        mixed_masses_g=recipe.masses_g(mixed),
        shrinkage_percent=100.0 * recipe.shrinkage,
        pot_life_min=recipe.pot_life_min,
        cure_time_h=recipe.cure_time_h,
        release=recipe.release,
        note=recipe.note,
        source=recipe.source,
    )


@dataclass(frozen=True)
class CavityCheck:
    """Comparison of the void of the closed mould, shrunk, with the designed part.

    component : "effector", "medium1" or "medium2".
    style : "open" or "split".
    designed_volume_mm3, cast_volume_mm3 : of the part and of the shrunk void of one cavity.
    difference_mm3 : volume of the symmetric difference of both.
    deviation_mm : largest distance between their surfaces.
    tolerance_mm : what is allowed.
    """

    component: str
    style: str
    designed_volume_mm3: float
    cast_volume_mm3: float
    difference_mm3: float
    deviation_mm: float
    tolerance_mm: float


def check_cavity(mould: Mould, fabrication: Fabrication) -> CavityCheck:
    """Compare the void of the closed mould, cut out of a block by the printed parts, with the designed part.

    What stands in the vents is trimmed off the cast part and does not count.
    """
    designed, shrink = mould.cavity.designed, 1.0 - mould.cavity.shrinkage
    void, vents = (
        scale_solid(_void_solid(mould, fabrication), shrink),
        [scale_solid(notch, shrink) for notch in _vents_at_axis(mould)],
    )
    beyond = _volume_outside(vents, void.cut(designed))
    lacking = shape_volume_mm3(designed.cut(void))
    return CavityCheck(
        component=mould.component,
        style=mould.style,
        designed_volume_mm3=float(designed.volume),
        cast_volume_mm3=float(designed.volume) + beyond - lacking,
        difference_mm3=beyond + lacking,
        deviation_mm=max(_largest_distance_mm(void, designed, vents), _largest_distance_mm(designed, void, vents)),
        tolerance_mm=fabrication.tolerance_mm,
    )


def _void_solid(mould: Mould, fabrication: Fabrication) -> Any:
    """The void that the closed mould leaves around its first cavity, moved to the axis.

    It is measured within a box that reaches half-way into the land and the walls, not as far as the overflow.
    """
    from build123d import Pos

    cavity, (x, y) = mould.cavity, mould.gang.centers[0]
    reach = min(fabrication.land_mm, fabrication.mould_wall_mm, LID_THICKNESS_MM) / 2
    probe = box(
        (x - cavity.size_x / 2 - reach, x + cavity.size_x / 2 + reach),
        (y - cavity.size_y / 2 - reach, y + cavity.size_y / 2 + reach),
        (-reach, cavity.height + reach),
    )
    return Pos(-x, -y, 0) * subtract_solids(probe, mould.solids.values())


def _vents_at_axis(mould: Mould) -> list[Any]:
    """The vents of the first cavity, moved with it."""
    from build123d import Pos

    x, y = mould.gang.centers[0]
    return [Pos(-x, -y, 0) * notch for notch in mould.vents[:2]]


def _volume_outside(vents: list[Any], excess: Any) -> float:
    """Volume in mm^3 of what lies beyond the part, without what stands in the vents."""
    pieces = [] if excess is None else excess.solids()
    return sum(shape_volume_mm3(piece.cut(*vents)) for piece in pieces)


def _largest_distance_mm(solid: Any, other: Any, vents: list[Any]) -> float:
    """Largest distance in mm of points on one surface, outside the vents, from the other surface."""
    from build123d import Vertex

    points, _ = solid.tessellate(0.02, 0.5)
    surface, boxes = other.shell(), [notch.bounding_box() for notch in vents]
    kept = [point for point in points if not any(_is_in_box(one, point) for one in boxes)]
    return max(float(surface.distance_to(Vertex(*point))) for point in kept)


def _is_in_box(one: Any, point: Any) -> bool:
    """Whether a point lies in a bounding box or on it."""
    low, high, edge = tuple(one.min), tuple(one.max), 1e-6
    return all(a - edge <= x <= b + edge for a, x, b in zip(low, point, high, strict=True))


PART_PURPOSES = {
    "plate": "Holds the cavities of {component}; the cast parts leave it upwards.",
    "floor": "Carries the bars of the mould of {component} on its pins.",
    "bar": "Forms the sides of {component}; is drawn off sideways before the parts are lifted.",
    "lid": "Presses what is poured for {component} flat; line it with acetate film, or use a glass slide in its place.",
}
COMPONENT_NAMES = {"effector": "the effector", "medium1": "medium 1", "medium2": "medium 2"}


@dataclass(frozen=True)
class CastingKit:
    """All that casting takes. parts : printable; pours and checks : one for each cast component, from the top down."""

    parts: tuple[FabricationPart, ...]
    pours: tuple[Pour, ...]
    checks: tuple[CavityCheck, ...]


def casting_kit(device: Device, fabrication: Fabrication) -> CastingKit:
    """Moulds, pours and checks of a device that has passed its checks.

    InputError for what cannot be cast, printed or taken out of its mould, and for a cavity that deviates from
    the design by more than tolerance_mm.
    """
    components = cast_components(device.segment, fabrication)
    if components:
        check_mould_sizes(fabrication, printer_profile(fabrication.printer))
    cavities = [styled_cavity(one.name, device, one.recipe.shrinkage, fabrication) for one in components]
    moulds = [
        mould_of(component.name, style, cavity, fabrication)
        for component, (style, cavity) in zip(components, cavities, strict=True)
    ]
    return CastingKit(
        parts=tuple(part for mould in moulds for part in _mould_parts(mould, fabrication)),
        pours=tuple(pour_of(*pair, fabrication) for pair in zip(components, moulds, strict=True)),
        checks=tuple(_refuse_deviation(check_cavity(mould, fabrication)) for mould in moulds),
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
                purpose=PART_PURPOSES[kind].format(component=COMPONENT_NAMES[mould.component]),
                process="either" if lid else PROCESSES[fabrication.printer],
            )
        )
    return found


def _refuse_deviation(check: CavityCheck) -> CavityCheck:
    """Return the check itself. InputError where the cast part deviates by more than its tolerance."""
    if check.deviation_mm > check.tolerance_mm:
        raise InputError(
            f"fabrication.tolerance_mm = {check.tolerance_mm:g}: the cast {check.component} deviates by "
            f"{check.deviation_mm:.3g} mm; allow more or choose another mould_style"
        )
    return check
