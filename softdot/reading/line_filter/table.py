"""The charges that the kernel gives for every place of the array over two columns of dots, as a table.

Within half a cell pitch of the array's middle lie two columns of dots, of 64 possible patterns. Charges of single dots
are exact for every turn of the array; what dots add to the sum of single ones is that of the array that is not turned.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, radians, sin

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from geometry.braille_standards import BrailleStandard
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.cells import DOTS, KINDS_OF_CELL
from softdot.reading.conditions import DEFAULT_SHARE_OF_DEPTH
from softdot.reading.line import cell_pitch_mm, dot_places_mm

PLACES, COARSER = 120, 3
"""Places of the array within a cell pitch, and of how many one is pressed with several dots at once."""
OFFSETS_MM = np.round(np.arange(-2.8, 2.81, 0.2), 3)
"""Distances of the array's middle from the middle row, to where its rows see the next rows of dots."""
YAWS_DEG = np.arange(-20.0, 20.1, 5.0)
"""Turns of the array against the line."""
ROWS = DOTS // 2
FAINT_SHARE = 0.15
"""Of the largest charge of one dot, below which a dot is not told from what is not known of the sensor."""
WIDER = 0.05
"""Share by which the kernel is widened and narrowed to see what that changes."""
HIGH = 0.98
"""Quantile of charges that stands for a large one."""


@dataclass(frozen=True)
class LineTable:
    """Charges of two columns of dots under an array that moves towards rising place.

    lone (yaw, place, offset, 6, n) in pC : of single dots, on the channels in use, numbered by channels (n,). Dots 0
    to 2 are the column behind, 3 to 5 the next one. wider : by how much these change where the sensor is wider than its
    kernel, over the share by which it is. beside (place, offset, 64, n) : what the dots of a pattern add to
    the sum of single ones; its bits are the dots. within (place,) : whether the column behind is the second one
    of its cell. is_mirrored : the array moves from right to left, and a cell's right column comes first. largest_pC :
    largest charge of a channel by one dot. high_pC (n,) : what one of fifty places and patterns exceeds.
    slope_pC_per_mm : root mean square of the change of charge along the line; spread_pC : of the charge about its mean.
    """

    lone: Floats
    wider: Floats
    beside: Floats
    channels: Ints
    within: Bools
    dot_pitch_mm: float
    cell_pitch_mm: float
    is_mirrored: bool
    largest_pC: float
    slope_pC_per_mm: float
    spread_pC: float
    high_pC: Floats

    @property
    def reach_mm(self) -> float:
        """Distance of the array's middle from the middle row up to which each row of dots is felt by some segment."""
        return self.felt_mm(FAINT_SHARE)

    def felt_mm(self, share: float) -> float:
        """The same where a row is felt by a share of the largest charge of one dot."""
        middle = len(OFFSETS_MM) // 2
        largest = np.abs(self.lone[len(YAWS_DEG) // 2, :, :, :ROWS]).max(axis=(0, 3)).min(axis=1)
        felt = largest >= share * self.largest_pC
        right = int(np.argmin(np.append(felt[middle:], False)))
        left = int(np.argmin(np.append(felt[middle::-1], False)))
        return max(min(left, right) - 1, 0) * float(OFFSETS_MM[1] - OFFSETS_MM[0])

    @property
    def step_mm(self) -> float:
        """Way from place to place."""
        return self.cell_pitch_mm / PLACES


class _Key:
    """A kernel, itself alone, and a standard as a key of a cache."""

    def __init__(self, kernel: ArrayKernel, chosen: BrailleStandard) -> None:
        self.kernel, self.chosen = kernel, chosen

    def __hash__(self) -> int:
        return hash((id(self.kernel), self.chosen.name))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and other.kernel is self.kernel and other.chosen == self.chosen


def line_table(kernel: ArrayKernel, chosen: BrailleStandard, is_mirrored: bool) -> LineTable:
    """The table of a kernel for a standard, in the direction of reading or mirrored; kept for the next call."""
    return _kept_table(_Key(kernel, chosen), is_mirrored)


@lru_cache(maxsize=4)
def _kept_table(key: _Key, is_mirrored: bool) -> LineTable:
    kernel, chosen = key.kernel, key.chosen
    dots, pitch = dot_places_mm(chosen), cell_pitch_mm(chosen)
    spacing = float(np.ptp(dots[:, 0]))
    behind = -pitch / 2.0  # place of the window's rear end from the array's middle
    rest = pitch / PLACES * (np.arange(PLACES) + 0.5)  # from the first column of the rear cell to that end
    within = rest <= spacing
    first = behind + np.where(within, spacing - rest, pitch - rest)
    second = first + np.where(within, pitch - spacing, spacing)
    along = np.repeat(np.stack([first, second], axis=1), ROWS, axis=1)  # (place, 6)
    across = np.tile(np.unique(np.round(dots[:, 1], 9)), 2)
    channels = _channels_in_use(kernel, spacing)
    sign = -1.0 if is_mirrored else 1.0
    lone = _lone_charges(kernel, sign * along, across, channels)
    wide, narrow = (_lone_charges(kernel, sign * along, across, channels, 1.0 + way) for way in (WIDER, -WIDER))
    bits = ((np.arange(KINDS_OF_CELL)[:, None] >> np.arange(DOTS)) & 1).astype(np.float64)
    beside = _beside(kernel, sign * along, across, bits, channels, lone)
    middle = len(OFFSETS_MM) // 2
    charge = bits @ lone[len(YAWS_DEG) // 2, :, middle] + beside[:, middle]
    return _with_sizes(
        (lone, (wide - narrow) / (2.0 * WIDER), beside, charge), channels, within, spacing, pitch, is_mirrored
    )


def _with_sizes(
    charges: tuple[Floats, Floats, Floats, Floats], channels: Ints, within: Bools, spacing: float, pitch: float,
    is_mirrored: bool,
) -> LineTable:  # fmt: skip
    """The table with the sizes of its charges, in the middle of the line and not turned."""
    lone, wider, beside, middle = charges
    change = np.diff(middle, axis=0)[within[1:] == within[:-1]] / (pitch / PLACES)
    single = middle[:, [1 << dot for dot in range(DOTS)]]
    return LineTable(
        np.ascontiguousarray(lone, dtype=np.float32), np.ascontiguousarray(wider, dtype=np.float32),
        np.ascontiguousarray(beside, dtype=np.float32), channels, within, spacing, pitch, is_mirrored,
        float(np.abs(single).max()),
        float(np.sqrt(np.mean(change**2))), float(np.sqrt(np.mean((middle - middle.mean(axis=(0, 1))) ** 2))),
        _high_charge(middle.reshape(-1, len(channels))),
    )  # fmt: skip


def _high_charge(charge: Floats) -> Floats:
    """What one of fifty charges (m, n) of each channel exceeds, on the side of their larger ones."""
    low, high = np.quantile(charge, [1.0 - HIGH, HIGH], axis=0)
    return np.asarray(np.where(high + low >= 0.0, high, low))


def _channels_in_use(kernel: ArrayKernel, spacing: float) -> Ints:
    """Segments within a dot pitch of the array's middle: farther ones see columns that are not in the table."""
    return np.flatnonzero(np.abs(kernel.centres_mm[:, 0]) < spacing)


def _places_in_array(along: Floats, across: Floats, yaw_deg: float) -> tuple[Floats, Floats]:
    """Places x, y (place, offset, 6) in the frame of the array."""
    angle = radians(yaw_deg)
    far, wide = along[:, None, :], across[None, None, :] - OFFSETS_MM[None, :, None]
    return cos(angle) * far + sin(angle) * wide, cos(angle) * wide - sin(angle) * far


def _lone_charges(kernel: ArrayKernel, along: Floats, across: Floats, channels: Ints, width: float = 1.0) -> Floats:
    """Charges (yaw, place, offset, 6, n) of single dots, of a sensor whose response is wider than its kernel's."""
    depth = DEFAULT_SHARE_OF_DEPTH * float(kernel.depth_mm[-1])
    found = []
    for yaw in YAWS_DEG:
        x, y = (one / width for one in _places_in_array(along, across, float(yaw)))
        found.append(kernel.of_one(x, y, np.full(x.shape, depth))[0][..., channels])
    return np.stack(found)


def _beside(kernel: ArrayKernel, along: Floats, across: Floats, bits: Floats, channels: Ints, lone: Floats) -> Floats:
    """What dots beside each other add to the sum of single ones (place, offset, 64, n), not turned.

    It changes slowly: every third place and every other offset is looked up, the rest taken from the nearest one on
    the same side of a column's entry, and from between.
    """
    depth = DEFAULT_SHARE_OF_DEPTH * float(kernel.depth_mm[-1])
    rows, columns = np.arange(1, PLACES, COARSER), np.arange(0, len(OFFSETS_MM), 2)
    x, y = _places_in_array(along[rows], across, 0.0)
    x, y = (np.repeat(one[:, columns, None, :], KINDS_OF_CELL, axis=2).reshape(-1, DOTS) for one in (x, y))
    there = np.tile(bits.astype(bool), (len(rows) * len(columns), 1))
    x, y = np.where(there, x, np.nan), np.where(there, y, np.nan)
    whole = kernel.of_many(x, y, np.where(there, depth, np.nan))[0][:, channels]
    single = np.einsum("kd,podn->pokn", bits, lone[len(YAWS_DEG) // 2][np.ix_(rows, columns)])
    more = whole.reshape(single.shape) - single
    more = more[[int(np.argmin(np.abs(along[rows] - one).sum(axis=1))) for one in along]]
    filled = np.empty((PLACES, len(OFFSETS_MM), *more.shape[2:]))
    filled[:, columns] = more
    filled[:, columns[:-1] + 1] = 0.5 * (more[:, :-1] + more[:, 1:])
    return filled


def column_mm(table: LineTable, number: int) -> float:
    """Place of a column of dots by its number; the first one of the first cell is at 0."""
    return number // 2 * table.cell_pitch_mm + number % 2 * table.dot_pitch_mm
