"""Parts of the clamp frame of held sides and of the open base of free ones. Lengths in millimetres."""

from collections.abc import Sequence
from typing import Any

from geometry.fabrication.device import Device
from geometry.fabrication.frame_checks import check_frame
from geometry.fabrication.frame_layout import TAB_CLEARANCE_MM, TIE_SLOT_MM, FrameLayout, WallRun, frame_layout
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import (
    PROCESSES,
    FabricationPart,
    box,
    fabrication_part,
    fuse_solids,
    post,
    printer_profile,
    subtract_solids,
)


def frame_parts(device: Device, fabrication: Fabrication) -> tuple[FabricationPart, ...]:
    """Body and ring of the clamp frame, or the open base where no sides are held. InputError for an impossible frame.

    The film lies on the body, whose top is the top of medium 2; the ring closes over its flange.
    """
    layout = frame_layout(device, fabrication)
    check_frame(device, layout, fabrication)
    fine, what = PROCESSES[fabrication.printer], "array" if device.is_array else "segment"
    if layout.body is None:
        solid = layout.frame.solid_in_device(_base_solid(layout, fabrication))
        purpose = f"Carries the free {what}, which is glued inside the groove; the tab is tied down on the shelf."
        return (fabrication_part("base", solid, "frame", purpose, fine),)
    body = layout.frame.solid_in_device(_body_solid(layout, layout.body, fabrication))
    purpose = f"Carries the {what}; the film's flange lies on its top and its tab is tied down on the shelf."
    purpose = _purpose_with_bars(purpose, [layout.body])
    parts = [fabrication_part("frame-body", body, "frame", purpose, fine)]
    if layout.ring:
        ring = layout.frame.solid_in_device(_ring_solid(layout, fabrication))
        purpose = "Is screwed onto the body, clamps the film and holds the sides of the layers above it with glue."
        purpose = _purpose_with_bars(purpose, layout.ring)
        parts.append(fabrication_part("frame-ring", ring, "frame", purpose, fine))
    return tuple(parts)


def _purpose_with_bars(purpose: str, runs: Sequence[WallRun]) -> str:
    """The purpose of a part, with a clause where its bars are the stiff grid too."""
    return purpose.replace(".", "; its bars are the stiff grid.") if any(len(run.feet) > 1 for run in runs) else purpose


def _body_solid(layout: FrameLayout, opening: WallRun, fabrication: Fabrication) -> Any:
    top = layout.film_bottom
    block = _block_solid(layout, (-fabrication.floor_mm, top))
    shelf = _shelf_solid(layout, (-fabrication.floor_mm, top - fabrication.tab_slot_mm), fabrication)
    cuts = [
        *_opening_solids(layout, opening, 1.0),
        *_screw_holes(layout, fabrication),
        *_tie_slots(layout, fabrication),
    ]
    return subtract_solids(fuse_solids(block, [shelf]), [*cuts, *_tab_channels(layout, fabrication)])


def _ring_solid(layout: FrameLayout, fabrication: Fabrication) -> Any:
    top = layout.ring[-1].top
    block = _block_solid(layout, (layout.film_top, top))
    cuts = [one for run in layout.ring for one in _opening_solids(layout, run, 1.0 if run.top == top else 0.0)]
    return subtract_solids(block, [*cuts, *_screw_holes(layout, fabrication)])


def _base_solid(layout: FrameLayout, fabrication: Fabrication) -> Any:
    """A plate with a groove around each footprint, which takes up the glue that is pressed out."""
    groove = printer_profile(fabrication.printer)["groove_mm"]
    tall = (-fabrication.floor_mm, 0.0)
    plate = fuse_solids(_block_solid(layout, tall), [_shelf_solid(layout, tall, fabrication)])
    rings = []
    for x, y in layout.centers:
        half_x, half_y = layout.frame.along / 2, layout.frame.across / 2
        outer = _box_around(x, y, half_x + groove, half_y + groove, (-groove, 1.0))
        rings.append(subtract_solids(outer, [_box_around(x, y, half_x, half_y, (-2 * groove, 2.0))]))
    return subtract_solids(plate, [*rings, *_screw_holes(layout, fabrication), *_tie_slots(layout, fabrication)])


def _block_solid(layout: FrameLayout, tall: tuple[float, float]) -> Any:
    return box((-layout.half_along, layout.half_along), (-layout.half_across, layout.half_across), tall)


def _shelf_solid(layout: FrameLayout, tall: tuple[float, float], fabrication: Fabrication) -> Any:
    """The shelf beyond the frame; it reaches a little into the frame so that both fuse."""
    far = layout.half_along + fabrication.shelf_mm
    return box((layout.half_along - 0.1, far), (-layout.half_across, layout.half_across), tall)


def _box_around(x: float, y: float, half_x: float, half_y: float, tall: tuple[float, float]) -> Any:
    return box((x - half_x, x + half_x), (y - half_y, y + half_y), tall)


def _opening_solids(layout: FrameLayout, run: WallRun, beyond: float) -> list[Any]:
    """One box for each foot of a run of walls, reaching beyond an open top, so that no skin is left there."""
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
    """One channel for each row of devices, from its footprint to the shelf."""
    half = layout.half_tab + TAB_CLEARANCE_MM
    tall = (layout.film_bottom - fabrication.tab_slot_mm, layout.film_bottom + 1.0)
    near = min(x for x, _ in layout.centers) + layout.frame.along / 2
    rows = sorted({y for _, y in layout.centers})
    return [box((near, layout.half_along + 1.0), (y - half, y + half), tall) for y in rows]


def _tie_slots(layout: FrameLayout, fabrication: Fabrication) -> list[Any]:
    """Two slots beside the tabs, half-way along the shelf."""
    middle, (long, wide) = layout.half_along + fabrication.shelf_mm / 2, TIE_SLOT_MM
    rows = [y for _, y in layout.centers]
    inner = max(rows) + layout.half_tab + 2 * TAB_CLEARANCE_MM
    tall = (-fabrication.floor_mm - 1.0, layout.film_top + 1.0)
    spans = ((inner, inner + wide), (-inner - wide, -inner))
    return [box((middle - long / 2, middle + long / 2), span, tall) for span in spans]
