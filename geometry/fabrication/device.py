"""What a kit makes, a segment or an array under shared layers, and its frame as seen from the cable. In mm."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, get_args

from foundation.errors import InputError
from geometry.array.layout import ArrayLayout, Rectangle
from geometry.array.parameters import Array
from geometry.array.parts import groove_solids
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import refuse_thin, subtract_solids
from geometry.parameters import LayerName, Segment
from geometry.part_checks import covers_footprint
from geometry.polygons import bounding_rectangle
from geometry.solids import layer_solids
from geometry.stack import layers


@dataclass(frozen=True)
class Device:
    """What a kit makes.

    layout : where its segments lie and what runs through; one segment is an array of one.
    stack : the whole as one stack of layers, with an electrode for each segment; frame, film and jig fit it.
    """

    layout: ArrayLayout
    stack: Segment

    @property
    def segment(self) -> Segment:
        """One of the segments, as the configuration states it."""
        return self.layout.segment

    @property
    def is_array(self) -> bool:
        """Whether the device has several segments."""
        return len(self.layout.places) > 1

    def piece_count(self, name: str) -> int:
        """Number of pieces that a layer consists of."""
        return len(self.layout.places) if self.layout.is_cut(name) else 1

    def stated_segment(self, name: str) -> Segment:
        """The segment or the stack whose sizes are those of one piece of a layer."""
        return self.segment if self.layout.is_cut(name) else self.stack

    def in_grid(self, name: str) -> bool:
        """Whether bars of a stiff grid stand between the pieces of a layer."""
        return name in self.layout.array.grid_layers and self.layout.is_cut(name)

    @cached_property
    def _film_mm(self) -> float:
        return self.segment.film.thickness_um * 1e-3

    def piece(self, name: str) -> Any:
        """One piece of a layer with its grooves, a build123d Solid about the z axis at its height."""
        layer = next(one for one in layers(self.segment) if one.name == name)
        solid = layer_solids(self.stated_segment(name), self._film_mm)[name]
        return subtract_solids(solid, groove_solids(self.layout, layer))

    def solids(self, name: str) -> list[Any]:
        """All pieces of a layer in their places, build123d Solids."""
        from build123d import Pos

        piece = self.piece(name)
        return [Pos(x, y, 0) * piece for x, y in self.layout.middles] if self.layout.is_cut(name) else [piece]

    @property
    def stack_rectangles(self) -> list[Rectangle]:
        """The one rectangle that the whole stack covers."""
        half_x, half_y = self.stack.length_mm / 2, self.stack.width_mm / 2
        return [(-half_x, half_x, -half_y, half_y)]

    def layer_rectangles(self, name: str) -> list[Rectangle]:
        """Rectangles that the pieces of a layer cover; round pieces lie within theirs."""
        return self.layout.rectangles(name) if self.layout.is_cut(name) else self.stack_rectangles


def lone_device(segment: Segment) -> Device:
    """The device of one segment that has passed its checks."""
    array = Array(columns=1, rows=1, shared=get_args(LayerName))
    return Device(ArrayLayout(array, segment, 0.0, 0.0), segment)


def array_device(layout: ArrayLayout, fabrication: Fabrication) -> Device:
    """The device of an array that has passed its checks. InputError for an array that a kit cannot make."""
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
    _refuse_cut_medium1(layout)
    _refuse_thin_webs(layout)
    held = layout.held_layers
    if not covers_footprint(layout.segment):
        held = tuple(name for name in held if name != "effector")
    return Device(layout, layout.whole.model_copy(update={"held_layers": held}))


def _refuse_cut_medium1(layout: ArrayLayout) -> None:
    """Refuse bars that clamp the film from above where medium 1 would run through."""
    if set(layout.array.grid_layers) - {"medium2"} == {"film"} and not layout.is_cut("medium1"):
        raise InputError(
            f"array.grid_layers = {list(layout.array.grid_layers)}: the bars that clamp the film from above would cut "
            "medium1, which runs through; add 'medium1', or leave it out of array.shared"
        )


RIM_GAPS_MM = 0.05, 1.5
"""Glue lines of an elastic rim that can be filled evenly (judged here)."""
LEAST_WEB_MM = 0.2
"""Least rubber under a groove: a thinner web tears when the part is lifted from its mould (judged here)."""


def _refuse_thin_webs(layout: ArrayLayout) -> None:
    thick = {layer.name: layer.thickness_mm for layer in layers(layout.segment)}
    for number, groove in enumerate(layout.array.grooves):
        refuse_thin(
            f"array.grooves[{number}].depth_mm = {groove.depth_mm:g}: leaves a web of {groove.layer}",
            thick[groove.layer] - groove.depth_mm,
            LEAST_WEB_MM,
            "the limit for cast rubber",
            "make the groove shallower, or leave the layer out of array.shared",
        )


def held_layer_names(segment: Segment) -> set[str]:
    """Names of the layers whose sides the frame holds; of an elastic rim without the film, which a clamp would hold
    rigidly: its edge ends in the glue.
    """
    if segment.boundary == "free":
        return set()
    names = {layer.name for layer in layers(segment)} & set(segment.held_layers)
    if segment.boundary == "elastic":
        names -= {"film"}
    return names if covers_footprint(segment) else names - {"effector"}


def rim_gap_mm(stack: Segment, fabrication: Fabrication) -> float:
    """Gap in mm between a held layer and its wall, which glue fills.

    Of an elastic rim it is the thickness at which the glue shears as the rim does, k = G / t (Goland and Reissner,
    J. Appl. Mech. 11, 1944, A17-A27). InputError for one that cannot be built.
    """
    _refuse_the_other_rim(stack.boundary, fabrication)
    if stack.boundary != "elastic":
        return fabrication.glue_gap_mm
    gap = fabrication.rim_glue_modulus_MPa / stack.side_stiffness_N_per_mm3
    low, high = RIM_GAPS_MM
    if not low <= gap <= high:
        least, most = low * stack.side_stiffness_N_per_mm3, high * stack.side_stiffness_N_per_mm3
        raise InputError(
            f"fabrication.rim_glue_modulus_MPa = {fabrication.rim_glue_modulus_MPa:g}: a rim of "
            f"segment.side_stiffness_N_per_mm3 = {stack.side_stiffness_N_per_mm3:g} would be a glue line of {gap:.2g} "
            f"mm, which cannot be filled evenly; must be between {least:.3g} and {most:.3g}"
        )
    return gap


def _refuse_the_other_rim(boundary: str, fabrication: Fabrication) -> None:
    """InputError for a number of the glue beside held layers that says nothing of the stated boundary."""
    elastic = boundary == "elastic"
    unused, used = ("glue_gap_mm", "rim_glue_modulus_MPa") if elastic else ("rim_glue_modulus_MPa", "glue_gap_mm")
    value = getattr(fabrication, unused)
    if value != Fabrication.model_fields[unused].default:
        raise InputError(
            f"fabrication.{unused} = {value:g}: is not used where segment.boundary is '{boundary}'; the glue beside "
            f"held layers is stated by fabrication.{used} there"
        )


CABLE_EXIT_TURNS_DEG = {"+x": 0.0, "+y": 90.0, "-x": 180.0, "-y": 270.0}


@dataclass(frozen=True)
class ExitFrame:
    """The frame whose x axis u points towards the cable, y axis v across it.

    along, across : sizes in mm of the footprint along u and v. count_along, count_across : devices in one clamp frame.
    turn_deg : angle about z back into the axes of the device.
    """

    along: float
    across: float
    count_along: int
    count_across: int
    turn_deg: float

    def solid_in_device(self, solid: Any) -> Any:
        """A solid of this frame, turned into the axes of the device."""
        from build123d import Rot

        return Rot(0, 0, self.turn_deg) * solid

    def point_in_device(self, place: tuple[float, float]) -> tuple[float, float]:
        """A point of this frame, in the axes of the device."""
        u, v = place
        return ((u, v), (-v, u), (-u, -v), (v, -u))[round(self.turn_deg / 90.0) % 4]

    def point_in_frame(self, place: tuple[float, float]) -> tuple[float, float]:
        """A point of the device, in this frame."""
        x, y = place
        return ((x, y), (y, -x), (-x, -y), (-y, x))[round(self.turn_deg / 90.0) % 4]

    def rectangle_in_frame(self, rectangle: Rectangle) -> Rectangle:
        """A rectangle of the device, in this frame: least and largest u and v."""
        x0, x1, y0, y1 = rectangle
        return bounding_rectangle([self.point_in_frame((x0, y0)), self.point_in_frame((x1, y1))])


def exit_frame(segment: Segment, fabrication: Fabrication) -> ExitFrame:
    """The frame of fabrication.cable_exit for a stack of these sizes."""
    sizes, counts = (segment.length_mm, segment.width_mm), fabrication.array
    if fabrication.cable_exit.endswith("y"):
        sizes, counts = (sizes[1], sizes[0]), (counts[1], counts[0])
    return ExitFrame(*sizes, *counts, CABLE_EXIT_TURNS_DEG[fabrication.cable_exit])
