"""Checks that refuse a clamp frame that cannot be printed or assembled, with the limit that it breaks."""

from foundation.errors import InputError
from geometry.fabrication.device import Device, held_layer_names
from geometry.fabrication.frame_layout import TAB_CLEARANCE_MM, TIE_SLOT_MM, FrameLayout, widest_gap
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import (
    ROUNDING_MM,
    PrinterProfile,
    printer_profile,
    refuse_small_keys,
    refuse_thin,
)
from geometry.flat.film import FilmLayout


def check_frame(device: Device, layout: FrameLayout, fabrication: Fabrication) -> None:
    """Raise InputError with the limit that a wall, ledge, hole or flange breaks."""
    printer = printer_profile(fabrication.printer)
    _check_keys(fabrication, printer)
    _check_pitch(layout, fabrication, printer)
    _check_grid(device, layout, printer)
    _check_cable(layout, fabrication, printer)
    for run in layout.ring:
        refuse_thin(
            f"segment.held_layers = {list(device.stack.held_layers)}: the clamp frame needs a ledge",
            run.top - run.bottom,
            printer["supported_wall_mm"],
            f"the {printer.process.upper()} limit for the supported wall",
            "hold a thicker layer or several neighbours",
        )
    _check_flange(device, layout, fabrication)


def _check_keys(fabrication: Fabrication, printer: PrinterProfile) -> None:
    checks = (
        ("wall_mm", "an outer wall", printer["wall_mm"], "unsupported wall"),
        ("floor_mm", "a floor", printer["supported_wall_mm"], "supported wall"),
        ("screw_diameter_mm", "a hole", printer["hole_mm"], "hole"),
        ("tab_slot_mm", "a channel", printer["groove_mm"], "engraving"),
        ("pin_diameter_mm", "a pin", printer["feature_mm"], "pin"),
    )
    refuse_small_keys(fabrication, printer, checks)


def _check_cable(layout: FrameLayout, fabrication: Fabrication, printer: PrinterProfile) -> None:
    """Refuse a tab that is too wide, a channel that leaves no floor, and a shelf without room for a cable tie."""
    widest = layout.room_for_tab - 2 * TAB_CLEARANCE_MM
    if 2 * layout.half_tab > widest + ROUNDING_MM:
        side = "" if fabrication.tab_width_mm else "; the leads need it, so let the cable leave on a longer side"
        raise InputError(
            f"fabrication.tab_width_mm = {2 * layout.half_tab:g}: must be at most {widest:.3g}, the width at "
            f"cable_exit = '{fabrication.cable_exit}' less {TAB_CLEARANCE_MM:g} mm on each side{side}"
        )
    refuse_thin(
        f"fabrication.tab_slot_mm = {fabrication.tab_slot_mm:g}: the shelf under the tab has a thickness",
        layout.film_bottom + fabrication.floor_mm - fabrication.tab_slot_mm,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "make the slot shallower or floor_mm larger",
    )
    refuse_thin(
        f"fabrication.shelf_mm = {fabrication.shelf_mm:g}: the slots for the cable tie leave a wall",
        (fabrication.shelf_mm - TIE_SLOT_MM[0]) / 2,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "make the shelf longer",
    )


def _check_pitch(layout: FrameLayout, fabrication: Fabrication, printer: PrinterProfile) -> None:
    """Refuse a pitch that leaves too thin a wall between neighbouring openings."""
    if fabrication.pitch_mm is None:
        if max(fabrication.array) > 1:
            raise InputError(f"fabrication.pitch_mm is missing: array = {list(fabrication.array)} needs it")
        return
    gap = widest_gap(layout.body, layout.ring)
    size = layout.size_between
    largest = max(fabrication.pitch_mm - printer["supported_wall_mm"] - 2 * gap, 0.0)
    refuse_thin(
        f"fabrication.pitch_mm = {fabrication.pitch_mm:g}: segments of {size:g} mm with a gap of {gap:g} mm on each "
        "side leave a wall between them",
        fabrication.pitch_mm - size - 2 * gap,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        f"at this pitch a segment may be at most {largest:.3g} mm wide",
    )


def _check_grid(device: Device, layout: FrameLayout, printer: PrinterProfile) -> None:
    """Refuse gaps between segments that leave too thin bars between the openings of one device."""
    for run in (layout.body, *layout.ring):
        if run is None or len(run.feet) == 1:
            continue
        gap = min(one for one in device.layout.gap_mm if one < float("inf"))
        segments = device.layout
        least = printer["supported_wall_mm"]
        refuse_thin(
            f"array.grid_layers = {list(segments.array.grid_layers)}: gaps of {gap:.3g} mm between segments with "
            f"{run.gap:g} mm on each side leave bars",
            gap - 2 * run.gap,
            least,
            f"the {printer.process.upper()} limit for the supported wall",
            f"at the pitch of {segments.pitch_mm:g} mm a segment may be at most "
            f"{max(segments.pitch_mm - least - 2 * run.gap, 0.0):.3g} mm wide",
        )


def check_tab(film: FilmLayout, case: FrameLayout, fabrication: Fabrication) -> None:
    """Raise InputError for a tab that does not fit its film or its frame."""
    if film.half_tab > film.half_body + ROUNDING_MM:
        raise InputError(
            f"fabrication.tab_width_mm = {2 * film.half_tab:g}: the film is only {2 * film.half_body:g} mm "
            "wide there; must be at most that"
        )
    if film.frame.count_along > 1:
        raise InputError(
            f"fabrication.array = {list(fabrication.array)}: with cable_exit = '{fabrication.cable_exit}' the tab of "
            "one segment would lie on the next one; put the segments side by side as seen from the cable"
        )
    needed = case.half_along - film.frame.along / 2
    if fabrication.tab_length_mm < needed - ROUNDING_MM:
        raise InputError(
            f"fabrication.tab_length_mm = {fabrication.tab_length_mm:g}: the tab would end inside the frame, whose "
            f"outside is {needed:.3g} mm from the footprint; must be at least that"
        )


def _check_flange(device: Device, layout: FrameLayout, fabrication: Fabrication) -> None:
    """Refuse a flange of a held film that is wider than the body beside medium 2, on which it lies."""
    room = layout.half_along - layout.frame.along / 2 - (layout.frame.count_along - 1) * layout.pitch / 2
    if "film" in held_layer_names(device.stack) and fabrication.film_flange_mm > room + ROUNDING_MM:
        raise InputError(
            f"fabrication.film_flange_mm = {fabrication.film_flange_mm:g}: the frame has only {room:.3g} mm beside "
            f"the footprint; must be at most that, or give a thicker wall than wall_mm = {fabrication.wall_mm:g}"
        )
