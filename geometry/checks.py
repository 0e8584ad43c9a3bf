"""Checks that refuse impossible geometry by name before any solid is built, and warnings about doubtful presses."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import sqrt

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.assembly import case_outer_box
from geometry.dot import DotShape
from geometry.electrode_outlines import check_electrodes
from geometry.parameters import Dot, Segment
from geometry.part_checks import check_effector, check_size_range, covers_footprint, refuse_out_of_plane
from geometry.stack import Dome, bodies, layers


def check_segment(segment: Segment) -> list[str]:
    """Raise InputError for a segment that cannot be built; return warnings about one that can."""
    check_size_range(segment)
    check_effector(segment)
    check_electrodes(segment)
    _check_bonds(segment)
    return _check_held_layers(segment)


def check_press_depth(segment: Segment, indentation_mm: float) -> None:
    """Raise InputError for an indentation in mm that is as deep as the stack is high, or deeper."""
    stack = layers(segment)[-1].top_mm
    if indentation_mm >= stack:
        raise InputError(
            f"press.indentation_mm = {indentation_mm:g}: must be less than the height of the stack, {stack:g} mm"
        )


def check_slide(dot: Dot, segment: Segment, path_xy_mm: Sequence[tuple[float, float]]) -> list[str]:
    """Refuse a slide along y over a slice, where it changes nothing; return a warning about the offset of a plate."""
    for number, point in enumerate(path_xy_mm):
        refuse_out_of_plane(segment, f"press.path_xy_mm[{number}][1]", point[1])
    if dot.shape == "plate" and any(dot.offset_mm):
        return [f"dot.offset_mm = {list(dot.offset_mm)}: changes nothing, as a plate has no middle"]
    return []


def check_pushed_dot(dot: Dot, segment: Segment, path_xy_mm: tuple[tuple[float, float], ...] = ()) -> None:
    """Raise InputError for a dot pushed with a force that stands beside the segment, where nothing pushes back.

    path_xy_mm : way points of a slide in mm, from where the dot stands at rest.
    """
    halves = (segment.length_mm / 2.0, segment.width_mm / 2.0)
    for number, point in enumerate(path_xy_mm):
        for axis, half in enumerate(halves):
            if abs(dot.offset_mm[axis] + point[axis]) > half:
                raise InputError(
                    f"press.path_xy_mm[{number}] = {list(point)}: with press.force_N the dot must stay over the "
                    f"segment, between {-half:g} and {half:g} in {'xy'[axis]}"
                )
    for axis, half in enumerate(halves):
        if abs(dot.offset_mm[axis]) > half:
            raise InputError(
                f"dot.offset_mm[{axis}] = {dot.offset_mm[axis]:g}: with press.force_N the dot must stand over the "
                f"segment, between {-half:g} and {half:g}"
            )


PLACES_PER_LEG = 20
"""Number of places of the dot on each leg of a slide."""


def dots_along_slide(dot_shape: DotShape, path_xy_mm: Sequence[tuple[float, float]]) -> list[DotShape]:
    """The dot where it is pressed first and at places on its way through the waypoints (x, y) of a slide, in mm."""
    ways = np.vstack([np.zeros((1, 2)), *np.reshape(path_xy_mm, (-1, 1, 2))])
    legs = np.linspace(0.0, len(ways) - 1.0, PLACES_PER_LEG * (len(ways) - 1) + 1)
    places = np.column_stack([np.interp(legs, np.arange(len(ways)), way) for way in ways.T] + [0.0 * legs])
    return [replace(dot_shape, origin_mm=dot_shape.origin_mm + place) for place in places]


def press_warnings(
    dot_shape: DotShape, segment: Segment, indentation_mm: float, path_xy_mm: Sequence[tuple[float, float]] = ()
) -> list[str]:
    """Warnings about a press that is possible but may not be the one that is meant.

    indentation_mm : final depth. path_xy_mm : waypoints of a slide.
    """
    warnings = []
    if dot_shape.kind != "plate" and indentation_mm > dot_shape.height_mm:
        warnings.append(
            f"the indentation of {indentation_mm:.3g} mm exceeds the dot's height of "
            f"{dot_shape.height_mm:.3g} mm: the plate around the dot touches the segment too"
        )
    places = dots_along_slide(dot_shape, path_xy_mm)
    return [
        *warnings,
        *_far_dot_warnings(places, segment, indentation_mm),
        *_edge_warnings(places, segment, indentation_mm),
        *_case_warnings(dot_shape, segment, indentation_mm),
    ]


def _far_dot_warnings(places: Sequence[DotShape], segment: Segment, indentation_mm: float) -> list[str]:
    if places[0].kind != "cap":
        return []
    top = bodies(segment)[-1]
    clear = min(top.distance(_cap_centre_mm(one)) - one.radius_mm for one in places)
    if clear <= indentation_mm:
        return []
    return [
        f"the pressed dot stays {clear:.3g} mm clear of the top of the segment at rest, more than the "
        f"indentation of {indentation_mm:.3g} mm: it may not touch"
    ]


def _cap_centre_mm(dot_shape: DotShape) -> Floats:
    """Centre (3,) in mm of the ball that a cap is a part of."""
    return np.asarray(dot_shape.origin_mm + dot_shape.rotation @ [0.0, 0.0, dot_shape.radius_mm])


def _beyond_edge_mm(dot_shape: DotShape, segment: Segment, indentation_mm: float) -> float:
    """Distance in mm by which a dot at one place touches beyond an edge; 0 where it does not or may not touch at all.

    A ball touches a flat body to a radius of sqrt(R d) at a depth d (Hertz).
    """
    top, radius = bodies(segment)[-1], dot_shape.radius_mm
    ball = _cap_centre_mm(dot_shape)
    if top.distance(ball) - radius > indentation_mm:
        return 0.0
    reach = sqrt(radius * indentation_mm)
    across = np.eye(3)[: 1 if dot_shape.kind == "ridge" or segment.section == "plane-strain" else 2]
    return max(0.0, *(abs(float(axis @ ball)) + reach - top.reach(axis) for axis in across))


def _edge_warnings(places: Sequence[DotShape], segment: Segment, indentation_mm: float) -> list[str]:
    """Warn of a dot that presses or slides over an edge: sides are no contact surface, so it passes through them."""
    if places[0].kind == "plate" or isinstance(bodies(segment)[-1], Dome):
        return []
    beyond = max(_beyond_edge_mm(one, segment, indentation_mm) for one in places)
    if beyond <= 0.0:
        return []
    part = "segment" if covers_footprint(segment) else "effector"
    return [
        f"the dot presses about {beyond:.2g} mm beyond the edge of the {part}, whose sides are no contact surface: "
        "force and voltage are those of a dot that may pass through them"
    ]


def _case_warnings(dot_shape: DotShape, segment: Segment, indentation_mm: float) -> list[str]:
    """Warn of a plate that comes down on the walls of the case, which is rigid and no part of the simulation."""
    if segment.boundary == "free":
        return []
    normal = dot_shape.rotation[:, 2]
    face = float(normal @ dot_shape.origin_mm) + dot_shape.height_mm
    travel = (face - case_outer_box(segment).reach(normal)) / float(normal[2])
    if travel >= indentation_mm:
        return []
    return [
        f"the plate around the dot meets the walls of the case at an indentation of "
        f"{max(travel, 0.0):.3g} mm, before full depth: a real plate must be smaller or the walls lower"
    ]


def _check_held_layers(segment: Segment) -> list[str]:
    held = segment.held_layers
    for name in held:
        if held.count(name) > 1:
            raise InputError(f"segment.held_layers: '{name}' is named twice")
    default = Segment.model_fields["held_layers"].default
    if segment.effector is None and "effector" in held and held != default:
        raise InputError("segment.held_layers: 'effector' is named, but segment.effector is absent")
    if segment.boundary == "free":
        return []
    if not held:
        return [f"segment.held_layers is empty: boundary = '{segment.boundary}' then holds nothing, as if free"]
    if segment.effector is not None and "effector" in held and not covers_footprint(segment):
        return [
            "segment.held_layers: the effector is narrower than the segment, so that sides of it do not "
            "touch the case and are not held"
        ]
    return []


def _check_bonds(segment: Segment) -> None:
    """Refuse bonds between layers that are absent or no neighbours, and a second bond of the same two."""
    names = ["base", *(layer.name for layer in layers(segment))]
    neighbours = [set(pair) for pair in pairwise(names)]
    seen: list[set[str]] = []
    for number, bond in enumerate(segment.bonds):
        field, pair = f"segment.bonds[{number}].between", set[str](bond.between)
        if "effector" in pair and segment.effector is None:
            raise InputError(f"{field}: 'effector' is named, but segment.effector is absent")
        if pair not in neighbours:
            raise InputError(
                f"{field} = '{bond.between[0]}' and '{bond.between[1]}': must be two neighbours in the "
                f"order {', '.join(names)}"
            )
        if pair in seen:
            raise InputError(f"{field}: the bond of '{bond.between[0]}' and '{bond.between[1]}' is given twice")
        seen.append(pair)
