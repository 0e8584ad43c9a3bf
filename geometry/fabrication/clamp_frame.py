"""The clamp frame of held sides and the open base of free ones; refused where it cannot be printed or assembled.

How wide the clamp frame is at each height, seen from the cable: x points to where it leaves. Millimetres.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any

from geometry.base import InputError
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import (
    PROCESSES,
    ROUNDING_MM,
    FabricationPart,
    PrinterProfile,
    box,
    fabrication_part,
    joined,
    post,
    printer_profile,
    refuse_small_keys,
    refuse_thin,
    without,
)
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.stack import Layer, layers

TURNS_DEG = {"+x": 0.0, "+y": 90.0, "-x": 180.0, "-y": 270.0}


@dataclass(frozen=True)
class ExitFrame:
    """along, across : sizes of the footprint in x (towards the cable) and y of this frame.

    count_along, count_across : segments of the array. turn_deg : about z, back into the segment's frame.
    """

    along: float
    across: float
    count_along: int
    count_across: int
    turn_deg: float

    def placed(self, solid: Any) -> Any:
        """A solid of this frame in the frame of the segment."""
        from build123d import Rot

        return Rot(0, 0, self.turn_deg) * solid


def exit_frame(segment: Segment, fabrication: Fabrication) -> ExitFrame:
    """The frame of fabrication.cable_exit."""
    sizes, counts = (segment.length_mm, segment.width_mm), fabrication.array
    if fabrication.cable_exit.endswith("y"):
        sizes, counts = (sizes[1], sizes[0]), (counts[1], counts[0])
    return ExitFrame(*sizes, *counts, TURNS_DEG[fabrication.cable_exit])


TAB_CLEARANCE_MM = 0.3
"""On each side of the film's tab: the smallest loose clearance (addema.se, layerx3d.in, forgelabs.com)."""
TIE_MM = (1.6, 3.0)
"""Slots for a cable tie, along and across the tab."""
LUG_MARGIN_MM = 1.5
"""Of material around the hole of a screw."""


@dataclass(frozen=True)
class WallRun:
    """Heights between which the opening is wider than the footprint by the gap on each side, in mm."""

    bottom: float
    top: float
    gap: float


@dataclass(frozen=True)
class FrameLayout:
    """frame : from the cable's side.

    film_bottom, film_top : heights. body : around medium 2, None where nothing is held. ring : above the film,
    empty where it is not needed. half_along, half_across : half the outer sizes, half_across with the lugs.
    pitch : between segments, 0 for a single one. screws_across : distance of the screws from the axis.
    """

    frame: ExitFrame
    film_bottom: float
    film_top: float
    body: WallRun | None
    ring: tuple[WallRun, ...]
    half_along: float
    half_across: float
    pitch: float
    screws_across: float

    @property
    def size_between(self) -> float:
        """The larger size of the footprint in the directions that have neighbours; a single segment may have any."""
        counted = ((self.frame.count_along, self.frame.along), (self.frame.count_across, self.frame.across))
        sizes = [size for count, size in counted if count > 1]
        return max(sizes or [size for _, size in counted])

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Places of the segments."""
        counts = (self.frame.count_along, self.frame.count_across)
        along, across = ([(k - (count - 1) / 2) * self.pitch for k in range(count)] for count in counts)
        return list(product(along, across))


def frame_layout(segment: Segment, fabrication: Fabrication) -> FrameLayout:
    """The layout for a segment that has passed its checks."""
    frame, stack = exit_frame(segment, fabrication), {layer.name: layer for layer in layers(segment)}
    held = held_names(segment)
    ring = _closed_ring(segment, held, fabrication)
    body = WallRun(0.0, stack["film"].bottom_mm, _gap("medium2", held, fabrication)) if held else None
    pitch = fabrication.pitch_mm or 0.0
    widest = widest_gap(body, ring)
    half_along = ((frame.count_along - 1) * pitch + frame.along) / 2 + widest + fabrication.wall_mm
    inner_across = ((frame.count_across - 1) * pitch + frame.across) / 2 + widest + fabrication.wall_mm
    lug = fabrication.screw_diameter_mm + 2 * LUG_MARGIN_MM
    return FrameLayout(
        frame=frame,
        film_bottom=stack["film"].bottom_mm,
        film_top=stack["film"].top_mm,
        body=body,
        ring=ring,
        half_along=max(half_along, lug / 2),
        half_across=inner_across + lug,
        pitch=pitch,
        screws_across=inner_across + lug / 2,
    )


def widest_gap(body: WallRun | None, ring: tuple[WallRun, ...]) -> float:
    """The widest gap beside a segment in mm, at any height; 0 without walls."""
    return max((run.gap for run in (body, *ring) if run is not None), default=0.0)


def held_names(segment: Segment) -> set[str]:
    """Names of the layers whose sides the frame holds."""
    if segment.boundary == "free":
        return set()
    names = {layer.name for layer in layers(segment)} & set(segment.held_layers)
    return names if covers_footprint(segment) else names - {"effector"}


def _closed_ring(segment: Segment, held: set[str], fabrication: Fabrication) -> tuple[WallRun, ...]:
    """Openings above the film up to the highest held layer, or around medium 1 where only the film is held."""
    above = [layer for layer in layers(segment) if layer.name in ("medium1", "effector")]
    kept = [layer for layer in above if layer.name in held]
    if kept:
        above = above[: above.index(kept[-1]) + 1]
    elif "film" in held:
        above = above[:1]
    else:
        above = []
    return _merged([(layer, _gap(layer.name, held, fabrication)) for layer in above])


def _merged(openings: list[tuple[Layer, float]]) -> tuple[WallRun, ...]:
    runs: list[WallRun] = []
    for layer, gap in openings:
        if runs and runs[-1].gap == gap:
            runs[-1] = WallRun(runs[-1].bottom, layer.top_mm, gap)
        else:
            runs.append(WallRun(layer.bottom_mm, layer.top_mm, gap))
    return tuple(runs)


def _gap(name: str, held: set[str], fabrication: Fabrication) -> float:
    return fabrication.glue_gap_mm if name in held else fabrication.side_clearance_mm


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
