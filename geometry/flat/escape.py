"""Escape routing in the plane: how the electrodes of an array are led out of it without a crossing.

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
from geometry.polygons import Point

Side = Literal["ahead", "beside", "behind"]


@dataclass(frozen=True)
class WayOut:
    """How a trace leaves its electrode.

    side : of the electrode at which it leaves. channel : number of the channel, above file channel - 1 and below file
    channel.
    """

    side: Side
    channel: int


@dataclass(frozen=True)
class Lattice:
    """Electrodes on a lattice of files and ranks, and the traces that lead out of it. Lengths in mm.

    electrodes : name -> u0, u1, v0, v1. width, gap : of traces and of bare film beside them.
    margin : bare film between the edges of segment and electrode.
    """

    electrodes: dict[str, Rectangle]
    width: float
    gap: float
    margin: float

    @cached_property
    def places(self) -> dict[tuple[int, int], str]:
        """Rank and file -> name of the electrode there; both rise with u and v."""
        middles = {name: ((u0 + u1) / 2, (v0 + v1) / 2) for name, (u0, u1, v0, v1) in self.electrodes.items()}
        us, vs = ([*_distinct_values(middle[k] for middle in middles.values())] for k in (0, 1))
        return {(_nearest_index(us, u), _nearest_index(vs, v)): name for name, (u, v) in middles.items()}

    @property
    def ranks(self) -> int:
        """Number of electrodes in each file."""
        return 1 + max(rank for rank, _ in self.places)

    @property
    def files(self) -> int:
        """Number of files, the lines of electrodes along u."""
        return 1 + max(file for _, file in self.places)

    def at(self, rank: int, file: int) -> Rectangle:
        """The rectangle of the electrode of a rank and file."""
        return self.electrodes[self.places[rank, file]]

    @property
    def trace_pitch(self) -> float:
        """Distance in mm from the middle of one trace to that of the next."""
        return self.width + self.gap

    @property
    def gaps(self) -> list[float]:
        """Gaps in mm between neighbouring files."""
        return [self.at(0, file + 1)[2] - self.at(0, file)[3] for file in range(self.files - 1)]

    @property
    def channel_rooms(self) -> list[float]:
        """Number of traces that fit into each channel, with a gap beside each; infinite in the outer channels."""
        inner = [floor(max(gap - self.gap, 0.0) / self.trace_pitch + ROUNDING_MM) for gap in self.gaps]
        return [inf, *inner, inf]

    @cached_property
    def ways(self) -> dict[tuple[int, int], WayOut]:
        """Rank and file -> way out of each electrode. InputError where a channel is full."""
        found = _assign_ways(self.ranks, self.files, self.channel_rooms)
        if found is None:
            self._refuse_full_channel()
        assert found is not None
        return found

    def _refuse_full_channel(self) -> None:
        """InputError, with the margin that would do, where more traces must pass between two electrodes than fit."""
        counts = range(1, self.ranks + 1)
        most = next(n for n in counts if _assign_ways(self.ranks, self.files, [inf, *[n] * (self.files - 1), inf]))
        narrowest, needed = min(self.gaps), most * self.width + (most + 1) * self.gap
        least = self.margin + (needed - narrowest) / 2
        _, _, v0, v1 = self.at(0, 0)
        fits = 2 * least < v1 - v0 + 2 * self.margin
        margin = f"must be at least {least:.3g}, or" if fits else "no margin is enough, so"
        raise InputError(
            f"array.electrode_margin_mm = {self.margin:g}: the traces of inner electrodes cannot be led out, as a gap "
            f"of {narrowest:.3g} mm between electrodes takes {min(self.channel_rooms[1:-1]):g} traces of "
            f"{self.width:g} mm with {self.gap:g} mm beside each, and {most} must pass; {margin} give smaller "
            "fabrication.trace_width_mm and trace_gap_mm, or another cable_exit"
        )

    def lanes(self, channel: int) -> dict[tuple[int, int], float]:
        """Rank and file -> v in mm of each trace in a channel; that of the front electrode lies nearest to its file."""
        below = self._traces_in(channel, channel - 1, "beside")
        above = self._traces_in(channel, channel, "beside")
        around = [one for one, way in self.ways.items() if way == WayOut("behind", channel)]
        found: dict[tuple[int, int], float] = {}
        if channel > 0:
            below += sorted(around, key=lambda one: -one[1])
            edge = self.at(0, channel - 1)[3]
            found |= {one: edge + self._trace_offset(number) for number, one in enumerate(below)}
        if channel < self.files:
            above += [] if channel > 0 else sorted(around, key=lambda one: one[1])
            edge = self.at(0, channel)[2]
            found |= {one: edge - self._trace_offset(number) for number, one in enumerate(above)}
        return found

    def _traces_in(self, channel: int, file: int, side: Side) -> list[tuple[int, int]]:
        """Ranks and files of the traces of a file in a channel, the nearest to the cable first."""
        way = WayOut(side, channel)
        return sorted((one for one, other in self.ways.items() if one[1] == file and other == way), reverse=True)

    def _trace_offset(self, number: int) -> float:
        """Distance in mm of the middle of a trace from the edge of the metal beside it."""
        return self.gap + self.width / 2 + number * self.trace_pitch

    @cached_property
    def lines(self) -> dict[str, tuple[Point, ...]]:
        """Name -> centre line of its trace, from the electrode to the front of the array, where all look ahead."""
        lanes = {one: v for channel in range(self.files + 1) for one, v in self.lanes(channel).items()}
        found = {}
        for (rank, file), way in self.ways.items():
            u0, u1, v0, v1 = self.at(rank, file)
            if way.side == "ahead":
                # beside the trace of the common electrode, which leaves at the lower corner
                clear = min(v0 + self.width + self._trace_offset(0), v1 - self.width / 2)
                points: list[Point] = [(u1, max((v0 + v1) / 2, clear))]
            elif way.side == "beside":
                u = u1 - self.width / 2
                points = [(u, v1 if way.channel > file else v0), (u, lanes[rank, file])]
            else:
                u = u0 - self._trace_offset(self._inner_trace_count(file, way.channel))
                points = [(u0, (v0 + v1) / 2), (u, (v0 + v1) / 2), (u, lanes[rank, file])]
            found[self.places[rank, file]] = tuple(points)
        return found

    def _inner_trace_count(self, file: int, channel: int) -> int:
        """Number of traces that go around the same side nearer to the array."""
        files = [one[1] for one, way in self.ways.items() if way == WayOut("behind", channel)]
        return sum(other > file if channel > 0 else other < file for other in files)

    @property
    def slits(self) -> list[float | None]:
        """u in mm from which each inner channel holds a trace, with a gap before it; None where it holds none."""
        found: list[float | None] = []
        for channel in range(1, self.files):
            starts = [self.at(*one)[1] - self.width - self.gap for one in self.lanes(channel)]
            found.append(min(starts, default=None))
        return found

    @property
    def width_beside(self) -> float:
        """Width in mm of the traces beside the outermost electrodes, on the side that has more."""
        most = max(len(self.lanes(0)), len(self.lanes(self.files)))
        return most * self.trace_pitch

    @property
    def width_behind(self) -> float:
        """Width in mm of the traces behind the farthest electrodes."""
        most = max(sum(way == WayOut("behind", channel) for way in self.ways.values()) for channel in (0, self.files))
        return most * self.trace_pitch


def _assign_ways(ranks: int, files: int, room: list[float]) -> dict[tuple[int, int], WayOut] | None:
    """Ways out of all electrodes, or None where a channel is full.

    Those that have no other way out come first, from the outer files inwards.
    """
    left = list(room)
    found = {(ranks - 1, file): WayOut("ahead", file) for file in range(files)}
    order = sorted(range(files), key=lambda file: min(file, files - 1 - file))
    for last in (False, True):
        for file in order:
            for rank in range(ranks - 2, -1, -1):
                if (rank == 0) != last:
                    continue
                channel = _free_channel(file, files, left, len(found))
                if channel is None and rank > 0:
                    return None
                if channel is None:
                    found[rank, file] = WayOut("behind", files if _is_upper(file, files) else 0)
                else:
                    left[channel] -= 1
                    found[rank, file] = WayOut("beside", channel)
    return found


def _free_channel(file: int, files: int, left: list[float], turn: int) -> int | None:
    """The channel beside a file that has room, or None: one outside of all files, else the outer one.

    A single file takes turns between its two channels.
    """
    outer, inner = (file + 1, file) if _is_upper(file, files) else (file, file + 1)
    if files == 1 and turn % 2:
        outer, inner = inner, outer
    return next((one for one in (outer, inner) if left[one] > 0), None)


def _is_upper(file: int, files: int) -> bool:
    return 2 * file + 1 >= files


def _distinct_values(values: Iterable[float]) -> list[float]:
    ordered = sorted(values)
    return [ordered[0], *(b for a, b in pairwise(ordered) if b - a > ROUNDING_MM)]


def _nearest_index(values: list[float], value: float) -> int:
    return min(range(len(values)), key=lambda k: abs(values[k] - value))
