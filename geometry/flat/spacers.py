"""Strips that keep the islands of an array apart while they are bonded: half-lapped, as in an egg crate. In mm."""

from itertools import pairwise

from foundation.errors import InputError
from geometry.fabrication.device import Device
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.pattern import Dimension, FlatPattern, Outline
from geometry.part_checks import covers_footprint
from geometry.polygons import Point
from geometry.stack import layers

STRIP_GRIP_MM = 4.0
"""Height of a strip above the islands, to draw it out."""


def spaced_layers(device: Device) -> list[str]:
    """Names of the layers of islands that spacers keep apart, from the base up.

    Not among them are narrow effectors, which a locator places, and islands within the windows of a grid.
    """
    narrow = set() if covers_footprint(device.segment) else {"effector"}
    names = [layer.name for layer in layers(device.segment)]
    return [name for name in names if device.piece_count(name) > 1 and not device.in_grid(name) and name not in narrow]


def spacer_patterns(device: Device, fabrication: Fabrication) -> list[FlatPattern]:
    """A pattern for each direction and each width of gap, in the axes of the device; none without such islands.

    Strips along y stand between columns and have notches from below, those along x between rows from above.
    InputError for a gap whose notches are too near to each other.
    """
    spaced = spaced_layers(device)
    if not spaced:
        return []
    tall = STRIP_GRIP_MM + max(layer.thickness_mm for layer in layers(device.segment) if layer.name in spaced)
    found = []
    for axis in (0, 1):
        gaps = _gaps(device, axis)
        for number, gap in enumerate(sorted({gap for _, gap in gaps})):
            count = sum(one == gap for _, one in gaps)
            name = f"spacer-{'yx'[axis]}" + (f"-{number + 1}" if number else "")
            found.append(_strip_pattern(name, gap, count, axis, tall, device, fabrication))
    return found


def _gaps(device: Device, axis: int) -> list[tuple[float, float]]:
    """Middle and width in mm of each gap between neighbouring columns (axis 0) or rows (axis 1)."""
    edges = device.layout.edges(axis)
    return [((a[1] + b[0]) / 2, round(b[0] - a[1], 9)) for a, b in pairwise(edges)]


def _strip_pattern(
    name: str, thick: float, count: int, axis: int, tall: float, device: Device, fabrication: Fabrication
) -> FlatPattern:
    half = device.layout.half_mm[1 - axis]
    notches = _gaps(device, 1 - axis)
    low = axis == 0
    points: list[Point] = [(-half, 0.0), (half, 0.0), (half, tall), (-half, tall)]
    cut = [
        (middle + side * width / 2, level)
        for middle, width in notches
        for side, level in ((-1, 0.0), (-1, tall / 2), (1, tall / 2), (1, 0.0))
    ]
    if any(width < 2 * fabrication.kerf_mm - ROUNDING_MM for _, width in notches):
        raise InputError(
            f"fabrication.kerf_mm = {fabrication.kerf_mm:g}: the notches of the spacers for gaps of "
            f"{min(width for _, width in notches):.3g} mm are narrower than two cuts; use a finer cutter"
        )
    if low:
        points[1:1] = cut
    else:
        points[3:3] = [(u, tall - v) for u, v in reversed(cut)]
    return FlatPattern(
        name=name,
        title=f"Spacer along {'yx'[axis]}, between {'columns' if axis == 0 else 'rows'}",
        material="polyester film or steel shim",
        thickness_mm=thick,
        count=count,
        instruction=f"Stands in the gaps of {thick:.3g} mm between islands while they are bonded; the strips of both "
        "directions are put together at their notches.",
        cuts=(Outline("CUT", tuple(points)),),
        dimensions=(
            Dimension((-half, tall), (half, tall), "x", 1.2),
            Dimension((-half, 0.0), (-half, tall), "y", -1.2),
        ),
        kerf_mm=fabrication.kerf_mm,
    )
