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
from geometry.flat.film import EDGE_MM, PAD_LENGTH_MM, FilmLayout
from geometry.flat.paths import CrossSection, length_mm, quadrilaterals, ribbon, squares, turned_points
from geometry.flat.pattern import LayerName, Outline, Point, gap_mm, rectangle, shared_area_mm2

COMMON = "common"


@dataclass(frozen=True)
class Metal:
    """One electrode with its lead and pad.

    face : "top" or "bottom". rect : (u0, u1, v0, v1) around the electrode itself; plates : convex pieces of it.
    outline : of all its metal. lead : its convex pieces. length : of the lead without its pad; squares : length over
    width, by which its resistance counts. pad : its number, from the upper end as seen with the cable to the right.
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
    """All electrodes, top ones first. InputError for leads that do not fit or come too near to other metal."""
    _refuse_near(layout)
    refuse_narrow_tab(layout)
    found = _of_array(layout) if layout.lattice is not None else _of_segment(layout)
    _refuse_shorts(found, layout)
    return found


def refuse_narrow_tab(layout: FilmLayout) -> None:
    """InputError where the leads side by side on the tab are too thin."""
    if layout.lead < layout.trace_width - ROUNDING_MM:
        count, gap, least = layout.count, layout.tab_gap, layout.trace_width
        needed = 2 * EDGE_MM + (count - 1) * gap + count * least
        raise InputError(
            f"fabrication.tab_width_mm = {2 * layout.half_tab:g}: leaves {count} leads of {max(layout.lead, 0.0):.3g} "
            f"mm, below the limit of {least:g} mm for patterned metal; must be at least {needed:.3g}"
        )


def stray_areas_mm2(every: tuple[Metal, ...]) -> dict[str, float]:
    """Name -> where its lead crosses metal of the bottom: active film that is no electrode of the simulation."""
    *tops, bottom = every
    below = (*bottom.plates, *bottom.lead)
    return {top.name: sum(shared_area_mm2(piece, one) for piece in top.lead for one in below) for top in tops}


def stray_area_mm2(every: tuple[Metal, ...]) -> float:
    """Of all leads together."""
    return sum(stray_areas_mm2(every).values())


def _of_segment(layout: FilmLayout) -> tuple[Metal, ...]:
    """Electrodes anywhere on one segment: each lead runs aslant to its lane, the highest electrode has the highest."""
    ordered = sorted(layout.electrodes.items(), key=lambda item: -(item[1][2] + item[1][3]))
    bottom = _around(list(layout.electrodes.values()))
    every = [*((name, "top", rect) for name, rect in ordered), (COMMON, "bottom", bottom)]
    found = []
    for number, (name, face, rect) in enumerate(every):
        place = layout.count - 1 - number
        start = _start(name, rect, layout.lanes[place], layout)
        line = (start, (layout.body_end, layout.lanes[place]))
        width = min(layout.lead, rect[3] - rect[2])
        first = ((start[0], start[1] - width / 2), (start[0], start[1] + width / 2))
        far = length_mm(line), (layout.body_end - start[0]) / width
        found.append(_metal(name, face, rect, (_corners(rect),), _corners(rect), 2, [first], far, place, layout))
    return tuple(found)


def _start(name: str, rect: Rectangle, lane: float, layout: FilmLayout) -> Point:
    """Where a lead leaves its electrode towards the cable, as near to its lane as can be."""
    _, u1, v0, v1 = rect
    half = min(layout.lead, v1 - v0) / 2
    v = min(max(lane, v0 + half), v1 - half)
    if abs(v - lane) > ROUNDING_MM and layout.body_end - u1 < layout.tab_gap:
        raise InputError(
            f"segment.film.electrodes: '{name}' ends {layout.body_end - u1:.3g} mm from the edge of the film and "
            f"beside the tab; its lead needs {layout.tab_gap:g} mm there, so make it smaller or let the cable leave "
            "elsewhere"
        )
    return (u1, v)


def _of_array(layout: FilmLayout) -> tuple[Metal, ...]:
    """Electrodes on a lattice: out of the array by escape routing, then around corners to their lanes."""
    lattice = layout.lattice
    assert lattice is not None
    lines = {**lattice.lines, COMMON: ((layout.front_edge, layout.common_v),)}
    ordered = sorted(lines, key=lambda name: lines[name][-1][1])
    first_u = layout.front_edge + lattice.gap + lattice.width / 2
    turns = turned_points(layout.entries, layout.lanes, first_u, lattice.apart)
    found = {}
    for place, (name, turn) in enumerate(zip(ordered, turns, strict=True)):
        line = (*lines[name], *turn, (layout.body_end, layout.lanes[place]))
        sections, way = ribbon(line, lattice.width), (length_mm(line), squares(line, lattice.width))
        if name == COMMON:
            every = list(layout.electrodes.values())
            plates, corners, at = *_common_plates(layout), 2
            found[name] = _metal(name, "bottom", _around(every), plates, corners, at, sections, way, place, layout)
        else:
            rect = layout.electrodes[name]
            at = _side(rect, line[0])
            found[name] = _metal(name, "top", rect, (_corners(rect),), _corners(rect), at, sections, way, place, layout)
    return (*(found[name] for name in layout.electrodes), found[COMMON])


def _side(rect: Rectangle, start: Point) -> int:
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
    u0, u1, v0, v1 = _around(list(layout.electrodes.values()))
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
    return tuple(_corners(piece) for piece in pieces), (*corners, (u1, v1), (u0, v1))


def _refuse_narrow_bridge(width: float, layout: FilmLayout) -> None:
    if width < layout.trace_width - ROUNDING_MM:
        raise InputError(
            f"fabrication.trace_width_mm = {layout.trace_width:g}: leaves a bridge of {max(width, 0.0):.3g} mm in the "
            f"common electrode beside the traces, must be at least as wide; make the traces thinner"
        )


def _metal(
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
    """Its metal from the cross-sections of the lead on the body, which leaves before a corner of its electrode.

    way : length and squares of that lead. place : of its lane and pad, counted from the lowest.
    """
    tab = _tab_line(place, layout)
    pad = layout.pads[place]
    ends = [
        ((u, pad - layout.pad_width / 2), (u, pad + layout.pad_width / 2))
        for u in (tab[-1][0], tab[-1][0] + PAD_LENGTH_MM)
    ]
    lead = [*sections, *ribbon(tab, layout.lead), *ends]
    right, left = zip(*lead, strict=True)
    layer: LayerName = "ELECTRODE-TOP" if face == "top" else "ELECTRODE-BOTTOM"
    points = distinct([*corners[:before], *right, *reversed(left), *corners[before:]])
    return Metal(
        name=name,
        face=face,
        rect=rect,
        plates=plates,
        outline=Outline(layer, points),
        lead=tuple(quadrilaterals(lead)),
        length=way[0] + length_mm(tab),
        squares=way[1] + squares(tab, layout.lead),
        pad=layout.count - place,
    )


def _tab_line(place: int, layout: FilmLayout) -> tuple[Point, ...]:
    """From the body along the tab, then around corners to the pad."""
    first_u = layout.tab_end + EDGE_MM + layout.lead / 2
    turn = turned_points(layout.lanes, layout.pads, first_u, layout.lead + layout.tab_gap)[place]
    far = layout.tab_end + layout.taper
    return ((layout.body_end, layout.lanes[place]), *turn, (far, layout.pads[place]))


def _around(rects: list[Rectangle]) -> Rectangle:
    u0, u1, v0, v1 = zip(*rects, strict=True)
    return (min(u0), max(u1), min(v0), max(v1))


def _corners(rect: Rectangle) -> tuple[Point, ...]:
    return rectangle("ELECTRODE-TOP", rect[:2], rect[2:]).points


def distinct(points: list[Point]) -> tuple[Point, ...]:
    """Without points that repeat their predecessor; closed."""
    after = [*points[1:], points[0]]
    return tuple(p for p, q in zip(points, after, strict=True) if max(abs(p[0] - q[0]), abs(p[1] - q[1])) > ROUNDING_MM)


def _refuse_near(layout: FilmLayout) -> None:
    """Electrodes that touch in the simulation would be one in metal."""
    least = layout.trace_gap
    for (one, first), (other, second) in combinations(layout.electrodes.items(), 2):
        apart = max(first[0] - second[1], second[0] - first[1], first[2] - second[3], second[2] - first[3])
        if apart < least - ROUNDING_MM:
            where, advice = "segment.film.electrodes", ""
            if layout.lattice is not None:
                margin = layout.lattice.margin
                where, advice = f"array.electrode_margin_mm = {margin:g}", f"; give {margin + (least - apart) / 2:.3g}"
            raise InputError(
                f"{where}: '{one}' and '{other}' are {max(apart, 0.0):.3g} mm apart, below the limit of {least:g} mm "
                f"for patterned metal{advice}"
            )


def _refuse_shorts(every: tuple[Metal, ...], layout: FilmLayout) -> None:
    """Metal of one face keeps its distance; on the tab, of both faces."""
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
                    _refuse_short(one, other, gap_mm(piece, body), layout.trace_gap)


def _refuse_short(one: Metal, other: Metal, near: float, least: float) -> None:
    if near < least - ROUNDING_MM:
        raise InputError(
            f"segment.film.electrodes: the lead of '{one.name}' comes within {max(near, 0.0):.2g} mm of "
            f"'{other.name}', below the limit of {least:g} mm for patterned metal; arrange them side by "
            "side across the tab"
        )
