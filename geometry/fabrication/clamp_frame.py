"""The clamp frame of held sides and the open base of free ones; refused where it cannot be printed or assembled."""

from typing import Any

from geometry.base import InputError
from geometry.fabrication.frame_layout import (
    TAB_CLEARANCE_MM,
    TIE_MM,
    FrameLayout,
    WallRun,
    frame_layout,
    held_names,
    widest_gap,
)
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import (
    PROCESSES,
    ROUNDING_MM,
    FabricationPart,
    box,
    fabrication_part,
    joined,
    post,
    refuse_small_keys,
    refuse_thin,
    without,
)
from geometry.fabrication.printers import PrinterProfile, printer_profile
from geometry.parameters import Segment


def check_frame(segment: Segment, layout: FrameLayout, fabrication: Fabrication) -> None:
    """InputError with the limit that a wall, ledge, hole or flange breaks."""
    printer = printer_profile(fabrication.printer)
    _check_keys(fabrication, printer)
    _check_pitch(layout, fabrication, printer)
    _check_cable(layout, fabrication, printer)
    for run in layout.ring:
        refuse_thin(
            f"segment.held_layers = {list(segment.held_layers)}: the clamp frame needs a ledge",
            run.top - run.bottom,
            printer["supported_wall_mm"],
            f"the {printer.process.upper()} limit for the supported wall",
            "hold a thicker layer or several neighbours",
        )
    _check_flange(segment, layout, fabrication)


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
    """The tab is narrower than the footprint, its channel leaves a floor and the shelf has room for a tie."""
    widest = layout.frame.across - 2 * TAB_CLEARANCE_MM
    if fabrication.tab_width_mm > widest + ROUNDING_MM:
        raise InputError(
            f"fabrication.tab_width_mm = {fabrication.tab_width_mm:g}: must be at most {widest:.3g}, the footprint at "
            f"cable_exit = '{fabrication.cable_exit}' less {TAB_CLEARANCE_MM:g} mm on each side"
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
        (fabrication.shelf_mm - TIE_MM[0]) / 2,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "make the shelf longer",
    )


def _check_pitch(layout: FrameLayout, fabrication: Fabrication, printer: PrinterProfile) -> None:
    """The wall between neighbours is what the pitch leaves beside the widest opening."""
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


def _check_flange(segment: Segment, layout: FrameLayout, fabrication: Fabrication) -> None:
    """The flange of a held film lies on the body beside medium 2."""
    room = layout.half_along - layout.frame.along / 2 - (layout.frame.count_along - 1) * layout.pitch / 2
    if "film" in held_names(segment) and fabrication.film_flange_mm > room + ROUNDING_MM:
        raise InputError(
            f"fabrication.film_flange_mm = {fabrication.film_flange_mm:g}: the frame has only {room:.3g} mm beside "
            f"the footprint; must be at most that, or give a thicker wall than wall_mm = {fabrication.wall_mm:g}"
        )


def frame_parts(segment: Segment, fabrication: Fabrication) -> tuple[FabricationPart, ...]:
    """Body and ring of the clamp frame, or the open base where no sides are held. InputError for impossible ones.

    The film lies on the body, whose top is the top of medium 2; the ring closes over its flange.
    """
    layout = frame_layout(segment, fabrication)
    check_frame(segment, layout, fabrication)
    fine = PROCESSES[fabrication.printer]
    if layout.body is None:
        solid = layout.frame.placed(_base(layout, fabrication))
        purpose = "Carries the free segment, which is glued inside the groove; the tab is tied down on the shelf."
        return (fabrication_part("base", solid, "frame", purpose, fine),)
    body = layout.frame.placed(_body(layout, layout.body, fabrication))
    purpose = "Carries the segment; the film's flange lies on its top and its tab is tied down on the shelf."
    parts = [fabrication_part("frame-body", body, "frame", purpose, fine)]
    if layout.ring:
        ring = layout.frame.placed(_ring(layout, fabrication))
        purpose = "Is screwed onto the body, clamps the film and holds the sides of the layers above it with glue."
        parts.append(fabrication_part("frame-ring", ring, "frame", purpose, fine))
    return tuple(parts)


def _body(layout: FrameLayout, opening: WallRun, fabrication: Fabrication) -> Any:
    top = layout.film_bottom
    block = _block(layout, (-fabrication.floor_mm, top))
    shelf = _shelf(layout, (-fabrication.floor_mm, top - fabrication.tab_slot_mm), fabrication)
    cuts = [*_openings(layout, opening, 1.0), *_screw_holes(layout, fabrication), *_tie_slots(layout, fabrication)]
    return without(joined(block, [shelf]), [*cuts, *_tab_channels(layout, fabrication)])


def _ring(layout: FrameLayout, fabrication: Fabrication) -> Any:
    top = layout.ring[-1].top
    block = _block(layout, (layout.film_top, top))
    cuts = [one for run in layout.ring for one in _openings(layout, run, 1.0 if run.top == top else 0.0)]
    return without(block, [*cuts, *_screw_holes(layout, fabrication)])


def _base(layout: FrameLayout, fabrication: Fabrication) -> Any:
    """A plate with a groove around each footprint, which takes up the glue that is pressed out."""
    groove = printer_profile(fabrication.printer)["groove_mm"]
    tall = (-fabrication.floor_mm, 0.0)
    plate = joined(_block(layout, tall), [_shelf(layout, tall, fabrication)])
    rings = []
    for x, y in layout.centers:
        half_x, half_y = layout.frame.along / 2, layout.frame.across / 2
        outer = _around(x, y, half_x + groove, half_y + groove, (-groove, 1.0))
        rings.append(without(outer, [_around(x, y, half_x, half_y, (-2 * groove, 2.0))]))
    return without(plate, [*rings, *_screw_holes(layout, fabrication), *_tie_slots(layout, fabrication)])


def _block(layout: FrameLayout, tall: tuple[float, float]) -> Any:
    return box((-layout.half_along, layout.half_along), (-layout.half_across, layout.half_across), tall)


def _shelf(layout: FrameLayout, tall: tuple[float, float], fabrication: Fabrication) -> Any:
    """Beyond the frame, a little into it so that both join."""
    far = layout.half_along + fabrication.shelf_mm
    return box((layout.half_along - 0.1, far), (-layout.half_across, layout.half_across), tall)


def _around(x: float, y: float, half_x: float, half_y: float, tall: tuple[float, float]) -> Any:
    return box((x - half_x, x + half_x), (y - half_y, y + half_y), tall)


def _openings(layout: FrameLayout, run: WallRun, beyond: float) -> list[Any]:
    """One for each segment; cut beyond an open top, so that no skin is left there."""
    half_x, half_y = layout.frame.along / 2 + run.gap, layout.frame.across / 2 + run.gap
    return [_around(x, y, half_x, half_y, (run.bottom, run.top + beyond)) for x, y in layout.centers]


def _screw_holes(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    top = layout.ring[-1].top if layout.ring else layout.film_top
    tall = (-fabrication.floor_mm - 1.0, top + 1.0)
    return [post(0.0, side * layout.screws_across, tall, fabrication.screw_diameter_mm) for side in (-1, 1)]


def _tab_channels(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    """One for each row of segments, from its middle to the shelf."""
    half = fabrication.tab_width_mm / 2 + TAB_CLEARANCE_MM
    tall = (layout.film_bottom - fabrication.tab_slot_mm, layout.film_bottom + 1.0)
    near = min(x for x, _ in layout.centers)
    rows = sorted({y for _, y in layout.centers})
    return [box((near, layout.half_along + 1.0), (y - half, y + half), tall) for y in rows]


def _tie_slots(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    """Two slots beside the tabs, half-way along the shelf."""
    middle, (long, wide) = layout.half_along + fabrication.shelf_mm / 2, TIE_MM
    rows = [y for _, y in layout.centers]
    inner = max(rows) + fabrication.tab_width_mm / 2 + 2 * TAB_CLEARANCE_MM
    tall = (-fabrication.floor_mm - 1.0, layout.film_top + 1.0)
    spans = ((inner, inner + wide), (-inner - wide, -inner))
    return [box((middle - long / 2, middle + long / 2), span, tall) for span in spans]
