"""Where the cavities, overflow channels, vents and pins of one mould lie. Lengths in millimetres."""

from dataclasses import dataclass
from itertools import product
from typing import Any

from geometry.fabrication.cavity import Cavity
from geometry.fabrication.mould_checks import Style
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.shapes import box
from geometry.printers import printer_profile

PIN_MARGIN_MM = 1.5
"""Of material around the hole of a pin."""


@dataclass(frozen=True)
class Gang:
    """columns_x, rows_y : the axes of the cavities.

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
        """x and y of each cavity."""
        return list(product(self.columns_x, self.rows_y))


def gang_of(cavity: Cavity, style: Style, fabrication: Fabrication) -> Gang:
    """The layout of fabrication.cavities cavities: each has a land around it, then an overflow channel."""
    around = 2 * fabrication.land_mm + fabrication.overflow_mm
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    lug = hole + 2 * PIN_MARGIN_MM
    pitch_x = cavity.size_x + around
    # each bar of a split mould carries pins
    narrowest = lug if style == "split" else 0.0
    pitch_y = max(cavity.size_y + around, narrowest)
    columns, rows = fabrication.cavities
    channels_x = (columns * pitch_x + fabrication.overflow_mm) / 2
    channels_y = (rows * pitch_y + fabrication.overflow_mm) / 2
    return Gang(
        columns_x=_spread(columns, pitch_x),
        rows_y=_spread(rows, pitch_y),
        pitch_x=pitch_x,
        pitch_y=pitch_y,
        half_x=channels_x + max(fabrication.mould_wall_mm, lug),
        half_y=channels_y + max(fabrication.mould_wall_mm, narrowest),
        channels_x=channels_x,
        pin_x=channels_x + max(fabrication.mould_wall_mm, lug) / 2,
    )


def overflow(gang: Gang, top: float, depth: float, width: float) -> list[Any]:
    """Channels around every cavity; those along y run out at the edges of the mould."""
    high = (top - depth, top + depth)
    along_y = [
        box((x - width / 2, x + width / 2), (-gang.half_y - 1.0, gang.half_y + 1.0), high)
        for x in _between(gang.columns_x, gang.pitch_x)
    ]
    ends = (-gang.channels_x + width / 2, gang.channels_x - width / 2)
    along_x = [box(ends, (y - width / 2, y + width / 2), high) for y in _between(gang.rows_y, gang.pitch_y)]
    return along_y + along_x


def vents(gang: Gang, cavity: Cavity, fabrication: Fabrication) -> list[Any]:
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


def _spread(count: int, pitch: float) -> tuple[float, ...]:
    return tuple((number - (count - 1) / 2) * pitch for number in range(count))


def _between(axes: tuple[float, ...], pitch: float) -> list[float]:
    """Between the axes and beyond the outer ones."""
    return [axes[0] - pitch / 2, *(axis + pitch / 2 for axis in axes)]
