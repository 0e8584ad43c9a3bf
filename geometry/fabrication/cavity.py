"""The cavity of one component: the designed part enlarged for shrinkage, with draft; and the style of its mould."""

from dataclasses import dataclass
from math import asin, degrees, radians, sqrt, tan
from typing import Any, Literal

from foundation.errors import InputError
from geometry.fabrication.device import Device
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import (
    PrinterProfile,
    printer_profile,
    refuse_small_keys,
    refuse_thin,
    scale_solid,
    subtract_solids,
)
from geometry.stack import Box, Disc, Dome, bodies


@dataclass(frozen=True)
class Cavity:
    """One cavity in the frame of the mould: floor at z = 0, lid at z = height, axis at x = y = 0. In mm.

    designed : the part as designed, in the same place and the same way up, not enlarged.
    enlarged : the part divided by 1 - shrinkage, without draft.
    solid : what is hollow in the mould.
    size_x, size_y : of the opening.
    shape : "box", "disc" or "dome".
    counts : cavities of the mould in x and y.
    """

    designed: Any
    enlarged: Any
    solid: Any
    size_x: float
    size_y: float
    height: float
    shape: str
    shrinkage: float
    counts: tuple[int, int]


def cavity_of(name: str, device: Device, shrinkage: float, draft_deg: float, fabrication: Fabrication) -> Cavity:
    """The cavity of a component; the draft, in degrees, leaves a dome as it is.

    Draft leaves the section at mid-height as designed, so that the deviation is as small as it can be.
    """
    designed = designed_part(name, device, fabrication)
    growth = 1.0 / (1.0 - shrinkage)
    enlarged = scale_solid(designed, growth)
    shape, size = _component_shape(name, device), enlarged.bounding_box().size
    widening = draft_widening(shape, size.Z, draft_deg)
    solid = enlarged
    if widening > 0.0:
        solid = subtract_solids(_drafted_solid(shape, size, widening), groove_ridges(name, device, growth, draft_deg))
    return Cavity(
        designed=designed,
        enlarged=enlarged,
        solid=solid,
        size_x=size.X + 2 * widening,
        size_y=size.Y + 2 * widening,
        height=size.Z,
        shape=shape,
        shrinkage=shrinkage,
        counts=_cavity_counts(name, device, fabrication),
    )


def _cavity_counts(name: str, device: Device, fabrication: Fabrication) -> tuple[int, int]:
    """Cavities of one mould in x and y: one for each island of an array, in rows and columns as they will lie."""
    if device.piece_count(name) > 1:
        return len(device.layout.centres(0)), len(device.layout.centres(1))
    return fabrication.cavities or ((1, 1) if device.is_array else (2, 2))


def designed_part(name: str, device: Device, fabrication: Fabrication) -> Any:
    """One piece as designed, on the floor of its mould; with lid_face = 'base' it stands on its head."""
    from build123d import Pos, Rot

    solid = device.piece(name)
    low = solid.bounding_box().min.Z
    if fabrication.lid_face == "top":
        return Pos(0, 0, -low) * solid
    return Pos(0, 0, solid.bounding_box().max.Z) * Rot(180, 0, 0) * solid


def groove_ridges(name: str, device: Device, growth: float, draft_deg: float) -> list[Any]:
    """Solids that form the grooves of a layer on the floor of its mould, drafted, longer than the cavity."""
    from build123d import Plane, Pos, Solid, Wire

    layout, found = device.layout, []
    for groove in layout.grooves(name):
        depth, lean = growth * groove.depth_mm, tan(radians(draft_deg)) * growth * groove.depth_mm / 2
        for axis in (0, 1):
            long = 2 * growth * layout.half_mm[1 - axis] + 2.0
            for seam in layout.seams(axis):
                wires = []
                for z, wide in ((0.0, lean), (depth, -lean)):
                    sizes = (growth * groove.width_mm + 2 * wide, long)
                    wires.append(Wire.make_rect(*(sizes if axis == 0 else sizes[::-1]), Plane((0, 0, z))))
                place = (growth * seam, 0.0) if axis == 0 else (0.0, -growth * seam)
                found.append(Pos(*place, 0) * Solid.make_loft(wires, ruled=True))
    return found


def draft_widening(shape: str, height: float, draft_deg: float) -> float:
    """Distance in mm by which draft widens each side at the lid and narrows it at the floor; 0 for a dome."""
    return 0.0 if shape == "dome" else tan(radians(draft_deg)) * height / 2


def draft_deviation(shape: str, height: float, draft_deg: float) -> float:
    """Largest distance in mm between the drafted and the designed surface, which is at the corners of a box."""
    return draft_widening(shape, height, draft_deg) * (sqrt(2.0) if shape == "box" else 1.0)


def _component_shape(name: str, device: Device) -> str:
    body = bodies(device.stated_segment(name))[-1] if name == "effector" else Box(1.0, 1.0, 0.0, 1.0)
    return {Box: "box", Disc: "disc", Dome: "dome"}[type(body)]


def _drafted_solid(shape: str, size: Any, widening: float) -> Any:
    """A box or cylinder that is wider at the top and narrower at the bottom by the widening in mm on each side."""
    from build123d import Plane, Solid, Wire

    if shape == "disc":
        return Solid.make_cone(size.X / 2 - widening, size.X / 2 + widening, size.Z)
    wires = [
        Wire.make_rect(size.X + 2 * wide, size.Y + 2 * wide, Plane((0, 0, z)))
        for z, wide in ((0.0, -widening), (size.Z, widening))
    ]
    return Solid.make_loft(wires, ruled=True)


MouldStyle = Literal["open", "split"]
LEAST_DRAFT_DEG = 1.0
"""Least draft of a wall that the part slides along when it leaves the mould; 1 to 3 degrees are usual."""


def styled_cavity(name: str, device: Device, shrinkage: float, fabrication: Fabrication) -> tuple[MouldStyle, Cavity]:
    """The mould style of a component and its cavity. InputError for a mould that cannot be opened.

    A dome opens by itself towards its base. Walls of boxes and cylinders need draft in one plate, and none in
    a split mould, whose bars are drawn off sideways.
    """
    plain = cavity_of(name, device, shrinkage, 0.0, fabrication)
    _refuse_shallow(name, plain, printer_profile(fabrication.printer))
    _refuse_large_vents(name, plain, fabrication)
    if plain.shape == "dome":
        _refuse_undercut(name, plain)
        return "open", plain
    deviation = draft_deviation(plain.shape, plain.height, fabrication.draft_deg)
    fits = fabrication.draft_deg >= LEAST_DRAFT_DEG and deviation <= fabrication.tolerance_mm
    if fabrication.mould_style == "open" and not fits:
        _refuse_open_mould(name, deviation, fabrication)
    if device.layout.grooves(name):
        _check_grooves(name, device, fits and fabrication.mould_style != "split", fabrication)
    if fabrication.mould_style == "split" or not fits:
        return "split", plain
    return "open", cavity_of(name, device, shrinkage, fabrication.draft_deg, fabrication)


def least_draft_deg(cavity: Any, height: float) -> float:
    """Smallest angle in degrees by which a wall of the cavity opens towards the lid; negative for an undercut."""
    walls = [face for face in cavity.faces() if height - face.bounding_box().min.Z > 1e-6]
    normals = [face.normal_at(point).Z for face in walls for point in face.tessellate(0.02, 0.3)[0]]
    return min(degrees(asin(min(max(-z, -1.0), 1.0))) for z in normals)


def check_mould_sizes(fabrication: Fabrication, printer: PrinterProfile) -> None:
    """Raise InputError for walls, vents or pins that the printer cannot make."""
    checks = (
        ("mould_wall_mm", "a wall", printer["wall_mm"], "unsupported wall"),
        ("land_mm", "a rim", printer["supported_wall_mm"], "supported wall"),
        ("vent_width_mm", "a vent", printer["groove_mm"], "engraving"),
        ("overflow_mm", "a channel", printer["groove_mm"], "engraving"),
        ("pin_diameter_mm", "a pin", printer["feature_mm"], "pin"),
    )
    refuse_small_keys(fabrication, printer, checks)


def _refuse_shallow(name: str, cavity: Cavity, printer: PrinterProfile) -> None:
    refuse_thin(
        f"segment.{name}: its mould needs a cavity",
        min(cavity.size_x, cavity.size_y, cavity.height),
        printer["groove_mm"],
        f"the {printer.process.upper()} limit for the engraving",
        "make it larger" if cavity.shape == "dome" else f"cut it from sheet with fabrication.routes.{name} = 'sheet'",
    )


def _refuse_large_vents(name: str, cavity: Cavity, fabrication: Fabrication) -> None:
    """Refuse a vent that takes more than half of a side, as it leaves no wall to form it."""
    for key, size in (("vent_depth_mm", cavity.height), ("vent_width_mm", min(cavity.size_x, cavity.size_y))):
        value = getattr(fabrication, key)
        if value > size / 2:
            raise InputError(
                f"fabrication.{key} = {value:g}: the cavity of segment.{name} measures {size:.3g} mm there; must be "
                f"at most half of it, {size / 2:.3g}"
            )


def _refuse_undercut(name: str, cavity: Cavity) -> None:
    draft = least_draft_deg(cavity.solid, cavity.height)
    if draft < -1e-3:
        raise InputError(
            f"fabrication.lid_face = 'top': the {cavity.shape} of segment.{name} would be an undercut, its walls "
            f"close towards the lid by up to {-draft:.0f} degrees where the limit is 0; lid_face = 'base' parts "
            "the mould at its base"
        )


def _check_grooves(name: str, device: Device, opens: bool, fabrication: Fabrication) -> None:
    """Refuse ridges of grooves that cannot be printed, or that do not stand on the floor of an open mould."""
    printer = printer_profile(fabrication.printer)
    for number, groove in enumerate(device.layout.array.grooves):
        field = f"array.grooves[{number}]"
        if groove.layer != name:
            continue
        if fabrication.lid_face == "top":
            raise InputError(
                f"fabrication.lid_face = 'top': the ridges that form {field} stand on the floor; use 'base'"
            )
        if not opens:
            raise InputError(
                f"{field}.layer = '{name}': its ridges need an open mould, which mould_style = "
                f"'{fabrication.mould_style}' with draft_deg = {fabrication.draft_deg:g} and tolerance_mm = "
                f"{fabrication.tolerance_mm:g} does not give {name}"
            )
        refuse_thin(
            f"{field}.width_mm = {groove.width_mm:g}: its mould has a ridge",
            groove.width_mm,
            printer["supported_wall_mm"],
            f"the {printer.process.upper()} limit for the supported wall",
            "make the groove wider",
        )


def _refuse_open_mould(name: str, deviation: float, fabrication: Fabrication) -> None:
    if fabrication.draft_deg < LEAST_DRAFT_DEG:
        raise InputError(
            f"fabrication.draft_deg = {fabrication.draft_deg:g}: the walls of segment.{name} do not leave a mould "
            f"without a parting at less than {LEAST_DRAFT_DEG:g} degree; use mould_style = 'split' or 'auto'"
        )
    raise InputError(
        f"fabrication.mould_style = 'open': {fabrication.draft_deg:g} degree of draft makes segment.{name} deviate "
        f"by {deviation:.3g} mm, above tolerance_mm = {fabrication.tolerance_mm:g}; use mould_style = 'split' or "
        "'auto', or allow a larger tolerance_mm"
    )
