"""The kernel of an array: charge of every segment and force of one dot at any place and depth, and of many at once.

A table of single presses. Where several dots press at once each finds a surface that the others have already pushed
down, and up beside them: its depth counts from there,
    d_k = D_k - sum over m != k of s(x_m, d_m; x_k),
with the sinking s of the surface at x_k when a dot alone is d_m deep at x_m. Charges and forces at these depths are
summed. What this misses is the stretch of the film, which is quadratic in what the dots do.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from foundation.table_checksum import table_checksum

FORMAT = "softdot-kernel/1"
NPZ, JSON = "kernel.npz", "kernel.json"
CHECKSUM = "checksum_sha256"
AGAIN = "make it again by softdot array --kernel"
TABLES = ("x_mm", "y_mm", "depth_mm", "charge_pC", "force_N", "place_x_mm", "place_y_mm", "load_mm", "sinking_mm")
SINKING_ROUNDS = 3
"""Of the depths of dots that press at once; each is about fifty times nearer than the one before."""
DEPTH_ROUND_OFF_MM = 1e-9


@dataclass(frozen=True)
class ArrayKernel:
    """Charge and force of a dot over an array, as tables. Places are of the dot's tip in the frame of the array, whose
    middle is the origin; depths below its resting top.

    x_mm (a,), y_mm (b,), depth_mm (c,) : axes of charge_pC (a, b, c, n) and force_N (a, b, c), depth from 0.
    place_x_mm (p,), place_y_mm (q,), load_mm (r,) : axes of sinking_mm (p, q, r, p, q), of the surface at the last two
    places when a dot presses at the first two. about : what kernel.json says, errors and design among it.
    """

    x_mm: Floats
    y_mm: Floats
    depth_mm: Floats
    charge_pC: Floats
    force_N: Floats
    place_x_mm: Floats
    place_y_mm: Floats
    load_mm: Floats
    sinking_mm: Floats
    about: dict[str, Any]

    @property
    def centres_mm(self) -> Floats:
        """Middles (n, 2) of the segments."""
        return np.asarray(self.about["centres_mm"], dtype=np.float64)

    @property
    def capacitance_pF(self) -> Floats:
        """Capacitance (n,) of each segment's electrode."""
        return np.asarray(self.about["capacitance_pF"], dtype=np.float64)

    def touches(self, x_mm: Floats, y_mm: Floats, depth_mm: Floats) -> Bools:
        """Whether dots at these places and depths, any one shape, lie in the table and below the resting top."""
        inside = (x_mm >= self.x_mm[0]) & (x_mm <= self.x_mm[-1]) & (y_mm >= self.y_mm[0]) & (y_mm <= self.y_mm[-1])
        return np.asarray(inside & (depth_mm > 0.0))

    def of_one(self, x_mm: Floats, y_mm: Floats, depth_mm: Floats) -> tuple[Floats, Floats]:
        """Charge (..., n) in pC and force (...) in N of a dot alone, by linear interpolation; 0 where none touches.

        InputError for a depth beyond the table.
        """
        touching = self.touches(x_mm, y_mm, depth_mm)
        charge = np.zeros((*touching.shape, self.charge_pC.shape[-1]))
        force = np.zeros(touching.shape)
        if touching.any():
            at = self._points_in_table(x_mm[touching], y_mm[touching], depth_mm[touching])
            axes = (self.x_mm, self.y_mm, self.depth_mm)
            charge[touching] = interpolate(axes, self.charge_pC, at)
            force[touching] = interpolate(axes, self.force_N, at)
        return charge, force

    def of_many(self, x_mm: Floats, y_mm: Floats, depth_mm: Floats) -> tuple[Floats, Floats]:
        """Charge (t, n) in pC and force (t,) in N of up to k dots that press at once; x_mm, y_mm, depth_mm : (t, k).

        NaN stands for no dot. InputError for a depth beyond the table.
        """
        given = np.where(self.touches(x_mm, y_mm, depth_mm), depth_mm, 0.0)
        depth = given
        for _ in range(SINKING_ROUNDS if given.shape[1] > 1 else 0):
            depth = np.where(
                given > 0.0, np.clip(given - self._sinking_mm(x_mm, y_mm, depth), 0.0, self.depth_mm[-1]), 0.0
            )
        charge, force = self.of_one(x_mm, y_mm, depth)
        self._points_in_table(x_mm[given > 0.0], y_mm[given > 0.0], given[given > 0.0])
        return charge.sum(axis=1), force.sum(axis=1)

    def _sinking_mm(self, x_mm: Floats, y_mm: Floats, depth_mm: Floats) -> Floats:
        """Depth (t, k) in mm to which the others have pushed the surface down at each dot."""
        found = np.zeros(depth_mm.shape)
        sample, first, second = _pairs(depth_mm > 0.0)
        axes = (self.place_x_mm, self.place_y_mm, self.load_mm, self.place_x_mm, self.place_y_mm)
        at = [
            x_mm[sample, second], y_mm[sample, second], depth_mm[sample, second],
            x_mm[sample, first], y_mm[sample, first],
        ]  # fmt: skip
        np.add.at(found, (sample, first), interpolate(axes, self.sinking_mm, at))
        return found

    def _points_in_table(self, x_mm: Floats, y_mm: Floats, depth_mm: Floats) -> list[Floats]:
        """Coordinates of dots as the table is read at them. InputError for a depth beyond it."""
        deepest = float(np.max(depth_mm, initial=0.0))
        if deepest > self.depth_mm[-1] + DEPTH_ROUND_OFF_MM:
            raise InputError(f"a dot is {deepest:.4g} mm deep: the kernel ends at {self.depth_mm[-1]:.4g} mm")
        return [x_mm, y_mm, depth_mm]

    def save(self, folder: Path) -> None:
        """Write kernel.npz and kernel.json."""
        tables = {name: getattr(self, name).astype(np.float32) for name in TABLES}
        with (folder / NPZ).open("wb") as file:
            np.savez_compressed(file, **tables)
        about = {"format": FORMAT, **self.about}
        text = json.dumps({CHECKSUM: table_checksum(tables, about), **about}, indent=1)
        (folder / JSON).write_text(text, encoding="utf-8")


def load_kernel(folder: Path) -> ArrayKernel:
    """Load the kernel in a folder of softdot array. InputError for one that holds no kernel, or one that was
    changed.
    """
    where = f"kernel '{folder}'"
    try:
        about = json.loads((folder / JSON).read_text("utf-8"))
        with np.load(folder / NPZ, allow_pickle=False) as file:
            tables = {name: np.asarray(file[name]) for name in TABLES}
    except FileNotFoundError as error:
        raise InputError(f"{where}: {error.filename} is missing; softdot array --kernel writes it") from None
    except Exception as error:  # the readers raise what a damaged file happens to lead to
        raise InputError(f"{where}: cannot be read ({error})") from None
    if not isinstance(about, dict) or about.get("format") != FORMAT:
        told = about.get("format") if isinstance(about, dict) else about
        raise InputError(f"{where}: format = {str(told)[:40]!r}: must be '{FORMAT}'")
    told = about.pop(CHECKSUM, None)
    if told is None:
        raise InputError(f"{where}: has no {CHECKSUM}, as kernels of earlier versions; {AGAIN}")
    if told != table_checksum(tables, about):
        raise InputError(f"{where}: {CHECKSUM} is not that of {JSON} and {NPZ}, one of which was changed; {AGAIN}")
    return ArrayKernel(**{name: table.astype(np.float64) for name, table in tables.items()}, about=about)


def interpolate(axes: tuple[Floats, ...], table: Floats, at: list[Floats]) -> Floats:
    """Multilinear interpolation in the leading axes of a table, (m, ...) at m points; constant beyond the ends."""
    low, share = zip(*(_bracket(axis, place) for axis, place in zip(axes, at, strict=True)), strict=True)
    sizes, extra = table.shape[: len(axes)], table.shape[len(axes) :]
    rows = np.ascontiguousarray(table.reshape(int(np.prod(sizes)), -1), dtype=np.float64)
    apart = np.cumprod((1, *sizes[:0:-1]))[::-1]
    result = np.zeros((len(at[0]), rows.shape[1]))
    add_corners(rows, np.array(low), np.array(share), np.ascontiguousarray(apart), result)
    return result.reshape(-1, *extra)


@nb.njit(cache=True)
def add_corners(rows, low, share, apart, result):  # type: ignore[no-untyped-def]
    """Add to result (m, e) the corners of the box around each point, weighed by its shares (k, m) of the way.

    rows (n, e) : the table, whose nodes along axis a are apart[a] rows apart; low (k, m) : numbers of the nodes below.
    """
    for point in range(low.shape[1]):
        for corner in range(1 << low.shape[0]):
            weight, row = 1.0, 0
            for axis in range(low.shape[0]):
                up = corner >> axis & 1
                weight *= share[axis, point] if up else 1.0 - share[axis, point]
                row += (low[axis, point] + up) * apart[axis]
            if weight != 0.0:
                for column in range(rows.shape[1]):
                    result[point, column] += weight * rows[row, column]


def _bracket(axis: Floats, place: Floats) -> tuple[Ints, Floats]:
    """Number of the node below and the share of the way to the next one."""
    number = np.clip(np.searchsorted(axis, place, side="right") - 1, 0, len(axis) - 2)
    share = (place - axis[number]) / (axis[number + 1] - axis[number])
    return number, np.clip(share, 0.0, 1.0)


def _pairs(touching: Bools) -> tuple[Ints, Ints, Ints]:
    """Sample, dot and other dot of all ordered pairs of different dots that touch at once; touching : (t, k)."""
    both = touching[:, :, None] & touching[:, None, :] & ~np.eye(touching.shape[1], dtype=bool)
    sample, first, second = np.nonzero(both)
    return sample, first, second
