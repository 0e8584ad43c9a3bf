"""How the electrodes of an array are led out of it without a crossing: escape routing in the plane.

Seen from the cable the electrodes stand in files (along u, towards the cable) of several ranks (rank 0 farthest away).
Between the files, and beside the outer ones, run channels towards the cable. The front electrode of each file leaves
straight ahead; the others leave sideways into a channel, where the trace of a farther electrode always lies farther
from its file. A farthest electrode that finds no room there leaves backwards and goes around all others. Millimetres.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import floor, inf
from typing import Literal

from foundation.errors import InputError
from geometry.array.layout import Rectangle
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.pattern import Point

Side = Literal["ahead", "beside", "behind"]


@dataclass(frozen=True)
class WayOut:
    """side : of the electrode at which its trace leaves. channel : below file `channel`, above file `channel - 1`."""

    side: Side
    channel: int


@dataclass(frozen=True)
class Lattice:
    """electrodes : name -> u0, u1, v0, v1 on a lattice of files and ranks. width, gap : of traces and beside them.

    margin : bare film between the edges of segment and electrode.
    """

    electrodes: dict[str, Rectangle]
    width: float
    gap: float
    margin: float

    @cached_property
    def places(self) -> dict[tuple[int, int], str]:
        """Name of the electrode of each rank and file, both rising with u and v."""
        middles = {name: ((u0 + u1) / 2, (v0 + v1) / 2) for name, (u0, u1, v0, v1) in self.electrodes.items()}
        us, vs = ([*_distinct(middle[k] for middle in middles.values())] for k in (0, 1))
        return {(_index(us, u), _index(vs, v)): name for name, (u, v) in middles.items()}

    @property
    def ranks(self) -> int:
        """Electrodes of each file."""
        return 1 + max(rank for rank, _ in self.places)

    @property
    def files(self) -> int:
        """Lines of electrodes along u."""
        return 1 + max(file for _, file in self.places)

    def at(self, rank: int, file: int) -> Rectangle:
        """The electrode there."""
        return self.electrodes[self.places[rank, file]]

    @property
    def apart(self) -> float:
        """From the middle of one trace to that of the next."""
        return self.width + self.gap

    @property
    def gaps(self) -> list[float]:
        """Between neighbouring files."""
        return [self.at(0, file + 1)[2] - self.at(0, file)[3] for file in range(self.files - 1)]

    @property
    def room(self) -> list[float]:
        """How many traces fit into each channel, as many gaps as traces and one more."""
        inner = [floor(max(gap - self.gap, 0.0) / self.apart + ROUNDING_MM) for gap in self.gaps]
        return [inf, *inner, inf]

    @cached_property
    def ways(self) -> dict[tuple[int, int], WayOut]:
        """How each electrode leaves. InputError where a channel is full."""
        found = _ways(self.ranks, self.files, self.room)
        if found is None:
            self._refuse()
        assert found is not None
        return found

    def _refuse(self) -> None:
        counts = range(1, self.ranks + 1)
        most = next(n for n in counts if _ways(self.ranks, self.files, [inf, *[n] * (self.files - 1), inf]))
        narrowest, needed = min(self.gaps), most * self.width + (most + 1) * self.gap
        least = self.margin + (needed - narrowest) / 2
        _, _, v0, v1 = self.at(0, 0)
        fits = 2 * least < v1 - v0 + 2 * self.margin
        margin = f"must be at least {least:.3g}, or" if fits else "no margin is enough, so"
        raise InputError(
            f"array.electrode_margin_mm = {self.margin:g}: the traces of inner electrodes cannot be led out, as a gap "
            f"of {narrowest:.3g} mm between electrodes takes {min(self.room[1:-1]):g} traces of {self.width:g} mm with "
            f"{self.gap:g} mm beside each, and {most} must pass; {margin} give smaller "
            "fabrication.trace_width_mm and trace_gap_mm, or another cable_exit"
        )

    def lanes(self, channel: int) -> dict[tuple[int, int], float]:
        """v of each trace in a channel: nearest to its file that of the electrode nearest to the cable."""
        below = self._in(channel, channel - 1, "beside")
        above = self._in(channel, channel, "beside")
        around = [one for one, way in self.ways.items() if way == WayOut("behind", channel)]
        found: dict[tuple[int, int], float] = {}
        if channel > 0:
            below += sorted(around, key=lambda one: -one[1])
            edge = self.at(0, channel - 1)[3]
            found |= {one: edge + self._middle(number) for number, one in enumerate(below)}
        if channel < self.files:
            above += [] if channel > 0 else sorted(around, key=lambda one: one[1])
            edge = self.at(0, channel)[2]
            found |= {one: edge - self._middle(number) for number, one in enumerate(above)}
        return found

    def _in(self, channel: int, file: int, side: Side) -> list[tuple[int, int]]:
        """Those of a file in a channel, the nearest to the cable first."""
        way = WayOut(side, channel)
        return sorted((one for one, other in self.ways.items() if one[1] == file and other == way), reverse=True)

    def _middle(self, number: int) -> float:
        """Of a trace beside metal, from its edge."""
        return self.gap + self.width / 2 + number * self.apart

    @cached_property
    def lines(self) -> dict[str, tuple[Point, ...]]:
        """Name -> centre line of its trace from its electrode to the front of the array, where all look ahead."""
        lanes = {one: v for channel in range(self.files + 1) for one, v in self.lanes(channel).items()}
        found = {}
        for (rank, file), way in self.ways.items():
            u0, u1, v0, v1 = self.at(rank, file)
            if way.side == "ahead":
                # beside the trace of the common electrode, which leaves at the lower corner
                clear = min(v0 + self.width + self._middle(0), v1 - self.width / 2)
                points: list[Point] = [(u1, max((v0 + v1) / 2, clear))]
            elif way.side == "beside":
                u = u1 - self.width / 2
                points = [(u, v1 if way.channel > file else v0), (u, lanes[rank, file])]
            else:
                u = u0 - self._middle(self._behind(file, way.channel))
                points = [(u0, (v0 + v1) / 2), (u, (v0 + v1) / 2), (u, lanes[rank, file])]
            found[self.places[rank, file]] = tuple(points)
        return found

    def _behind(self, file: int, channel: int) -> int:
        """How many others go around the same side nearer to the array."""
        files = [one[1] for one, way in self.ways.items() if way == WayOut("behind", channel)]
        return sum(other > file if channel > 0 else other < file for other in files)

    @property
    def slits(self) -> list[float | None]:
        """From which u each inner channel holds a trace, with a gap before it; None where it holds none."""
        found: list[float | None] = []
        for channel in range(1, self.files):
            starts = [self.at(*one)[1] - self.width - self.gap for one in self.lanes(channel)]
            found.append(min(starts, default=None))
        return found

    @property
    def beside(self) -> float:
        """What the traces take beside the outermost electrodes, on the side that takes more."""
        most = max(len(self.lanes(0)), len(self.lanes(self.files)))
        return most * self.apart

    @property
    def behind(self) -> float:
        """What the traces take behind the farthest electrodes."""
        most = max(sum(way == WayOut("behind", channel) for way in self.ways.values()) for channel in (0, self.files))
        return most * self.apart


def _ways(ranks: int, files: int, room: list[float]) -> dict[tuple[int, int], WayOut] | None:
    """Electrodes that have no other way out first, from the outer files inwards; None where a channel is full."""
    left = list(room)
    found = {(ranks - 1, file): WayOut("ahead", file) for file in range(files)}
    order = sorted(range(files), key=lambda file: min(file, files - 1 - file))
    for last in (False, True):
        for file in order:
            for rank in range(ranks - 2, -1, -1):
                if (rank == 0) != last:
                    continue
                channel = _channel(file, files, left, len(found))
                if channel is None and rank > 0:
                    return None
                if channel is None:
                    found[rank, file] = WayOut("behind", files if _is_upper(file, files) else 0)
                else:
                    left[channel] -= 1
                    found[rank, file] = WayOut("beside", channel)
    return found


def _channel(file: int, files: int, left: list[float], turn: int) -> int | None:
    """The channel beside a file that has room: one outside of all, else the outer one. A single file takes turns."""
    outer, inner = (file + 1, file) if _is_upper(file, files) else (file, file + 1)
    if files == 1 and turn % 2:
        outer, inner = inner, outer
    return next((one for one in (outer, inner) if left[one] > 0), None)


def _is_upper(file: int, files: int) -> bool:
    return 2 * file + 1 >= files


def _distinct(values: Iterable[float]) -> list[float]:
    ordered = sorted(values)
    return [ordered[0], *(b for a, b in pairwise(ordered) if b - a > ROUNDING_MM)]


def _index(values: list[float], value: float) -> int:
    return min(range(len(values)), key=lambda k: abs(values[k] - value))
