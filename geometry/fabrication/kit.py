"""All solids of the fabrication kit of a device, with the assembly jig in which its layers are stacked."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry.fabrication.casting import CavityCheck, Pour, casting_kit
from geometry.fabrication.clamp_frame import frame_parts
from geometry.fabrication.device import Device, ExitFrame, exit_frame, lone_device
from geometry.fabrication.parameters import Fabrication, sheet_components
from geometry.fabrication.part import (
    PROCESSES,
    ROUNDING_MM,
    FabricationPart,
    box,
    fabrication_part,
    fuse_solids,
    pin,
    post,
    printer_profile,
    refuse_thin,
    subtract_solids,
)
from geometry.flat.film import film_layout
from geometry.part_checks import covers_footprint
from geometry.stack import Box, bodies, layers

CORNER_RELIEF_MM = 1.0
"""Diameter of the hole in the corner: sharp edges of the layers find room there."""
GAUGE_STEP_MM = 3.0
"""Width of a step of the gauge."""
FLOOR_REACH_MM = 4.0
"""Floor beyond the footprint, at least, for tweezers."""
LOCATOR_THICKNESS_MM = 1.2


def jig_parts(device: Device, fabrication: Fabrication) -> tuple[FabricationPart, ...]:
    """The jig, and the locator where effectors are narrower than their segments.

    They lie in the axes of what is stacked but for the height: the floor of the jig is at z = 0.
    """
    tops, stacked = stacked_tops(device, fabrication), jig_device(device, fabrication)
    frame = exit_frame(stacked.stack, fabrication)
    narrow = not covers_footprint(device.segment)
    stops = list(tops.values())[-2 if narrow else -1]
    jig = fuse_solids(_corner_solid(frame, stops, fabrication), _gauge_steps(tops, frame, fabrication))
    if narrow:
        tall = (-fabrication.floor_mm / 2, stops + LOCATOR_THICKNESS_MM)
        jig = fuse_solids(
            jig, [pin(x, y, tall, fabrication.pin_diameter_mm) for x, y in _pin_places(frame, fabrication)]
        )
    heights = ", ".join(f"{top:.3g} mm" for name, top in tops.items() if name != "film")
    purpose = (
        "The layers are stacked against its two stops; the steps beside it show how high the stack is after each "
        f"layer: {heights}."
    )
    fine = PROCESSES[fabrication.printer]
    parts = [fabrication_part("jig", frame.solid_in_device(jig), "jig", purpose, fine)]
    if narrow:
        _check_locator(stacked, fabrication)
        plate = _locator_plate(stacked, frame, stops, fabrication)
        what = "the effectors" if stacked.is_array else "the effector"
        purpose = f"Lies on the jig's stops and pins and centres {what} on medium 1."
        parts.append(fabrication_part("jig-locator", plate, "jig", purpose, fine))
    return tuple(parts)


def stacked_tops(device: Device, fabrication: Fabrication) -> dict[str, float]:
    """Name -> height over the floor of the jig, in mm, of the layers that are stacked there, in order.

    A film that reaches beyond the footprint does not go into the corner: then the jig takes what lies above the film,
    and frame or base take the rest.
    """
    wide = film_layout(device, fabrication).beyond > ROUNDING_MM
    stack = [layer for layer in layers(device.segment) if not wide or layer.name in ("medium1", "effector")]
    return {layer.name: layer.top_mm - stack[0].bottom_mm for layer in stack}


def jig_device(device: Device, fabrication: Fabrication) -> Device:
    """The device that is stacked in the jig at once: the whole, or one segment where all these layers are islands."""
    islands = all(device.layout.is_cut(name) for name in stacked_tops(device, fabrication))
    return lone_device(device.segment) if islands else device


def _check_locator(device: Device, fabrication: Fabrication) -> None:
    """Refuse too thin walls between the holes of neighbouring effectors."""
    if not device.is_array:
        return
    layout, printer = device.layout, printer_profile(fabrication.printer)
    foot = layout.foot_mm("effector")
    gap = min(
        layout.gap_mm[axis] + layout.size_mm[axis] - foot[axis] for axis in (0, 1) if len(layout.centres(axis)) > 1
    )
    refuse_thin(
        f"segment.effector: effectors {gap:.3g} mm apart leave walls between the holes of the locator",
        gap - 2 * fabrication.glue_gap_mm,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "make the effectors narrower or array.pitch_mm larger",
    )


def _corner_solid(frame: ExitFrame, stops: float, fabrication: Fabrication) -> Any:
    """Floor of the jig and two walls: one away from the cable, one beside it."""
    half_x, half_y, thick, reach = (
        frame.along / 2,
        frame.across / 2,
        _stop_thickness_mm(fabrication),
        _floor_reach_mm(fabrication),
    )
    whole_x, whole_y = (-half_x - thick, half_x + reach), (-half_y - thick, half_y + reach)
    floor = box(whole_x, whole_y, (-fabrication.floor_mm, 0.0))
    low = -fabrication.floor_mm / 2
    behind = box((-half_x - thick, -half_x), whole_y, (low, stops))
    beside = box(whole_x, (-half_y - thick, -half_y), (low, stops))
    return subtract_solids(
        fuse_solids(floor, [behind, beside]), [post(-half_x, -half_y, (0.0, stops + 1.0), CORNER_RELIEF_MM)]
    )


def _gauge_steps(tops: dict[str, float], frame: ExitFrame, fabrication: Fabrication) -> list[Any]:
    """Steps of a staircase along the outer side of the wall beside the cable; the film is too thin for one."""
    start = -frame.along / 2 - _stop_thickness_mm(fabrication)
    outer = -frame.across / 2 - _stop_thickness_mm(fabrication)
    return [
        box(
            (start + number * GAUGE_STEP_MM, start + (number + 1) * GAUGE_STEP_MM),
            (outer - GAUGE_STEP_MM, outer),
            (-fabrication.floor_mm, top),
        )
        for number, top in enumerate(top for name, top in tops.items() if name != "film")
    ]


def _stop_thickness_mm(fabrication: Fabrication) -> float:
    """Thickness in mm of the stops, which carry the pins of the locator, with a clearance around each."""
    beside = fabrication.wall_mm + fabrication.pin_clearance_mm
    return max(2 * fabrication.wall_mm, fabrication.pin_diameter_mm + 2 * beside)


def _floor_reach_mm(fabrication: Fabrication) -> float:
    """Width in mm of the floor beyond the footprint; the end of the stop that stands on it carries a pin too."""
    return max(FLOOR_REACH_MM, _stop_thickness_mm(fabrication))


def _pin_places(frame: ExitFrame, fabrication: Fabrication) -> list[tuple[float, float]]:
    """Places of the pins on the stop behind, each in the middle of an end, so that it has a whole wall around it."""
    thick, half = _stop_thickness_mm(fabrication), frame.across / 2
    x = -frame.along / 2 - thick / 2
    return [(x, -half - thick / 2), (x, half + _floor_reach_mm(fabrication) / 2)]


def _locator_plate(device: Device, frame: ExitFrame, stops: float, fabrication: Fabrication) -> Any:
    """The locator plate in the axes of the device."""
    thick, reach, tall = (
        _stop_thickness_mm(fabrication),
        _floor_reach_mm(fabrication),
        (stops, stops + LOCATOR_THICKNESS_MM),
    )
    low_x, low_y = -frame.along / 2 - thick, -frame.across / 2 - thick
    plate = box((low_x, frame.along / 2 + reach), (low_y, frame.across / 2 + reach), tall)
    through = (tall[0] - 1.0, tall[1] + 1.0)
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    holes = [post(x, y, through, hole) for x, y in _pin_places(frame, fabrication)]
    return subtract_solids(
        frame.solid_in_device(subtract_solids(plate, holes)), _effector_holes(device, through, fabrication)
    )


def _effector_holes(device: Device, through: tuple[float, float], fabrication: Fabrication) -> list[Any]:
    """The outline of each effector's foot, wider by the glue gap on each side."""
    body, gap = bodies(device.segment)[-1], fabrication.glue_gap_mm
    if isinstance(body, Box):
        return [
            box((x0 - gap, x1 + gap), (y0 - gap, y1 + gap), through) for x0, x1, y0, y1 in _effector_feet(device, body)
        ]
    radius = float(body.reach(np.array([1.0, 0.0, 0.0])))
    return [post(x, y, through, 2 * (radius + gap)) for x, y in device.layout.middles]


def _effector_feet(device: Device, body: Box) -> list[tuple[float, float, float, float]]:
    return [(x - body.half_x, x + body.half_x, y - body.half_y, y + body.half_y) for x, y in device.layout.middles]


@dataclass(frozen=True)
class SolidKit:
    """Solids of a kit. parts : all printable parts, labels unique.

    pours : one for each cast component.
    cavity_checks : one for each cast component, in the same order.
    cut_from_sheet : components that are cut instead.
    """

    parts: tuple[FabricationPart, ...]
    pours: tuple[Pour, ...]
    cavity_checks: tuple[CavityCheck, ...]
    cut_from_sheet: tuple[str, ...]


def solid_kit(device: Device, fabrication: Fabrication) -> SolidKit:
    """Moulds, clamp frame or base, and jig of a device that has passed its checks.

    InputError with one sentence for what cannot be made, before any mould is built.
    """
    cut = sheet_components(device.segment, fabrication)
    held, jig = frame_parts(device, fabrication), jig_parts(device, fabrication)
    cast = casting_kit(device, fabrication)
    parts = (*cast.parts, *held, *jig)
    return SolidKit(parts, cast.pours, cast.checks, cut)
