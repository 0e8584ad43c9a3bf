"""Electrodes of the film with their leads and pads, and the layout of the film seen from its cable. Millimetres.

Each electrode on the top face has a lead and a pad of its own; one electrode on the bottom face lies under all of
them. The lanes of all leads lie side by side, so that no lead of one face crosses one of the other on the tab.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise

from geometry.base import InputError
from geometry.fabrication.clamp_frame import ExitFrame, FrameLayout, exit_frame, frame_layout, held_names
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.pattern import LayerName, Outline, Point, gap_mm, rectangle, shared_area_mm2
from geometry.parameters import Electrode, Segment

Rect = tuple[float, float, float, float]


@dataclass(frozen=True)
class FilmLayout:
    """frame : the view. flange : film beyond the footprint on each side. body_end : u of the edge towards the cable.

    half_body : half the size of the body across. half_tab : half the width of the tab.
    tab_end : u where its head begins.
    electrodes : name -> u0, u1, v0, v1.
    """

    frame: ExitFrame
    flange: float
    body_end: float
    half_body: float
    half_tab: float
    tab_end: float
    electrodes: dict[str, Rect]


def film_layout(segment: Segment, fabrication: Fabrication) -> FilmLayout:
    """The film of a segment that has passed its checks. InputError for a tab that does not fit."""
    frame, case = exit_frame(segment, fabrication), frame_layout(segment, fabrication)
    flange = fabrication.film_flange_mm if "film" in held_names(segment) else 0.0
    layout = FilmLayout(
        frame=frame,
        flange=flange,
        body_end=frame.along / 2 + flange,
        half_body=frame.across / 2 + flange,
        half_tab=fabrication.tab_width_mm / 2,
        tab_end=frame.along / 2 + fabrication.tab_length_mm,
        electrodes=_electrodes(segment, frame),
    )
    _check_tab(layout, case, fabrication)
    return layout


def _check_tab(layout: FilmLayout, case: FrameLayout, fabrication: Fabrication) -> None:
    if layout.half_tab > layout.half_body + ROUNDING_MM:
        raise InputError(
            f"fabrication.tab_width_mm = {fabrication.tab_width_mm:g}: the film is only {2 * layout.half_body:g} mm "
            "wide there; must be at most that"
        )
    if layout.frame.count_along > 1:
        raise InputError(
            f"fabrication.array = {list(fabrication.array)}: with cable_exit = '{fabrication.cable_exit}' the tab of "
            "one segment would lie on the next one; put the segments side by side as seen from the cable"
        )
    needed = case.half_along - layout.frame.along / 2
    if fabrication.tab_length_mm < needed - ROUNDING_MM:
        raise InputError(
            f"fabrication.tab_length_mm = {fabrication.tab_length_mm:g}: the tab would end inside the frame, whose "
            f"outside is {needed:.3g} mm from the footprint; must be at least that"
        )


def _electrodes(segment: Segment, frame: ExitFrame) -> dict[str, Rect]:
    """Names and rectangles; without a table one electrode on the whole footprint."""
    whole = Electrode(name="film", size_mm=(segment.length_mm, segment.width_mm))
    return {one.name: _seen_from_cable(one, frame.turn_deg) for one in segment.film.electrodes or (whole,)}


def _seen_from_cable(electrode: Electrode, turn_deg: float) -> Rect:
    x, y = electrode.center_mm
    quarter = round(turn_deg / 90.0) % 4
    u, v = ((x, y), (y, -x), (-x, -y), (-y, x))[quarter]
    along, across = electrode.size_mm if quarter % 2 == 0 else electrode.size_mm[::-1]
    return (u - along / 2, u + along / 2, v - across / 2, v + across / 2)


EDGE_MM, GAP_MM, LEAST_LEAD_MM, LEAST_GAP_MM = 0.15, 0.3, 0.3, 0.2
"""Bare film beside the leads, between them, and the least that patterned metal on film can do (judged here)."""
PAD_PITCH_MM, PAD_WIDTH_MM, PAD_LENGTH_MM, TAPER_MM = 2.54, 1.5, 4.0, 2.0
"""Pads at the pitch of crimp contacts for flat film."""


@dataclass(frozen=True)
class Metal:
    """One electrode with its lead and pad.

    face : "top" or "bottom". rect : (u0, u1, v0, v1) of the electrode itself. outline : of all its metal.
    lead : its convex pieces. squares : length over width of the lead, by which its resistance counts.
    """

    name: str
    face: str
    rect: tuple[float, float, float, float]
    outline: Outline
    lead: tuple[tuple[Point, ...], ...]
    squares: float


@dataclass(frozen=True)
class Station:
    """A place of a lead: its middle and its width there."""

    u: float
    v: float
    width: float


def metals(layout: FilmLayout) -> tuple[Metal, ...]:
    """All electrodes, top ones first. InputError for leads that do not fit or come too near to other metal."""
    _refuse_near(layout)
    ordered = sorted(layout.electrodes.items(), key=lambda item: -(item[1][2] + item[1][3]))
    count = len(ordered) + 1
    lead = lead_width(layout, count)
    rects = layout.electrodes.values()
    bottom = tuple(pick(rect[k] for rect in rects) for k, pick in enumerate((min, max, min, max)))
    every = [*((name, "top", rect) for name, rect in ordered), ("common", "bottom", bottom)]
    found = tuple(
        _metal(name, face, rect, number, count, lead, layout) for number, (name, face, rect) in enumerate(every)
    )
    _refuse_shorts(found)
    return found


def lead_width(layout: FilmLayout, count: int) -> float:
    """Width of each of the leads side by side on the tab. InputError where the tab is too narrow."""
    width = (2 * layout.half_tab - 2 * EDGE_MM - (count - 1) * GAP_MM) / count
    if width < LEAST_LEAD_MM - ROUNDING_MM:
        needed = 2 * EDGE_MM + (count - 1) * GAP_MM + count * LEAST_LEAD_MM
        raise InputError(
            f"fabrication.tab_width_mm = {2 * layout.half_tab:g}: leaves {count} leads of {max(width, 0.0):.3g} mm, "
            f"below the limit of {LEAST_LEAD_MM:g} mm for patterned metal; must be at least {needed:.3g}"
        )
    return width


def half_head_mm(count: int) -> float:
    """Half the width of the head that carries this many pads."""
    return ((count - 1) * PAD_PITCH_MM + PAD_WIDTH_MM) / 2 + 2 * EDGE_MM


def head_length_mm() -> float:
    """Length of the head, from the end of the tab."""
    return TAPER_MM + PAD_LENGTH_MM + EDGE_MM


def stray_area_mm2(every: tuple[Metal, ...]) -> float:
    """Where leads of the top cross metal of the bottom: active film that is no electrode of the simulation."""
    *tops, bottom = every
    plate = rectangle("ELECTRODE-BOTTOM", bottom.rect[:2], bottom.rect[2:]).points
    return sum(shared_area_mm2(piece, one) for top in tops for piece in top.lead for one in (plate, *bottom.lead))


def _metal(
    name: str, face: str, rect: tuple[float, ...], number: int, count: int, lead: float, layout: FilmLayout
) -> Metal:
    u0, u1, v0, v1 = rect
    stations = _stations(name, rect, number, count, lead, layout)
    lower = [(s.u, s.v - s.width / 2) for s in stations]
    upper = [(s.u, s.v + s.width / 2) for s in reversed(stations)]
    layer: LayerName = "ELECTRODE-TOP" if face == "top" else "ELECTRODE-BOTTOM"
    points = distinct([(u0, v0), (u1, v0), *lower, *upper, (u1, v1), (u0, v1)])
    squares = sum(abs(b.u - a.u) / min(a.width, b.width) for a, b in pairwise(stations[:-2]))
    return Metal(name, face, (u0, u1, v0, v1), Outline(layer, points), tuple(_pieces(stations)), squares)


def _stations(
    name: str, rect: tuple[float, ...], number: int, count: int, lead: float, layout: FilmLayout
) -> list[Station]:
    """Out of the electrode, aslant to its lane, along the tab, aslant to its pad."""
    _, u1, v0, v1 = rect
    lane = layout.half_tab - EDGE_MM - lead / 2 - number * (lead + GAP_MM)
    pad = ((count - 1) / 2 - number) * PAD_PITCH_MM
    width = min(lead, v1 - v0)
    start = Station(u1, min(max(lane, v0 + width / 2), v1 - width / 2), width)
    if abs(start.v - lane) > ROUNDING_MM and layout.body_end - u1 < GAP_MM:
        raise InputError(
            f"segment.film.electrodes: '{name}' ends {layout.body_end - u1:.3g} mm from the edge of the film and "
            f"beside the tab; its lead needs {GAP_MM:g} mm there, so make it smaller or let the cable leave elsewhere"
        )
    far = layout.tab_end + TAPER_MM
    return [
        start,
        Station(layout.body_end, lane, lead),
        Station(layout.tab_end, lane, lead),
        Station(far, pad, lead),
        Station(far, pad, PAD_WIDTH_MM),
        Station(far + PAD_LENGTH_MM, pad, PAD_WIDTH_MM),
    ]


def _pieces(stations: list[Station]) -> Iterator[tuple[Point, ...]]:
    """Convex quadrilaterals between neighbouring stations."""
    for a, b in pairwise(stations):
        if b.u > a.u + ROUNDING_MM:
            (a_low, a_high), (b_low, b_high) = ((s.v - s.width / 2, s.v + s.width / 2) for s in (a, b))
            yield ((a.u, a_low), (b.u, b_low), (b.u, b_high), (a.u, a_high))


def distinct(points: list[Point]) -> tuple[Point, ...]:
    """Without points that repeat their predecessor; closed."""
    after = [*points[1:], points[0]]
    return tuple(p for p, q in zip(points, after, strict=True) if max(abs(p[0] - q[0]), abs(p[1] - q[1])) > ROUNDING_MM)


def _refuse_near(layout: FilmLayout) -> None:
    """Electrodes that touch in the simulation would be one in metal."""
    for (one, first), (other, second) in combinations(layout.electrodes.items(), 2):
        apart = max(first[0] - second[1], second[0] - first[1], first[2] - second[3], second[2] - first[3])
        if apart < LEAST_GAP_MM - ROUNDING_MM:
            raise InputError(
                f"segment.film.electrodes: '{one}' and '{other}' are {max(apart, 0.0):.3g} mm apart, below the limit "
                f"of {LEAST_GAP_MM:g} mm for patterned metal"
            )


def _refuse_shorts(every: tuple[Metal, ...]) -> None:
    """Metal of one face keeps its distance; on the tab, of both faces."""
    *tops, _ = every
    for one in tops:
        for other in tops:
            plate = rectangle("ELECTRODE-TOP", other.rect[:2], other.rect[2:]).points
            near = min((gap_mm(piece, body) for piece in one.lead for body in (plate, *other.lead)), default=1.0)
            if one is not other and near < LEAST_GAP_MM - ROUNDING_MM:
                raise InputError(
                    f"segment.film.electrodes: the lead of '{one.name}' comes within {max(near, 0.0):.2g} mm of "
                    f"'{other.name}', below the limit of {LEAST_GAP_MM:g} mm for patterned metal; arrange them side by "
                    "side across the tab"
                )
