"""The layout of the film seen from its cable: how far it reaches beyond the footprint, its tab and its head. In mm."""

from dataclasses import dataclass
from functools import cached_property

from geometry.array.layout import Rectangle
from geometry.fabrication.device import Device, ExitFrame, exit_frame, held_names
from geometry.fabrication.parameters import Fabrication
from geometry.flat.escape import Lattice
from geometry.flat.paths import column_count
from geometry.parameters import Electrode, Segment

EDGE_MM = 0.15
"""Bare film between metal and the edge of the film (judged here)."""
LEAST_TAB_MM = 1.6
TAB_GAP_SHARE = 1.5
"""Of the least gap, between the leads on the tab, which is bent and has room."""
PAD_WIDTH_MM, PAD_SHARE, PAD_LENGTH_MM, TAPER_MM = 1.5, 0.6, 4.0, 2.0
"""Pads: at most as wide as crimp contacts take; of a finer pitch a share that leaves a gap between them (judged here).
They are as long as flat flexible cables are plugged, 2 to 6 mm (thrive.cn, table of such cables)."""


@dataclass(frozen=True)
class FilmLayout:
    """frame : the view. flange : film beyond the footprint on each side that the frame clamps.

    electrodes : name -> u0, u1, v0, v1. lattice : how those of an array are led out, None for one segment.
    half_tab : half the width of the tab. tab_end : u where its head begins.
    trace_width, trace_gap : least ones. pad_pitch : from pad to pad.
    """

    frame: ExitFrame
    flange: float
    electrodes: dict[str, Rectangle]
    lattice: Lattice | None
    half_tab: float
    tab_end: float
    trace_width: float
    trace_gap: float
    pad_pitch: float

    @property
    def count(self) -> int:
        """Of pads: one for each electrode and one for the common one."""
        return len(self.electrodes) + 1

    @property
    def tab_gap(self) -> float:
        """Between the leads on the tab."""
        return TAB_GAP_SHARE * self.trace_gap

    @property
    def lead(self) -> float:
        """Width of each of the leads side by side on the tab; not positive where there is no room."""
        return (2 * self.half_tab - 2 * EDGE_MM - (self.count - 1) * self.tab_gap) / self.count

    @cached_property
    def lanes(self) -> list[float]:
        """Middles of the leads on the tab, rising."""
        low = -self.half_tab + EDGE_MM + self.lead / 2
        return [low + number * (self.lead + self.tab_gap) for number in range(self.count)]

    @cached_property
    def pads(self) -> list[float]:
        """Middles of the pads, rising."""
        return [(number - (self.count - 1) / 2) * self.pad_pitch for number in range(self.count)]

    @property
    def pad_width(self) -> float:
        """Of metal."""
        return min(PAD_WIDTH_MM, PAD_SHARE * self.pad_pitch)

    @property
    def half_head(self) -> float:
        """Half the width of the head that carries the pads."""
        return max(((self.count - 1) * self.pad_pitch + self.pad_width) / 2 + 2 * EDGE_MM, self.half_tab)

    @property
    def taper(self) -> float:
        """From the end of the tab to the pads; the leads turn to them in columns."""
        return max(TAPER_MM, EDGE_MM + column_count(self.lanes, self.pads) * (self.lead + self.tab_gap))

    @property
    def head_length(self) -> float:
        """From the end of the tab."""
        return self.taper + PAD_LENGTH_MM + EDGE_MM

    @cached_property
    def front_edge(self) -> float:
        """u of the electrodes nearest to the cable."""
        return max(u1 for _, u1, _, _ in self.electrodes.values())

    @cached_property
    def entries(self) -> list[float]:
        """v at which the traces of an array and its common electrode pass its front, rising."""
        assert self.lattice is not None
        return sorted([*(points[-1][1] for points in self.lattice.lines.values()), self.common_v])

    @cached_property
    def common_v(self) -> float:
        """Where the trace of the common electrode leaves it: at its lower corner, below the other of that file."""
        return min(v0 for _, _, v0, _ in self.electrodes.values()) + self.trace_width / 2

    @cached_property
    def body_end(self) -> float:
        """u of the film's edge towards the cable; before it the traces of an array turn to their lanes."""
        end = self.frame.along / 2 + self.flange
        if self.lattice is None:
            return end
        columns = column_count(self.entries, self.lanes)
        return max(end, self.front_edge + columns * self.lattice.apart + EDGE_MM)

    @cached_property
    def back_end(self) -> float:
        """How far the film reaches away from the cable."""
        behind = self.lattice.behind if self.lattice is not None else 0.0
        edge = -min(u0 for u0, _, _, _ in self.electrodes.values())
        return max(self.frame.along / 2 + self.flange, edge + behind + EDGE_MM if behind else 0.0)

    @cached_property
    def half_body(self) -> float:
        """Half the size of the body across."""
        beside = self.lattice.beside if self.lattice is not None else 0.0
        edge = max(v1 for _, _, _, v1 in self.electrodes.values())
        return max(self.frame.across / 2 + self.flange, edge + beside + EDGE_MM if beside else 0.0)

    @property
    def beyond(self) -> float:
        """How far the film reaches beyond the footprint, at most, but for its tab."""
        along, across = self.frame.along / 2, self.frame.across / 2
        return max(self.body_end - along, self.back_end - along, self.half_body - across)


def film_layout(device: Device, fabrication: Fabrication) -> FilmLayout:
    """The film of a device that has passed its checks."""
    stack, frame = device.stack, exit_frame(device.stack, fabrication)
    electrodes = _electrodes(stack, frame)
    width, gap = fabrication.trace_width_mm, fabrication.trace_gap_mm
    margin = device.layout.array.electrode_margin_mm
    least = 2 * EDGE_MM + len(electrodes) * TAB_GAP_SHARE * gap + (len(electrodes) + 1) * width
    return FilmLayout(
        frame=frame,
        flange=fabrication.film_flange_mm if "film" in held_names(stack) else 0.0,
        electrodes=electrodes,
        lattice=Lattice(electrodes, width, gap, margin) if device.is_array else None,
        half_tab=(fabrication.tab_width_mm or max(LEAST_TAB_MM, least)) / 2,
        tab_end=frame.along / 2 + fabrication.tab_length_mm,
        trace_width=width,
        trace_gap=gap,
        pad_pitch=fabrication.pad_pitch_mm,
    )


def _electrodes(stack: Segment, frame: ExitFrame) -> dict[str, Rectangle]:
    """Names and rectangles; without a table one electrode on the whole footprint."""
    whole = Electrode(name="film", size_mm=(stack.length_mm, stack.width_mm))
    return {one.name: frame.seen(_rectangle(one)) for one in stack.film.electrodes or (whole,)}


def _rectangle(electrode: Electrode) -> Rectangle:
    (x, y), (length, width) = electrode.center_mm, electrode.size_mm
    return (x - length / 2, x + length / 2, y - width / 2, y + width / 2)
