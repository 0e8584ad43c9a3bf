"""Sizes of the film, seen from its cable: u towards the cable, v across. Lengths in millimetres."""

from dataclasses import dataclass

from geometry.errors import InputError
from geometry.fabrication.exit_frame import ExitFrame, exit_frame
from geometry.fabrication.frame_layout import FrameLayout, frame_layout, held_names
from geometry.fabrication.limits import ROUNDING_MM
from geometry.fabrication.parameters import Fabrication
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
