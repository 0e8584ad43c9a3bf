"""Electrodes of the film with their leads and pads, seen from the cable. Millimetres.

Each electrode on the top face has a lead and a pad of its own; one electrode on the bottom face lies under all of
them. The lanes of all leads lie side by side, so that no lead of one face crosses one of the other on the tab.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from foundation.errors import InputError
from geometry.array.layout import Rectangle
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.film import METAL_EDGE_MM, PAD_LENGTH_MM, FilmLayout
from geometry.flat.paths import CrossSection, length_mm, quadrilaterals, ribbon_sections, squares, turn_points
from geometry.flat.pattern import LayerName, Outline, rectangle
from geometry.polygons import Point, bounding_rectangle, convex_pieces, polygon_gap_mm, shared_area_mm2, turning

COMMON_ELECTRODE = "common"


@dataclass(frozen=True)
class Metal:
    """One electrode with its lead and pad. Lengths in mm.

    face : "top" or "bottom". rect : (u0, u1, v0, v1) around the electrode itself; plates : convex pieces of it.
    outline : of all its metal. lead : convex pieces of the lead. length : of the lead without its pad; squares : its
    length over its width, by which its resistance counts. pad : number of the pad, from the upper end as seen with the
    cable to the right.
    """

    name: str
    face: str
    rect: Rectangle
    plates: tuple[tuple[Point, ...], ...]
    outline: Outline
    lead: tuple[tuple[Point, ...], ...]
    length: float
    squares: float
    pad: int


def metals(layout: FilmLayout) -> tuple[Metal, ...]:
    """Metal of all electrodes, top ones first. InputError for leads that do not fit or are too near to other metal."""
    _refuse_near_electrodes(layout)
    refuse_narrow_tab(layout)
    found = _array_metals(layout) if layout.lattice is not None else _segment_metals(layout)
    _refuse_shorts(found, layout)
    return found


def refuse_narrow_tab(layout: FilmLayout) -> None:
    """Raise InputError where the leads side by side on the tab are too thin."""
    if layout.lead_width < layout.trace_width - ROUNDING_MM:
        count, gap, least = layout.pad_count, layout.tab_gap, layout.trace_width
        needed = 2 * METAL_EDGE_MM + (count - 1) * gap + count * least
        raise InputError(
            f"fabrication.tab_width_mm = {2 * layout.half_tab:g}: leaves {count} leads of "
            f"{max(layout.lead_width, 0.0):.3g} mm, below the limit of {least:g} mm for patterned metal; must be at "
            f"least {needed:.3g}"
        )


def stray_areas_mm2(every: tuple[Metal, ...]) -> dict[str, float]:
    """Electrode -> area in mm2 in which its lead crosses metal of the bottom face.

    This film is active, but under no electrode of the simulation.
    """
    *tops, bottom = every
    below = (*bottom.plates, *bottom.lead)
    return {
        top.name: sum(shared_area_mm2(piece, one) for piece in top.lead for one in below)
        - sum(shared_area_mm2(piece, one) for piece in top.lead for one in top.plates)  # where it begins on the metal
        for top in tops
    }


def stray_area_mm2(every: tuple[Metal, ...]) -> float:
    """Area in mm2 in which all leads together cross metal of the bottom face."""
    return sum(stray_areas_mm2(every).values())


def _segment_metals(layout: FilmLayout) -> tuple[Metal, ...]:
    """Metal of electrodes anywhere on one segment; each lead runs aslant to its lane, the highest to the highest."""
    ordered = sorted(layout.electrodes.items(), key=lambda item: -(item[1][2] + item[1][3]))
    bottom = _rectangle_corners(_bounding_rectangle(list(layout.electrodes.values())))
    every = [*((name, "top", layout.outlines[name]) for name, _ in ordered), (COMMON_ELECTRODE, "bottom", bottom)]
    found = []
    for number, (name, face, corners) in enumerate(every):
        place = layout.pad_count - 1 - number
        kept, sections, start = _front_of(name, corners, layout.lanes[place], layout)
        way = (start, (layout.body_end, layout.lanes[place]))
        width = sections[-1][1][1] - sections[-1][0][1]
        far = length_mm(way), (layout.body_end - start[0]) / width
        rect, plates = bounding_rectangle(corners), convex_pieces(corners)
        found.append(_metal_with_lead(name, face, rect, plates, kept, len(kept), sections, far, place, layout))
    return tuple(found)


def _front_of(
    name: str, corners: Sequence[Point], lane: float, layout: FilmLayout
) -> tuple[list[Point], list[CrossSection], Point]:
    """Where a lead leaves an electrode towards the cable, as near to its lane as can be. InputError.

    The corners that stay, from the left edge of the lead around to its right one; cross-sections of the lead where it
    leaves the metal and where it is clear of it; the middle of the last.
    """
    _, u1, v0, v1 = bounding_rectangle(corners)
    front = [v for u, v in corners if u > u1 - ROUNDING_MM]
    for width in (min(layout.lead_width, v1 - v0), max(front) - min(front)):  # aslant ends take a lead as wide as they
        half = width / 2
        low, high = min(front) + half, max(front) - half
        v = min(max(lane, low), high) if high >= low else min(max((low + high) / 2, v0 + half), v1 - half)
        (right, first), (left, last) = (_front_at(corners, at) for at in (v - half, v + half))
        covered = [corners[(first + 1 + k) % len(corners)] for k in range((last - first) % len(corners))]
        if width > layout.trace_width - ROUNDING_MM and all(
            turning(right, left, one) <= ROUNDING_MM for one in covered
        ):
            break
    else:
        raise InputError(
            f"segment.film.electrodes: '{name}' has no end towards the cable that a lead of {layout.trace_width:g} mm "
            "can leave; change its corners, or let the cable leave elsewhere (fabrication.cable_exit)"
        )
    if abs(v - lane) > ROUNDING_MM and layout.body_end - u1 < layout.tab_gap:
        raise InputError(
            f"segment.film.electrodes: '{name}' ends {layout.body_end - u1:.3g} mm from the edge of the film and "
            f"beside the tab; its lead needs {layout.tab_gap:g} mm there, so make it smaller or let the cable leave "
            "elsewhere (fabrication.cable_exit)"
        )
    kept = [corners[(last + 1 + k) % len(corners)] for k in range((first - last - 1) % len(corners) + 1)]
    return kept, [(right, left), ((u1, v - half), (u1, v + half))], (u1, v)


def _front_at(corners: Sequence[Point], v: float) -> tuple[Point, int]:
    """The point of an outline that lies farthest towards the cable at a height v, and the number of its edge."""
    found = []
    for number, (a, b) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        if a[1] < b[1] and a[1] - ROUNDING_MM <= v <= b[1] + ROUNDING_MM:
            share = min(max((v - a[1]) / (b[1] - a[1]), 0.0), 1.0)
            found.append((a[0] + share * (b[0] - a[0]), number))
    u, number = max(found)
    return (u, v), number


def _array_metals(layout: FilmLayout) -> tuple[Metal, ...]:
    """Metal of electrodes on a lattice: escape routing leads out of the array, then around corners to the lanes."""
    lattice = layout.lattice
    assert lattice is not None
    lines = {**lattice.lines, COMMON_ELECTRODE: ((layout.front_edge, layout.common_v),)}
    ordered = sorted(lines, key=lambda name: lines[name][-1][1])
    first_u = layout.front_edge + lattice.gap + lattice.width / 2
    turns = turn_points(layout.entries, layout.lanes, first_u, lattice.trace_pitch)
    found = {}
    for place, (name, turn) in enumerate(zip(ordered, turns, strict=True)):
        line = (*lines[name], *turn, (layout.body_end, layout.lanes[place]))
        sections, way = ribbon_sections(line, lattice.width), (length_mm(line), squares(line, lattice.width))
        if name == COMMON_ELECTRODE:
            every = list(layout.electrodes.values())
            plates, corners, at = *_common_plates(layout), 2
            found[name] = _metal_with_lead(
                name, "bottom", _bounding_rectangle(every), plates, corners, at, sections, way, place, layout
            )
        else:
            rect = layout.electrodes[name]
            at = _lead_side(rect, line[0])
            found[name] = _metal_with_lead(
                name,
                "top",
                rect,
                (_rectangle_corners(rect),),
                _rectangle_corners(rect),
                at,
                sections,
                way,
                place,
                layout,
            )
    return (*(found[name] for name in layout.electrodes), found[COMMON_ELECTRODE])


def _lead_side(rect: Rectangle, start: Point) -> int:
    """Number of the corner, counter-clockwise, before which a lead leaves its electrode."""
    u0, u1, v0, v1 = rect
    distances = (abs(start[0] - u0), abs(start[1] - v0), abs(start[0] - u1), abs(start[1] - v1))
    return distances.index(min(distances))


def _common_plates(layout: FilmLayout) -> tuple[tuple[tuple[Point, ...], ...], tuple[Point, ...]]:
    """Convex pieces and corners of the metal under all electrodes of an array, cut away beneath traces between them.

    One sheet, with a slit from the front along every channel that holds a trace; the corner at number 1 is its lower
    front one.
    """
    lattice = layout.lattice
    assert lattice is not None
    u0, u1, v0, v1 = _bounding_rectangle(list(layout.electrodes.values()))
    pieces, corners, low = [], [(u0, v0), (u1, v0)], v0
    for file, slit in enumerate(lattice.slits):
        if slit is None:
            continue
        _refuse_narrow_bridge(slit - u0, layout)
        below, above = lattice.at(0, file)[3], lattice.at(0, file + 1)[2]
        pieces += [(u0, u1, low, below), (u0, slit, below, above)]
        corners += [(u1, below), (slit, below), (slit, above), (u1, above)]
        low = above
    pieces.append((u0, u1, low, v1))
    return tuple(_rectangle_corners(piece) for piece in pieces), (*corners, (u1, v1), (u0, v1))


def _refuse_narrow_bridge(width: float, layout: FilmLayout) -> None:
    if width < layout.trace_width - ROUNDING_MM:
        raise InputError(
            f"fabrication.trace_width_mm = {layout.trace_width:g}: leaves a bridge of {max(width, 0.0):.3g} mm in the "
            f"common electrode beside the traces, must be at least as wide; make the traces thinner"
        )


def _metal_with_lead(
    name: str,
    face: str,
    rect: Rectangle,
    plates: tuple[tuple[Point, ...], ...],
    corners: Sequence[Point],
    before: int,
    sections: list[CrossSection],
    way: tuple[float, float],
    place: int,
    layout: FilmLayout,
) -> Metal:
    """Metal of an electrode whose lead on the body has these cross-sections and leaves before a corner of it.

    way : length and squares of that lead. place : number of its lane and pad, counted from the lowest.
    """
    tab = _tab_line(place, layout)
    pad = layout.pads[place]
    ends = [
        ((u, pad - layout.pad_width / 2), (u, pad + layout.pad_width / 2))
        for u in (tab[-1][0], tab[-1][0] + PAD_LENGTH_MM)
    ]
    lead = [*sections, *ribbon_sections(tab, layout.lead_width), *ends]
    right, left = zip(*lead, strict=True)
    layer: LayerName = "ELECTRODE-TOP" if face == "top" else "ELECTRODE-BOTTOM"
    points = distinct_points([*corners[:before], *right, *reversed(left), *corners[before:]])
    return Metal(
        name=name,
        face=face,
        rect=rect,
        plates=plates,
        outline=Outline(layer, points),
        lead=tuple(quadrilaterals(lead)),
        length=way[0] + length_mm(tab),
        squares=way[1] + squares(tab, layout.lead_width),
        pad=layout.pad_count - place,
    )


def _tab_line(place: int, layout: FilmLayout) -> tuple[Point, ...]:
    """Centre line of a lead from the body along the tab, then around corners to the pad."""
    first_u = layout.tab_end + METAL_EDGE_MM + layout.lead_width / 2
    turn = turn_points(layout.lanes, layout.pads, first_u, layout.lead_width + layout.tab_gap)[place]
    far = layout.tab_end + layout.taper
    return ((layout.body_end, layout.lanes[place]), *turn, (far, layout.pads[place]))


def _bounding_rectangle(rects: list[Rectangle]) -> Rectangle:
    u0, u1, v0, v1 = zip(*rects, strict=True)
    return (min(u0), max(u1), min(v0), max(v1))


def _rectangle_corners(rect: Rectangle) -> tuple[Point, ...]:
    return rectangle("ELECTRODE-TOP", rect[:2], rect[2:]).points


def distinct_points(points: list[Point]) -> tuple[Point, ...]:
    """A closed polygon without points that repeat the next one."""
    after = [*points[1:], points[0]]
    return tuple(p for p, q in zip(points, after, strict=True) if max(abs(p[0] - q[0]), abs(p[1] - q[1])) > ROUNDING_MM)


def _refuse_near_electrodes(layout: FilmLayout) -> None:
    """Refuse electrodes that touch in the simulation, as they would be one in metal."""
    least = layout.trace_gap
    for (one, first), (other, second) in combinations(layout.electrodes.items(), 2):
        apart = max(first[0] - second[1], second[0] - first[1], first[2] - second[3], second[2] - first[3])
        if apart < least - ROUNDING_MM:
            pieces = [convex_pieces(layout.outlines[name]) for name in (one, other)]
            apart = min(polygon_gap_mm(a, b) for a in pieces[0] for b in pieces[1])
        if apart < least - ROUNDING_MM:
            where, advice = "segment.film.electrodes", "; move them apart, or state fabrication.trace_gap_mm"
            if layout.lattice is not None:
                margin = layout.lattice.margin
                where, advice = f"array.electrode_margin_mm = {margin:g}", f"; give {margin + (least - apart) / 2:.3g}"
            raise InputError(
                f"{where}: '{one}' and '{other}' are {max(apart, 0.0):.3g} mm apart, below the limit of {least:g} mm "
                f"for patterned metal{advice}"
            )


def _refuse_shorts(every: tuple[Metal, ...], layout: FilmLayout) -> None:
    """Refuse metal of one face that is too near to other metal of it."""
    *tops, _ = every
    owned = [(other, piece) for other in tops for piece in (*other.plates, *other.lead)]
    low, high = (np.array([pick(np.array(piece), axis=0) for _, piece in owned]) for pick in (np.min, np.max))
    for one in tops:
        for piece in one.lead:
            corners = np.array(piece)
            # boxes that are far apart hold polygons that are
            boxes = np.maximum(low - corners.max(axis=0), corners.min(axis=0) - high).max(axis=1)
            for number in np.flatnonzero(boxes < layout.trace_gap):
                other, body = owned[number]
                if other is not one:
                    _refuse_short(one, other, polygon_gap_mm(piece, body), layout.trace_gap)


def _refuse_short(one: Metal, other: Metal, near: float, least: float) -> None:
    if near < least - ROUNDING_MM:
        raise InputError(
            f"segment.film.electrodes: the lead of '{one.name}' comes within {max(near, 0.0):.2g} mm of "
            f"'{other.name}', below the limit of {least:g} mm for patterned metal; arrange them side by "
            "side across the tab"
        )
