"""How wide the clamp frame is at each height, seen from the cable: x points to where it leaves. Millimetres."""

from dataclasses import dataclass
from itertools import product
from typing import Any

from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.stack import Layer, layers

TURNS_DEG = {"+x": 0.0, "+y": 90.0, "-x": 180.0, "-y": 270.0}


@dataclass(frozen=True)
class ExitFrame:
    """along, across : sizes of the footprint in x (towards the cable) and y of this frame.

    count_along, count_across : segments of the array. turn_deg : about z, back into the segment's frame.
    """

    along: float
    across: float
    count_along: int
    count_across: int
    turn_deg: float

    def placed(self, solid: Any) -> Any:
        """A solid of this frame in the frame of the segment."""
        from build123d import Rot

        return Rot(0, 0, self.turn_deg) * solid


def exit_frame(segment: Segment, fabrication: Fabrication) -> ExitFrame:
    """The frame of fabrication.cable_exit."""
    sizes, counts = (segment.length_mm, segment.width_mm), fabrication.array
    if fabrication.cable_exit.endswith("y"):
        sizes, counts = (sizes[1], sizes[0]), (counts[1], counts[0])
    return ExitFrame(*sizes, *counts, TURNS_DEG[fabrication.cable_exit])


TAB_CLEARANCE_MM = 0.3
"""On each side of the film's tab: the smallest loose clearance (addema.se, layerx3d.in, forgelabs.com)."""
TIE_MM = (1.6, 3.0)
"""Slots for a cable tie, along and across the tab."""
LUG_MARGIN_MM = 1.5
"""Of material around the hole of a screw."""


@dataclass(frozen=True)
class WallRun:
    """Heights between which the opening is wider than the footprint by the gap on each side, in mm."""

    bottom: float
    top: float
    gap: float


@dataclass(frozen=True)
class FrameLayout:
    """frame : from the cable's side.

    film_bottom, film_top : heights. body : around medium 2, None where nothing is held. ring : above the film,
    empty where it is not needed. half_along, half_across : half the outer sizes, half_across with the lugs.
    pitch : between segments, 0 for a single one. screws_across : distance of the screws from the axis.
    """

    frame: ExitFrame
    film_bottom: float
    film_top: float
    body: WallRun | None
    ring: tuple[WallRun, ...]
    half_along: float
    half_across: float
    pitch: float
    screws_across: float

    @property
    def size_between(self) -> float:
        """The larger size of the footprint in the directions that have neighbours; a single segment may have any."""
        counted = ((self.frame.count_along, self.frame.along), (self.frame.count_across, self.frame.across))
        sizes = [size for count, size in counted if count > 1]
        return max(sizes or [size for _, size in counted])

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Places of the segments."""
        counts = (self.frame.count_along, self.frame.count_across)
        along, across = ([(k - (count - 1) / 2) * self.pitch for k in range(count)] for count in counts)
        return list(product(along, across))


def frame_layout(segment: Segment, fabrication: Fabrication) -> FrameLayout:
    """The layout for a segment that has passed its checks."""
    frame, stack = exit_frame(segment, fabrication), {layer.name: layer for layer in layers(segment)}
    held = held_names(segment)
    ring = _ring(segment, held, fabrication)
    body = WallRun(0.0, stack["film"].bottom_mm, _gap("medium2", held, fabrication)) if held else None
    pitch = fabrication.pitch_mm or 0.0
    widest = widest_gap(body, ring)
    half_along = ((frame.count_along - 1) * pitch + frame.along) / 2 + widest + fabrication.wall_mm
    inner_across = ((frame.count_across - 1) * pitch + frame.across) / 2 + widest + fabrication.wall_mm
    lug = fabrication.screw_diameter_mm + 2 * LUG_MARGIN_MM
    return FrameLayout(
        frame=frame,
        film_bottom=stack["film"].bottom_mm,
        film_top=stack["film"].top_mm,
        body=body,
        ring=ring,
        half_along=max(half_along, lug / 2),
        half_across=inner_across + lug,
        pitch=pitch,
        screws_across=inner_across + lug / 2,
    )


def widest_gap(body: WallRun | None, ring: tuple[WallRun, ...]) -> float:
    """The widest gap beside a segment in mm, at any height; 0 without walls."""
    return max((run.gap for run in (body, *ring) if run is not None), default=0.0)


def held_names(segment: Segment) -> set[str]:
    """Names of the layers whose sides the frame holds."""
    if segment.boundary == "free":
        return set()
    names = {layer.name for layer in layers(segment)} & set(segment.held_layers)
    return names if covers_footprint(segment) else names - {"effector"}


def _ring(segment: Segment, held: set[str], fabrication: Fabrication) -> tuple[WallRun, ...]:
    """Openings above the film up to the highest held layer, or around medium 1 where only the film is held."""
    above = [layer for layer in layers(segment) if layer.name in ("medium1", "effector")]
    kept = [layer for layer in above if layer.name in held]
    if kept:
        above = above[: above.index(kept[-1]) + 1]
    elif "film" in held:
        above = above[:1]
    else:
        above = []
    return _merged([(layer, _gap(layer.name, held, fabrication)) for layer in above])


def _merged(openings: list[tuple[Layer, float]]) -> tuple[WallRun, ...]:
    runs: list[WallRun] = []
    for layer, gap in openings:
        if runs and runs[-1].gap == gap:
            runs[-1] = WallRun(runs[-1].bottom, layer.top_mm, gap)
        else:
            runs.append(WallRun(layer.bottom_mm, layer.top_mm, gap))
    return tuple(runs)


def _gap(name: str, held: set[str], fabrication: Fabrication) -> float:
    return fabrication.glue_gap_mm if name in held else fabrication.side_clearance_mm
