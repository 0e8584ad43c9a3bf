"""What a kit makes, one segment or an array of them under shared layers, and how it is seen from its cable. In mm."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, get_args

from foundation.errors import InputError
from geometry.array.layout import ArrayLayout, Rectangle
from geometry.array.parameters import Array
from geometry.array.parts import groove_solids
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import refuse_thin, without
from geometry.parameters import LayerName, Segment
from geometry.part_checks import covers_footprint
from geometry.solids import layer_solids
from geometry.stack import layers


@dataclass(frozen=True)
class Device:
    """layout : where its segments lie and what runs through; one segment is an array of one.

    stack : the whole as one stack of layers, with an electrode for each segment; frame, film and jig fit it.
    """

    layout: ArrayLayout
    stack: Segment

    @property
    def segment(self) -> Segment:
        """One of its segments, as the configuration states it."""
        return self.layout.segment

    @property
    def is_array(self) -> bool:
        """Whether it has several segments."""
        return len(self.layout.places) > 1

    def pieces(self, name: str) -> int:
        """Of how many pieces a layer is."""
        return len(self.layout.places) if self.layout.is_cut(name) else 1

    def source(self, name: str) -> Segment:
        """The segment or the stack that states one piece of a layer."""
        return self.segment if self.layout.is_cut(name) else self.stack

    def in_grid(self, name: str) -> bool:
        """Whether bars of a stiff grid stand between the pieces of a layer."""
        return name in self.layout.array.grid_layers and self.layout.is_cut(name)

    @cached_property
    def _film_mm(self) -> float:
        return self.segment.film.thickness_um * 1e-3

    def piece(self, name: str) -> Any:
        """One piece of a layer, a build123d Solid about the z axis at its height, with its grooves."""
        layer = next(one for one in layers(self.segment) if one.name == name)
        solid = layer_solids(self.source(name), self._film_mm)[name]
        return without(solid, groove_solids(self.layout, layer))

    def solids(self, name: str) -> list[Any]:
        """All pieces of a layer in their places."""
        from build123d import Pos

        piece = self.piece(name)
        return [Pos(x, y, 0) * piece for x, y in self.layout.middles] if self.layout.is_cut(name) else [piece]

    @property
    def feet_of_stack(self) -> list[Rectangle]:
        """What the whole stack covers."""
        half_x, half_y = self.stack.length_mm / 2, self.stack.width_mm / 2
        return [(-half_x, half_x, -half_y, half_y)]

    def feet(self, name: str) -> list[Rectangle]:
        """What the pieces of a layer cover, round ones within a rectangle."""
        return self.layout.rectangles(name) if self.layout.is_cut(name) else self.feet_of_stack


def lone_device(segment: Segment) -> Device:
    """One segment that has passed its checks."""
    array = Array(columns=1, rows=1, shared=get_args(LayerName))
    return Device(ArrayLayout(array, segment, 0.0, 0.0), segment)


def array_device(layout: ArrayLayout, fabrication: Fabrication) -> Device:
    """An array that has passed its checks. InputError for what a kit cannot make of it."""
    for key, value, plain in (
        ("array", list(fabrication.array), [1, 1]),
        ("pitch_mm", fabrication.pitch_mm, None),
    ):
        if value != plain:
            raise InputError(
                f"fabrication.{key} = {value}: puts separate segments into one frame, and the table [array] states "
                "others already; leave it out"
            )
    if "film" not in layout.array.shared:
        raise InputError(
            f"array.shared = {list(layout.array.shared)}: no trace leads out of a film that is an island; name 'film'"
        )
    _check_grid_passes(layout)
    _check_webs(layout)
    held = layout.held_layers
    if not covers_footprint(layout.segment):
        held = tuple(name for name in held if name != "effector")
    return Device(layout, layout.whole.model_copy(update={"held_layers": held}))


def _check_grid_passes(layout: ArrayLayout) -> None:
    """Bars that clamp the film from above stand where medium 1 would run through."""
    if set(layout.array.grid_layers) - {"medium2"} == {"film"} and not layout.is_cut("medium1"):
        raise InputError(
            f"array.grid_layers = {list(layout.array.grid_layers)}: the bars that clamp the film from above would cut "
            "medium1, which runs through; add 'medium1', or leave it out of array.shared"
        )


LEAST_WEB_MM = 0.2
"""Of rubber under a groove: a thinner web tears when the part is lifted from its mould (judged here)."""


def _check_webs(layout: ArrayLayout) -> None:
    thick = {layer.name: layer.thickness_mm for layer in layers(layout.segment)}
    for number, groove in enumerate(layout.array.grooves):
        refuse_thin(
            f"array.grooves[{number}].depth_mm = {groove.depth_mm:g}: leaves a web of {groove.layer}",
            thick[groove.layer] - groove.depth_mm,
            LEAST_WEB_MM,
            "the limit for cast rubber",
            "make the groove shallower, or leave the layer out of array.shared",
        )


def held_names(segment: Segment) -> set[str]:
    """Names of the layers whose sides the frame holds."""
    if segment.boundary == "free":
        return set()
    names = {layer.name for layer in layers(segment)} & set(segment.held_layers)
    return names if covers_footprint(segment) else names - {"effector"}


TURNS_DEG = {"+x": 0.0, "+y": 90.0, "-x": 180.0, "-y": 270.0}


@dataclass(frozen=True)
class ExitFrame:
    """along, across : sizes of the footprint in x (towards the cable) and y of this frame.

    count_along, count_across : devices in one clamp frame. turn_deg : about z, back into the axes of the device.
    """

    along: float
    across: float
    count_along: int
    count_across: int
    turn_deg: float

    def placed(self, solid: Any) -> Any:
        """A solid of this frame in the axes of the device."""
        from build123d import Rot

        return Rot(0, 0, self.turn_deg) * solid

    def placed_point(self, place: tuple[float, float]) -> tuple[float, float]:
        """A point of this frame in the axes of the device."""
        u, v = place
        return ((u, v), (-v, u), (-u, -v), (v, -u))[round(self.turn_deg / 90.0) % 4]

    def seen(self, rectangle: Rectangle) -> Rectangle:
        """A rectangle of the device in this frame: least and largest u and v."""
        quarter = round(self.turn_deg / 90.0) % 4
        x0, x1, y0, y1 = rectangle
        corners = [((x, y), (y, -x), (-x, -y), (-y, x))[quarter] for x, y in ((x0, y0), (x1, y1))]
        (u0, u1), (v0, v1) = (sorted(pair) for pair in zip(*corners, strict=True))
        return (u0, u1, v0, v1)


def exit_frame(segment: Segment, fabrication: Fabrication) -> ExitFrame:
    """The frame of fabrication.cable_exit for a stack of these sizes."""
    sizes, counts = (segment.length_mm, segment.width_mm), fabrication.array
    if fabrication.cable_exit.endswith("y"):
        sizes, counts = (sizes[1], sizes[0]), (counts[1], counts[0])
    return ExitFrame(*sizes, *counts, TURNS_DEG[fabrication.cable_exit])
