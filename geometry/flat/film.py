"""Layout of the film seen from its cable: its reach beyond the footprint, its tab and its head. In mm."""

from dataclasses import dataclass
from functools import cached_property

from geometry.array.layout import Rectangle
from geometry.electrode_outlines import electrode_corners
from geometry.fabrication.device import Device, ExitFrame, exit_frame, held_layer_names
from geometry.fabrication.parameters import Fabrication
from geometry.flat.escape import Lattice
from geometry.flat.paths import column_count
from geometry.parameters import Electrode, Segment
from geometry.polygons import Point, bounding_rectangle

METAL_EDGE_MM = 0.15
"""Bare film between metal and the edge of the film (judged here)."""
LEAST_TAB_WIDTH_MM = 1.6
TAB_GAP_SHARE = 1.5
"""Gap between the leads on the tab over the least gap: the tab is bent, and has room."""
PAD_WIDTH_MM, PAD_WIDTH_SHARE, PAD_LENGTH_MM, LEAST_TAPER_MM = 1.5, 0.6, 4.0, 2.0
"""Pads: at most as wide as crimp contacts take; of a finer pitch a share that leaves a gap between them (judged here).
They are as long as flat flexible cables are plugged, 2 to 6 mm (thrive.cn, table of such cables)."""


@dataclass(frozen=True)
class FilmLayout:
    """Sizes of the film in mm, in the frame of the cable. flange : film beyond the footprint that the frame clamps.

    outlines : name of an electrode -> corners, counter-clockwise. lattice : how those of an array are led out, None
    for one segment.
    half_tab : half the width of the tab. tab_end : u where its head begins.
    trace_width, trace_gap : least ones. pad_pitch : from pad to pad.
    """

    frame: ExitFrame
    flange: float
    outlines: dict[str, tuple[Point, ...]]
    lattice: Lattice | None
    half_tab: float
    tab_end: float
    trace_width: float
    trace_gap: float
    pad_pitch: float

    @cached_property
    def electrodes(self) -> dict[str, Rectangle]:
        """Name -> rectangle u0, u1, v0, v1 around each electrode."""
        return {name: bounding_rectangle(corners) for name, corners in self.outlines.items()}

    @property
    def pad_count(self) -> int:
        """Number of pads: one for each electrode and one for the common one."""
        return len(self.electrodes) + 1

    @property
    def tab_gap(self) -> float:
        """Gap in mm between the leads on the tab."""
        return TAB_GAP_SHARE * self.trace_gap

    @property
    def lead_width(self) -> float:
        """Width in mm of each of the leads side by side on the tab; not positive where there is no room."""
        return (2 * self.half_tab - 2 * METAL_EDGE_MM - (self.pad_count - 1) * self.tab_gap) / self.pad_count

    @cached_property
    def lanes(self) -> list[float]:
        """Middles v in mm of the leads on the tab, rising."""
        low = -self.half_tab + METAL_EDGE_MM + self.lead_width / 2
        return [low + number * (self.lead_width + self.tab_gap) for number in range(self.pad_count)]

    @cached_property
    def pads(self) -> list[float]:
        """Middles v in mm of the pads, rising."""
        return [(number - (self.pad_count - 1) / 2) * self.pad_pitch for number in range(self.pad_count)]

    @property
    def pad_width(self) -> float:
        """Width in mm of the metal of a pad."""
        return min(PAD_WIDTH_MM, PAD_WIDTH_SHARE * self.pad_pitch)

    @property
    def half_head(self) -> float:
        """Half the width in mm of the head that carries the pads."""
        return max(((self.pad_count - 1) * self.pad_pitch + self.pad_width) / 2 + 2 * METAL_EDGE_MM, self.half_tab)

    @property
    def taper(self) -> float:
        """Length in mm from the end of the tab to the pads; the leads turn to them in columns."""
        return max(
            LEAST_TAPER_MM, METAL_EDGE_MM + column_count(self.lanes, self.pads) * (self.lead_width + self.tab_gap)
        )

    @property
    def head_length(self) -> float:
        """Length in mm of the head from the end of the tab."""
        return self.taper + PAD_LENGTH_MM + METAL_EDGE_MM

    @cached_property
    def front_edge(self) -> float:
        """u in mm of the front edge of the electrodes nearest to the cable."""
        return max(u1 for _, u1, _, _ in self.electrodes.values())

    @cached_property
    def entries(self) -> list[float]:
        """Coordinates v in mm at which the traces of an array and its common electrode pass its front, rising."""
        assert self.lattice is not None
        return sorted([*(points[-1][1] for points in self.lattice.lines.values()), self.common_v])

    @cached_property
    def common_v(self) -> float:
        """v in mm of the trace of the common electrode: at its lower corner, below the other trace of that file."""
        return min(v0 for _, _, v0, _ in self.electrodes.values()) + self.trace_width / 2

    @cached_property
    def body_end(self) -> float:
        """u in mm of the film's edge towards the cable; before it the traces of an array turn to their lanes."""
        end = self.frame.along / 2 + self.flange
        if self.lattice is None:
            return end
        columns = column_count(self.entries, self.lanes)
        return max(end, self.front_edge + columns * self.lattice.trace_pitch + METAL_EDGE_MM)

    @cached_property
    def back_end(self) -> float:
        """Distance in mm that the film reaches away from the cable."""
        behind = self.lattice.width_behind if self.lattice is not None else 0.0
        edge = -min(u0 for u0, _, _, _ in self.electrodes.values())
        return max(self.frame.along / 2 + self.flange, edge + behind + METAL_EDGE_MM if behind else 0.0)

    @cached_property
    def half_body(self) -> float:
        """Half the width in mm of the film's body."""
        beside = self.lattice.width_beside if self.lattice is not None else 0.0
        edge = max(v1 for _, _, _, v1 in self.electrodes.values())
        return max(self.frame.across / 2 + self.flange, edge + beside + METAL_EDGE_MM if beside else 0.0)

    @property
    def beyond(self) -> float:
        """Largest distance in mm that the film, but for its tab, reaches beyond the footprint."""
        along, across = self.frame.along / 2, self.frame.across / 2
        return max(self.body_end - along, self.back_end - along, self.half_body - across)


def film_layout(device: Device, fabrication: Fabrication) -> FilmLayout:
    """The layout of the film of a device that has passed its checks."""
    stack, frame = device.stack, exit_frame(device.stack, fabrication)
    outlines = _outlines(stack, frame)
    width, gap = fabrication.trace_width_mm, fabrication.trace_gap_mm
    margin = device.layout.array.electrode_margin_mm
    least = 2 * METAL_EDGE_MM + len(outlines) * TAB_GAP_SHARE * gap + (len(outlines) + 1) * width
    boxes = {name: bounding_rectangle(corners) for name, corners in outlines.items()}
    return FilmLayout(
        frame=frame,
        flange=fabrication.film_flange_mm if "film" in held_layer_names(stack) else 0.0,
        outlines=outlines,
        lattice=Lattice(boxes, width, gap, margin) if device.is_array else None,
        half_tab=(fabrication.tab_width_mm or max(LEAST_TAB_WIDTH_MM, least)) / 2,
        tab_end=frame.along / 2 + fabrication.tab_length_mm,
        trace_width=width,
        trace_gap=gap,
        pad_pitch=fabrication.pad_pitch_mm,
    )


def _outlines(stack: Segment, frame: ExitFrame) -> dict[str, tuple[Point, ...]]:
    """Name -> corners of each electrode in the frame; one electrode on the whole footprint where none is stated."""
    whole = Electrode(name="film", size_mm=(stack.length_mm, stack.width_mm))
    every = stack.film.electrodes or (whole,)
    return {one.name: tuple(map(frame.point_in_frame, electrode_corners(one))) for one in every}
