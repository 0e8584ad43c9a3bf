"""The printed parts of one mould. Lengths in millimetres; floor of the cavities at z = 0."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from geometry.fabrication.cavity import Cavity
from geometry.fabrication.gang import Gang, gang_of, overflow, vents
from geometry.fabrication.limits import refuse_thin
from geometry.fabrication.mould_checks import Style
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.shapes import box, joined, pin, post, without
from geometry.printers import printer_profile

LID_MM = 3.0
SHALLOWEST_MM = 0.1
"""Of an overflow channel."""
OVERHANG_MM = 2.0
"""By which the lid stands out along y, to be lifted there."""


@dataclass(frozen=True)
class Mould:
    """The solids of a closed mould by name, and what is trimmed off the cast parts.

    style : "open" (plate, lid) or "split" (floor, bar-1 …, lid).
    vents : one list over all cavities; they overlap the cavities a little.
    """

    component: str
    style: Style
    cavity: Cavity
    gang: Gang
    solids: dict[str, Any]
    vents: list[Any]


def mould_of(component: str, style: Style, cavity: Cavity, fabrication: Fabrication) -> Mould:
    """The mould of one component. InputError for bars that are too thin to print."""
    from build123d import Pos

    gang = gang_of(cavity, style, fabrication)
    depth = _overflow_depth(style, cavity, fabrication)
    notches = vents(gang, cavity, fabrication)
    hollow = [Pos(x, y, 0) * cavity.solid for x, y in gang.centers]
    hollow += overflow(gang, cavity.height, depth, fabrication.overflow_mm) + notches
    if style == "open":
        solids = {"plate": _plate(gang, cavity, hollow, fabrication)}
    else:
        solids = {"floor": _floor(gang, cavity, fabrication), **_bars(gang, cavity, hollow, fabrication)}
    solids["lid"] = _lid(gang, style, cavity, fabrication)
    return Mould(component, style, cavity, gang, solids, notches)


def pin_places(gang: Gang, style: Style, cavity: Cavity) -> list[tuple[float, float]]:
    """x and y of the pins: one at each end, in a split mould at each end of each bar."""
    if style == "open":
        return [(-gang.pin_x, 0.0), (gang.pin_x, 0.0)]
    middles = [(low + high) / 2 for low, high in bar_spans(gang, cavity)]
    return [(side * gang.pin_x, y) for y in middles for side in (-1, 1)]


def bar_spans(gang: Gang, cavity: Cavity) -> list[tuple[float, float]]:
    """y of both faces of each bar.

    The mould parts at one face of the boxes, whose seam then runs along two edges, or through the axes of
    the cylinders.
    """
    to_parting = cavity.size_y / 2 if cavity.shape == "box" else 0.0
    cuts = [-gang.half_y, *(y + to_parting for y in gang.rows_y), gang.half_y]
    return list(pairwise(cuts))


def _overflow_depth(style: Style, cavity: Cavity, fabrication: Fabrication) -> float:
    if style == "open":
        return min(fabrication.overflow_mm, cavity.height + fabrication.mould_wall_mm) / 2
    printer = printer_profile(fabrication.printer)
    refuse_thin(
        f"fabrication.mould_style = 'split': a part of {cavity.height:.3g} mm leaves bars",
        cavity.height - SHALLOWEST_MM,
        printer["supported_wall_mm"],
        f"the {printer.process.upper()} limit for the supported wall",
        "use mould_style = 'open' or 'auto'",
    )
    return min(fabrication.overflow_mm / 2, cavity.height - printer["supported_wall_mm"])


def _plate(gang: Gang, cavity: Cavity, hollow: list[Any], fabrication: Fabrication) -> Any:
    block = _block(gang, (-fabrication.mould_wall_mm, cavity.height))
    return joined(without(block, hollow), _pins(gang, "open", cavity, cavity.height, fabrication))


def _floor(gang: Gang, cavity: Cavity, fabrication: Fabrication) -> Any:
    block = _block(gang, (-fabrication.mould_wall_mm, 0.0))
    return joined(block, _pins(gang, "split", cavity, 0.0, fabrication))


def _bars(gang: Gang, cavity: Cavity, hollow: list[Any], fabrication: Fabrication) -> dict[str, Any]:
    tall = (0.0, cavity.height)
    holes = _holes(gang, "split", cavity, (-1.0, cavity.height + 1.0), fabrication)
    return {
        f"bar-{number}": without(box((-gang.half_x, gang.half_x), span, tall), hollow + holes)
        for number, span in enumerate(bar_spans(gang, cavity), 1)
    }


def _lid(gang: Gang, style: Style, cavity: Cavity, fabrication: Fabrication) -> Any:
    tall = (cavity.height, cavity.height + LID_MM)
    out = gang.half_y + OVERHANG_MM
    block = box((-gang.half_x, gang.half_x), (-out, out), tall)
    return without(block, _holes(gang, style, cavity, (tall[0] - 1.0, tall[1] + 1.0), fabrication))


def _block(gang: Gang, tall: tuple[float, float]) -> Any:
    return box((-gang.half_x, gang.half_x), (-gang.half_y, gang.half_y), tall)


def _pins(gang: Gang, style: Style, cavity: Cavity, foot: float, fabrication: Fabrication) -> list[Any]:
    """Pins that end within the lid, so that a flat weight can lie on it."""
    tip = cavity.height + LID_MM - 0.5
    return [pin(x, y, (foot, tip), fabrication.pin_diameter_mm) for x, y in pin_places(gang, style, cavity)]


def _holes(gang: Gang, style: Style, cavity: Cavity, tall: tuple[float, float], fabrication: Fabrication) -> list[Any]:
    diameter = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    return [post(x, y, tall, diameter) for x, y in pin_places(gang, style, cavity)]
