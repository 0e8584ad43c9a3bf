"""Which kind of mould a component gets, and the refusal of one from which nothing comes out."""

from math import asin, degrees
from typing import Any, Literal

from geometry.errors import InputError
from geometry.fabrication.cavity import Cavity, cavity_of, draft_deviation
from geometry.fabrication.limits import refuse_small_keys, refuse_thin
from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Segment
from geometry.printers import PrinterProfile, printer_profile

Style = Literal["open", "split"]
LEAST_DRAFT_DEG = 1.0
"""Of a wall that the part slides along when it leaves the mould: 1 to 3 degrees are the rule of the trade."""


def styled_cavity(name: str, segment: Segment, shrinkage: float, fabrication: Fabrication) -> tuple[Style, Cavity]:
    """The style of the mould of a component and its cavity. InputError for a mould that cannot be opened.

    A dome opens by itself towards its base. Walls of boxes and cylinders need draft in one plate, and none in
    a split mould, whose bars are drawn off sideways.
    """
    plain = cavity_of(name, segment, shrinkage, 0.0, fabrication)
    _refuse_shallow(name, plain, printer_profile(fabrication.printer))
    _refuse_large_vents(name, plain, fabrication)
    if plain.shape == "dome":
        _refuse_undercut(name, plain)
        return "open", plain
    deviation = draft_deviation(plain.shape, plain.height, fabrication.draft_deg)
    fits = fabrication.draft_deg >= LEAST_DRAFT_DEG and deviation <= fabrication.tolerance_mm
    if fabrication.mould_style == "open" and not fits:
        _refuse_open(name, deviation, fabrication)
    if fabrication.mould_style == "split" or not fits:
        return "split", plain
    return "open", cavity_of(name, segment, shrinkage, fabrication.draft_deg, fabrication)


def least_draft_deg(cavity: Any, height: float) -> float:
    """Smallest angle by which a wall of the cavity opens towards the lid, in degrees; negative for an undercut."""
    walls = [face for face in cavity.faces() if height - face.bounding_box().min.Z > 1e-6]
    normals = [face.normal_at(point).Z for face in walls for point in face.tessellate(0.02, 0.3)[0]]
    return min(degrees(asin(min(max(-z, -1.0), 1.0))) for z in normals)


def check_mould_sizes(fabrication: Fabrication, printer: PrinterProfile) -> None:
    """InputError for walls, vents or pins that the printer cannot make."""
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
    """A vent that takes more than half of a side leaves no wall to form it."""
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


def _refuse_open(name: str, deviation: float, fabrication: Fabrication) -> None:
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
