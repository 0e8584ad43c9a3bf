"""Outlines of electrodes in the plane of the film, and checks of them.

A circle is a regular polygon of its area. With 128 corners its second moments are those of the disc to 3e-8 (theta^4 /
180 for corners theta apart), and its edge lies within 2e-4 of the radius.
"""

from itertools import combinations
from math import cos, pi, sin, sqrt

from foundation.errors import InputError
from geometry.parameters import Electrode, Segment
from geometry.part_checks import ROUNDING_MM, refuse_out_of_plane
from geometry.polygons import Point, convex_pieces, crossing_edges, shared_area_mm2, signed_area_mm2

CIRCLE_CORNERS = 128
FAR_MM = 1e6


def rectangle_corners(x0: float, x1: float, y0: float, y1: float) -> tuple[Point, ...]:
    """Corners of a rectangle, counter-clockwise."""
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))


EVERYWHERE = rectangle_corners(-FAR_MM, FAR_MM, -FAR_MM, FAR_MM)
"""An electrode over everything, whose edges cut nothing."""


def electrode_corners(electrode: Electrode) -> tuple[Point, ...]:
    """Corners in mm, counter-clockwise."""
    x, y = electrode.center_mm
    if electrode.size_mm is not None:
        a, b = electrode.size_mm
        return rectangle_corners(x - a / 2, x + a / 2, y - b / 2, y + b / 2)
    if electrode.radius_mm is not None:
        radius = electrode.radius_mm * sqrt(2.0 * pi / (CIRCLE_CORNERS * sin(2.0 * pi / CIRCLE_CORNERS)))
        angles = [2.0 * pi * (number + 0.5) / CIRCLE_CORNERS for number in range(CIRCLE_CORNERS)]
        return tuple((x + radius * cos(angle), y + radius * sin(angle)) for angle in angles)
    corners = electrode.corners_mm or ()
    return corners if signed_area_mm2(corners) > 0.0 else corners[::-1]


def electrode_outlines(segment: Segment) -> list[tuple[Point, ...]]:
    """Corners in mm of each electrode, counter-clockwise; without any, one over everything.

    In a plane-strain slice nothing varies over y: the electrodes then reach over the whole slice, and their
    share of the width is applied with the width (see solve.whole_segment.whole_charge).
    """
    if not segment.film.electrodes:
        return [EVERYWHERE]
    found = [electrode_corners(one) for one in segment.film.electrodes]
    if segment.section == "solid":
        return found
    ends = [(min(x for x, _ in corners), max(x for x, _ in corners)) for corners in found]
    return [rectangle_corners(*xs, -FAR_MM, FAR_MM) for xs in ends]


def electrode_area_mm2(segment: Segment) -> float:
    """Area of film under all electrodes; of the whole film without any."""
    electrodes = segment.film.electrodes
    if not electrodes:
        return segment.length_mm * segment.width_mm
    return sum(signed_area_mm2(electrode_corners(one)) for one in electrodes)


def check_electrodes(segment: Segment) -> None:
    """Raise InputError for electrodes without area, that leave the film, overlap each other or share a name."""
    electrodes = segment.film.electrodes
    for number, electrode in enumerate(electrodes):
        key = f"segment.film.electrodes[{number}]"
        refuse_out_of_plane(segment, f"{key}.center_mm[1]", electrode.center_mm[1])
        if segment.section == "plane-strain" and electrode.shape != "rectangle":
            raise InputError(
                f"{key}.shape = '{electrode.shape}': segment.section = 'plane-strain' has nothing that varies over y; "
                "use 'rectangle'"
            )
        _check_corners(key, electrode)
        _check_on_film(key, electrode, segment)
    for first, second in combinations(electrodes, 2):
        if first.name == second.name:
            raise InputError(f"segment.film.electrodes: the name '{first.name}' is given twice")
        shared = _shared_mm2(first, second)
        if shared > ROUNDING_MM:
            raise InputError(f"segment.film.electrodes: '{first.name}' and '{second.name}' overlap by {shared:.3g} mm2")


def _check_corners(key: str, electrode: Electrode) -> None:
    """Refuse corners that go around no area, or around more than one."""
    corners = electrode.corners_mm
    if corners is None:
        return
    if len(corners) < 3 or abs(signed_area_mm2(corners)) < ROUNDING_MM:
        raise InputError(f"{key}.corners_mm: '{electrode.name}' has no area; give three corners or more, in order")
    crossing = crossing_edges(corners)
    if len(set(corners)) < len(corners) or crossing is not None:
        where = "a corner is given twice" if crossing is None else "edges {} and {} meet".format(*crossing)
        raise InputError(f"{key}.corners_mm: the outline of '{electrode.name}' crosses itself, {where}")


def _check_on_film(key: str, electrode: Electrode, segment: Segment) -> None:
    for axis, limit in enumerate((segment.length_mm, segment.width_mm)):
        if electrode.radius_mm is not None:
            reach = abs(electrode.center_mm[axis]) + electrode.radius_mm
        else:
            reach = max(abs(corner[axis]) for corner in electrode_corners(electrode))
        if reach > limit / 2 + ROUNDING_MM:
            raise InputError(
                f"{key}: '{electrode.name}' reaches {reach:g} mm from the "
                f"centre in {'xy'[axis]}, beyond the edge of the film at {limit / 2:g} mm"
            )


def _shared_mm2(first: Electrode, second: Electrode) -> float:
    """Area in mm2 that two electrodes share."""
    ones, others = (electrode_corners(one) for one in (first, second))
    boxes = [[(min(at), max(at)) for at in zip(*corners, strict=True)] for corners in (ones, others)]
    if any(max(a[0], b[0]) >= min(a[1], b[1]) for a, b in zip(*boxes, strict=True)):
        return 0.0
    return sum(shared_area_mm2(a, b) for a in convex_pieces(ones) for b in convex_pieces(others))
