"""Printed parts of one mould, and where its cavities, channels, vents and pins lie. Lengths in millimetres."""

from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

from geometry.fabrication.cavity import Cavity, MouldStyle
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import box, fuse_solids, pin, post, printer_profile, refuse_thin, subtract_solids

PIN_MARGIN_MM = 1.5
"""Material around the hole of a pin."""


@dataclass(frozen=True)
class Gang:
    """Layout of the cavities of one mould in mm. columns_x, rows_y : the axes of the cavities.

    pitch_x, pitch_y : between neighbours. half_x, half_y : half the sizes of the mould.
    channels_x : half the length over the outer overflow channels. pin_x : the pins stand at -pin_x and pin_x.
    """

    columns_x: tuple[float, ...]
    rows_y: tuple[float, ...]
    pitch_x: float
    pitch_y: float
    half_x: float
    half_y: float
    channels_x: float
    pin_x: float

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Centre (x, y) of each cavity."""
        return list(product(self.columns_x, self.rows_y))


def gang_of(cavity: Cavity, style: MouldStyle, fabrication: Fabrication) -> Gang:
    """The layout of the cavities: around each lies a land, then an overflow channel."""
    around = 2 * fabrication.land_mm + fabrication.overflow_mm
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    lug = hole + 2 * PIN_MARGIN_MM
    pitch_x = cavity.size_x + around
    # each bar of a split mould carries pins
    narrowest = lug if style == "split" else 0.0
    pitch_y = max(cavity.size_y + around, narrowest)
    columns, rows = cavity.counts
    channels_x = (columns * pitch_x + fabrication.overflow_mm) / 2
    channels_y = (rows * pitch_y + fabrication.overflow_mm) / 2
    return Gang(
        columns_x=_evenly_spaced(columns, pitch_x),
        rows_y=_evenly_spaced(rows, pitch_y),
        pitch_x=pitch_x,
        pitch_y=pitch_y,
        half_x=channels_x + max(fabrication.mould_wall_mm, lug),
        half_y=channels_y + max(fabrication.mould_wall_mm, narrowest),
        channels_x=channels_x,
        pin_x=channels_x + max(fabrication.mould_wall_mm, lug) / 2,
    )


def overflow_channels(gang: Gang, top: float, depth: float, width: float) -> list[Any]:
    """Channels around every cavity; those along y run out at the edges of the mould."""
    high = (top - depth, top + depth)
    along_y = [
        box((x - width / 2, x + width / 2), (-gang.half_y - 1.0, gang.half_y + 1.0), high)
        for x in _channel_positions(gang.columns_x, gang.pitch_x)
    ]
    ends = (-gang.channels_x + width / 2, gang.channels_x - width / 2)
    along_x = [box(ends, (y - width / 2, y + width / 2), high) for y in _channel_positions(gang.rows_y, gang.pitch_y)]
    return along_y + along_x


def vent_notches(gang: Gang, cavity: Cavity, fabrication: Fabrication) -> list[Any]:
    """Two shallow notches under the lid from each cavity to the overflow; they reach a little into the cavity.

    A box has them beside two opposite corners, off the middle of its faces; round cavities at x. What is left of the
    side up to the corner, where a split mould parts, is a wall that can be printed.
    """
    half, depth = fabrication.vent_width_mm / 2, fabrication.vent_depth_mm
    to_corner = max(half, printer_profile(fabrication.printer)["supported_wall_mm"])
    aside = max(cavity.size_y / 2 - half - to_corner, 0.0) if cavity.shape == "box" else 0.0
    found = []
    for (x, y), side in product(gang.centers, (-1.0, 1.0)):
        near = x + side * (cavity.size_x / 2 - depth)
        far = x + side * (gang.pitch_x / 2)
        span = (y + side * aside - half, y + side * aside + half)
        high = (cavity.height - depth, cavity.height + depth)
        found.append(box((min(near, far), max(near, far)), span, high))
    return found


def _evenly_spaced(count: int, pitch: float) -> tuple[float, ...]:
    return tuple((number - (count - 1) / 2) * pitch for number in range(count))


def _channel_positions(axes: tuple[float, ...], pitch: float) -> list[float]:
    """Positions of the channels: between the axes and beyond the outer ones."""
    return [axes[0] - pitch / 2, *(axis + pitch / 2 for axis in axes)]


LID_THICKNESS_MM = 3.0
LEAST_OVERFLOW_DEPTH_MM = 0.1
"""Least depth of an overflow channel."""
LID_OVERHANG_MM = 2.0
"""Distance by which the lid stands out along y, to be lifted there."""


@dataclass(frozen=True)
class Mould:
    """The solids of a closed mould by name, and what is trimmed off the cast parts.

    style : "open" (plate, lid) or "split" (floor, bar-1 …, lid).
    vents : one list over all cavities; they overlap the cavities a little.
    """

    component: str
    style: MouldStyle
    cavity: Cavity
    gang: Gang
    solids: dict[str, Any]
    vents: list[Any]


def mould_of(component: str, style: MouldStyle, cavity: Cavity, fabrication: Fabrication) -> Mould:
    """The mould of one component. InputError for bars that are too thin to print."""
    from build123d import Pos

    gang = gang_of(cavity, style, fabrication)
    depth = _overflow_depth(style, cavity, fabrication)
    notches = vent_notches(gang, cavity, fabrication)
    hollow = [Pos(x, y, 0) * cavity.solid for x, y in gang.centers]
    hollow += overflow_channels(gang, cavity.height, depth, fabrication.overflow_mm) + notches
    if style == "open":
        solids = {"plate": _plate_solid(gang, cavity, hollow, fabrication)}
    else:
        solids = {"floor": _floor_solid(gang, cavity, fabrication), **_bar_solids(gang, cavity, hollow, fabrication)}
    solids["lid"] = _lid_solid(gang, style, cavity, fabrication)
    return Mould(component, style, cavity, gang, solids, notches)


def pin_places(gang: Gang, style: MouldStyle, cavity: Cavity) -> list[tuple[float, float]]:
    """Places (x, y) of the pins: one at each end, in a split mould at each end of each bar."""
    if style == "open":
        return [(-gang.pin_x, 0.0), (gang.pin_x, 0.0)]
    middles = [(low + high) / 2 for low, high in bar_spans(gang, cavity)]
    return [(side * gang.pin_x, y) for y in middles for side in (-1, 1)]


def bar_spans(gang: Gang, cavity: Cavity) -> list[tuple[float, float]]:
    """Both ends in y of each bar.

    The mould parts at one face of the boxes, whose seam then runs along two edges, or through the axes of
    the cylinders.
    """
    to_parting = cavity.size_y / 2 if cavity.shape == "box" else 0.0
    cuts = [-gang.half_y, *(y + to_parting for y in gang.rows_y), gang.half_y]
    return list(pairwise(cuts))


def _overflow_depth(style: MouldStyle, cavity: Cavity, fabrication: Fabrication) -> float:
    if style == "open":
        return min(fabrication.overflow_mm, cavity.height + fabrication.mould_wall_mm) / 2
    printer = printer_profile(fabrication.printer)
    refuse_thin(
        f"fabrication.mould_style = 'split': a part of {cavity.height:.3g} mm leaves bars",
        cavity.height - LEAST_OVERFLOW_DEPTH_MM,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "use mould_style = 'open' or 'auto'",
    )
    return min(fabrication.overflow_mm / 2, cavity.height - printer["supported_wall_mm"])


def _plate_solid(gang: Gang, cavity: Cavity, hollow: list[Any], fabrication: Fabrication) -> Any:
    block = _block_solid(gang, (-fabrication.mould_wall_mm, cavity.height))
    return fuse_solids(subtract_solids(block, hollow), _pin_solids(gang, "open", cavity, cavity.height, fabrication))


def _floor_solid(gang: Gang, cavity: Cavity, fabrication: Fabrication) -> Any:
    block = _block_solid(gang, (-fabrication.mould_wall_mm, 0.0))
    return fuse_solids(block, _pin_solids(gang, "split", cavity, 0.0, fabrication))


def _bar_solids(gang: Gang, cavity: Cavity, hollow: list[Any], fabrication: Fabrication) -> dict[str, Any]:
    tall = (0.0, cavity.height)
    holes = _hole_solids(gang, "split", cavity, (-1.0, cavity.height + 1.0), fabrication)
    return {
        f"bar-{number}": subtract_solids(box((-gang.half_x, gang.half_x), span, tall), hollow + holes)
        for number, span in enumerate(bar_spans(gang, cavity), 1)
    }


def _lid_solid(gang: Gang, style: MouldStyle, cavity: Cavity, fabrication: Fabrication) -> Any:
    tall = (cavity.height, cavity.height + LID_THICKNESS_MM)
    out = gang.half_y + LID_OVERHANG_MM
    block = box((-gang.half_x, gang.half_x), (-out, out), tall)
    return subtract_solids(block, _hole_solids(gang, style, cavity, (tall[0] - 1.0, tall[1] + 1.0), fabrication))


def _block_solid(gang: Gang, tall: tuple[float, float]) -> Any:
    return box((-gang.half_x, gang.half_x), (-gang.half_y, gang.half_y), tall)


def _pin_solids(gang: Gang, style: MouldStyle, cavity: Cavity, foot: float, fabrication: Fabrication) -> list[Any]:
    """Pins that end within the lid, so that a flat weight can lie on it."""
    tip = cavity.height + LID_THICKNESS_MM - 0.5
    return [pin(x, y, (foot, tip), fabrication.pin_diameter_mm) for x, y in pin_places(gang, style, cavity)]


def _hole_solids(
    gang: Gang, style: MouldStyle, cavity: Cavity, tall: tuple[float, float], fabrication: Fabrication
) -> list[Any]:
    diameter = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    return [post(x, y, tall, diameter) for x, y in pin_places(gang, style, cavity)]
