"""The clamp frame of held sides and the open base of free ones; refused where it cannot be printed or assembled.

How wide the clamp frame is at each height, seen from the cable: x points to where it leaves. Millimetres.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from geometry.array.layout import Rectangle
from geometry.base import InputError
from geometry.fabrication.device import Device, ExitFrame, held_names
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
from geometry.flat.film import FilmLayout, film_layout
from geometry.stack import layers

TAB_CLEARANCE_MM = 0.3
"""On each side of the film's tab: the smallest loose clearance (addema.se, layerx3d.in, forgelabs.com)."""
TIE_MM = (1.6, 3.0)
"""Slots for a cable tie, along and across the tab."""
LUG_MARGIN_MM = 1.5
"""Of material around the hole of a screw."""


@dataclass(frozen=True)
class WallRun:
    """Heights between which each opening is wider than what stands in it by the gap on each side, in mm.

    feet : what stands in the openings, seen from the cable; several where bars of a grid stand between them.
    """

    bottom: float
    top: float
    gap: float
    feet: tuple[Rectangle, ...]


@dataclass(frozen=True)
class FrameLayout:
    """frame : from the cable's side.

    film_bottom, film_top : heights. body : around medium 2, None where nothing is held. ring : above the film,
    empty where it is not needed. half_along, half_across : half the outer sizes, half_across with the lugs.
    pitch : between devices, 0 for a single one. screws_across : distance of the screws from the axis.
    half_tab : half the width of the film's tab. room_for_tab : of the footprint, of an array that of its film.
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
    half_tab: float
    room_for_tab: float

    @property
    def size_between(self) -> float:
        """The larger size of the footprint in the directions that have neighbours; a single device may have any."""
        counted = ((self.frame.count_along, self.frame.along), (self.frame.count_across, self.frame.across))
        sizes = [size for count, size in counted if count > 1]
        return max(sizes or [size for _, size in counted])

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Places of the devices."""
        counts = (self.frame.count_along, self.frame.count_across)
        along, across = ([(k - (count - 1) / 2) * self.pitch for k in range(count)] for count in counts)
        return list(product(along, across))


def frame_layout(device: Device, fabrication: Fabrication) -> FrameLayout:
    """The layout for a device that has passed its checks."""
    film, stack = film_layout(device, fabrication), {layer.name: layer for layer in layers(device.segment)}
    frame, held = film.frame, held_names(device.stack)
    ring = _closed_ring(device, held, frame, fabrication)
    body = _run("medium2", device, held, frame, fabrication) if held else None
    pitch = fabrication.pitch_mm or 0.0
    traces = film.beyond if film.lattice is not None else 0.0
    beside = max(widest_gap(body, ring) + fabrication.wall_mm, traces)
    half_along = ((frame.count_along - 1) * pitch + frame.along) / 2 + beside
    inner_across = ((frame.count_across - 1) * pitch + frame.across) / 2 + beside
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
        half_tab=film.half_tab,
        room_for_tab=frame.across if film.lattice is None else 2 * film.half_body,
    )


def widest_gap(body: WallRun | None, ring: tuple[WallRun, ...]) -> float:
    """The widest gap beside a layer in mm, at any height; 0 without walls."""
    return max((run.gap for run in (body, *ring) if run is not None), default=0.0)


def _closed_ring(device: Device, held: set[str], frame: ExitFrame, fabrication: Fabrication) -> tuple[WallRun, ...]:
    """Openings above the film up to the highest held layer, or around medium 1 where only the film is held."""
    above = [layer.name for layer in layers(device.segment) if layer.name in ("medium1", "effector")]
    kept = [name for name in above if name in held]
    if kept:
        above = above[: above.index(kept[-1]) + 1]
    elif "film" in held:
        above = above[:1]
    else:
        above = []
    runs: list[WallRun] = []
    for run in (_run(name, device, held, frame, fabrication) for name in above):
        if runs and (runs[-1].gap, runs[-1].feet) == (run.gap, run.feet):
            run = replace(run, bottom=runs.pop().bottom)
        runs.append(run)
    return tuple(runs)


def _run(name: str, device: Device, held: set[str], frame: ExitFrame, fabrication: Fabrication) -> WallRun:
    """The openings around one layer: one for each piece where the grid holds it or, above the film, clamps that."""
    layer = next(one for one in layers(device.segment) if one.name == name)
    gap = fabrication.glue_gap_mm if name in held else fabrication.side_clearance_mm
    clamps = name == "medium1" and device.layout.is_cut(name) and "film" in device.layout.array.grid_layers
    feet = device.feet(name) if device.in_grid(name) or clamps else device.feet_of_stack
    return WallRun(layer.bottom_mm, layer.top_mm, gap, tuple(map(frame.seen, feet)))


def check_frame(device: Device, layout: FrameLayout, fabrication: Fabrication) -> None:
    """InputError with the limit that a wall, ledge, hole or flange breaks."""
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
    """The tab is narrow enough, its channel leaves a floor and the shelf has room for a tie."""
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


def _check_grid(device: Device, layout: FrameLayout, printer: PrinterProfile) -> None:
    """The bars between the openings of one device are what its gaps leave beside the glue."""
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
    """InputError for a tab that does not fit its film or its frame."""
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
    """The flange of a held film lies on the body beside medium 2."""
    room = layout.half_along - layout.frame.along / 2 - (layout.frame.count_along - 1) * layout.pitch / 2
    if "film" in held_names(device.stack) and fabrication.film_flange_mm > room + ROUNDING_MM:
        raise InputError(
            f"fabrication.film_flange_mm = {fabrication.film_flange_mm:g}: the frame has only {room:.3g} mm beside "
            f"the footprint; must be at most that, or give a thicker wall than wall_mm = {fabrication.wall_mm:g}"
        )


def frame_parts(device: Device, fabrication: Fabrication) -> tuple[FabricationPart, ...]:
    """Body and ring of the clamp frame, or the open base where no sides are held. InputError for impossible ones.

    The film lies on the body, whose top is the top of medium 2; the ring closes over its flange.
    """
    layout = frame_layout(device, fabrication)
    check_frame(device, layout, fabrication)
    fine, what = PROCESSES[fabrication.printer], "array" if device.is_array else "segment"
    if layout.body is None:
        solid = layout.frame.placed(_base(layout, fabrication))
        purpose = f"Carries the free {what}, which is glued inside the groove; the tab is tied down on the shelf."
        return (fabrication_part("base", solid, "frame", purpose, fine),)
    body = layout.frame.placed(_body(layout, layout.body, fabrication))
    purpose = f"Carries the {what}; the film's flange lies on its top and its tab is tied down on the shelf."
    purpose = _with_bars(purpose, [layout.body])
    parts = [fabrication_part("frame-body", body, "frame", purpose, fine)]
    if layout.ring:
        ring = layout.frame.placed(_ring(layout, fabrication))
        purpose = "Is screwed onto the body, clamps the film and holds the sides of the layers above it with glue."
        purpose = _with_bars(purpose, layout.ring)
        parts.append(fabrication_part("frame-ring", ring, "frame", purpose, fine))
    return tuple(parts)


def _with_bars(purpose: str, runs: Sequence[WallRun]) -> str:
    """The purpose of a part that is the stiff grid too."""
    return purpose.replace(".", "; its bars are the stiff grid.") if any(len(run.feet) > 1 for run in runs) else purpose


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
    """One for each foot; cut beyond an open top, so that no skin is left there."""
    tall, gap = (run.bottom, run.top + beyond), run.gap
    return [
        box((x + u0 - gap, x + u1 + gap), (y + v0 - gap, y + v1 + gap), tall)
        for x, y in layout.centers
        for u0, u1, v0, v1 in run.feet
    ]


def _screw_holes(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    top = layout.ring[-1].top if layout.ring else layout.film_top
    tall = (-fabrication.floor_mm - 1.0, top + 1.0)
    return [post(0.0, side * layout.screws_across, tall, fabrication.screw_diameter_mm) for side in (-1, 1)]


def _tab_channels(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    """One for each row of devices, from its footprint to the shelf."""
    half = layout.half_tab + TAB_CLEARANCE_MM
    tall = (layout.film_bottom - fabrication.tab_slot_mm, layout.film_bottom + 1.0)
    near = min(x for x, _ in layout.centers) + layout.frame.along / 2
    rows = sorted({y for _, y in layout.centers})
    return [box((near, layout.half_along + 1.0), (y - half, y + half), tall) for y in rows]


def _tie_slots(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    """Two slots beside the tabs, half-way along the shelf."""
    middle, (long, wide) = layout.half_along + fabrication.shelf_mm / 2, TIE_MM
    rows = [y for _, y in layout.centers]
    inner = max(rows) + layout.half_tab + 2 * TAB_CLEARANCE_MM
    tall = (-fabrication.floor_mm - 1.0, layout.film_top + 1.0)
    spans = ((inner, inner + wide), (-inner - wide, -inner))
    return [box((middle - long / 2, middle + long / 2), span, tall) for span in spans]
