"""Layout of the clamp frame: its width at each height, seen from the cable, to which u points. In millimetres."""

from dataclasses import dataclass, replace
from itertools import product

from geometry.array.layout import Rectangle
from geometry.fabrication.device import Device, ExitFrame, held_layer_names, rim_gap_mm
from geometry.fabrication.parameters import Fabrication
from geometry.flat.film import film_layout
from geometry.stack import layers

TAB_CLEARANCE_MM = 0.3
"""Gap on each side of the film's tab: the smallest loose clearance (addema.se, layerx3d.in, forgelabs.com)."""
TIE_SLOT_MM = (1.6, 3.0)
"""Size of the slots for a cable tie, along and across the tab."""
LUG_MARGIN_MM = 1.5
"""Material around the hole of a screw."""


@dataclass(frozen=True)
class WallRun:
    """Heights in mm between which each opening is wider, by the gap on each side, than what stands in it.

    feet : what stands in the openings, seen from the cable; several where bars of a grid stand between them.
    """

    bottom: float
    top: float
    gap: float
    feet: tuple[Rectangle, ...]


@dataclass(frozen=True)
class FrameLayout:
    """Sizes of the clamp frame in mm, in the frame of the cable.

    film_bottom, film_top : heights. body : walls around medium 2, None where nothing is held. ring : walls above the
    film, empty where it is not needed. half_along, half_across : half the outer sizes, half_across with the lugs.
    pitch : between devices, 0 for a single one. screws_across : distance of the screws from the axis.
    half_tab : half the width of the film's tab. room_for_tab : width of the footprint, of an array that of its film.
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
    half_tab: float
    room_for_tab: float

    @property
    def size_between(self) -> float:
        """The larger size in mm of the footprint in the directions that have neighbours; in any for a single device."""
        counted = ((self.frame.count_along, self.frame.along), (self.frame.count_across, self.frame.across))
        sizes = [size for count, size in counted if count > 1]
        return max(sizes or [size for _, size in counted])

    @property
    def centers(self) -> list[tuple[float, float]]:
        """Centres (u, v) of the devices, in mm."""
        counts = (self.frame.count_along, self.frame.count_across)
        along, across = ([(k - (count - 1) / 2) * self.pitch for k in range(count)] for count in counts)
        return list(product(along, across))


def frame_layout(device: Device, fabrication: Fabrication) -> FrameLayout:
    """The layout of the clamp frame of a device that has passed its checks."""
    film, stack = film_layout(device, fabrication), {layer.name: layer for layer in layers(device.segment)}
    frame, held = film.frame, held_layer_names(device.stack)
    ring = _ring_runs(device, held, frame, fabrication)
    body = _wall_run("medium2", device, held, frame, fabrication) if held else None
    pitch = fabrication.pitch_mm or 0.0
    traces = film.beyond if film.lattice is not None else 0.0
    beside = max(widest_gap(body, ring) + fabrication.wall_mm, traces)
    half_along = ((frame.count_along - 1) * pitch + frame.along) / 2 + beside
    inner_across = ((frame.count_across - 1) * pitch + frame.across) / 2 + beside
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
        half_tab=film.half_tab,
        room_for_tab=frame.across if film.lattice is None else 2 * film.half_body,
    )


def widest_gap(body: WallRun | None, ring: tuple[WallRun, ...]) -> float:
    """The widest gap beside a layer in mm, at any height; 0 without walls."""
    return max((run.gap for run in (body, *ring) if run is not None), default=0.0)


def _ring_runs(device: Device, held: set[str], frame: ExitFrame, fabrication: Fabrication) -> tuple[WallRun, ...]:
    """Walls above the film up to the highest held layer, or around medium 1 where only the film is held."""
    above = [layer.name for layer in layers(device.segment) if layer.name in ("medium1", "effector")]
    kept = [name for name in above if name in held]
    if kept:
        above = above[: above.index(kept[-1]) + 1]
    elif "film" in held:
        above = above[:1]
    else:
        above = []
    runs: list[WallRun] = []
    for run in (_wall_run(name, device, held, frame, fabrication) for name in above):
        if runs and (runs[-1].gap, runs[-1].feet) == (run.gap, run.feet):
            run = replace(run, bottom=runs.pop().bottom)
        runs.append(run)
    return tuple(runs)


def _wall_run(name: str, device: Device, held: set[str], frame: ExitFrame, fabrication: Fabrication) -> WallRun:
    """Walls around one layer: one opening for each piece that the grid holds or beside which it clamps the film."""
    layer = next(one for one in layers(device.segment) if one.name == name)
    gap = rim_gap_mm(device.stack, fabrication) if name in held else fabrication.side_clearance_mm
    clamps = name == "medium1" and device.layout.is_cut(name) and "film" in device.layout.array.grid_layers
    feet = device.layer_rectangles(name) if device.in_grid(name) or clamps else device.stack_rectangles
    return WallRun(layer.bottom_mm, layer.top_mm, gap, tuple(map(frame.rectangle_in_frame, feet)))
