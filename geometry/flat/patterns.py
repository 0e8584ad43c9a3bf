"""All flat patterns of a kit."""

from dataclasses import dataclass, replace

from geometry.base import InputError
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import ROUNDING_MM
from geometry.fabrication.recipes import sheet_components
from geometry.flat.electrodes import FilmLayout, Metal, film_layout, half_head_mm, lead_width, metals
from geometry.flat.pattern import FlatPattern, arrow, turned
from geometry.flat.sheets import (
    Panel,
    adhesive_patterns,
    body_dimensions,
    body_outline,
    film_pattern,
    mask_patterns,
    panel_of,
)
from geometry.parameters import Segment
from geometry.stack import layers

NAMES = {"effector": "effector", "medium1": "medium 1", "medium2": "medium 2"}


@dataclass(frozen=True)
class FlatKit:
    """patterns : all that is cut; layout, metals : of the film, for what is computed from them."""

    patterns: tuple[FlatPattern, ...]
    layout: FilmLayout
    metals: tuple[Metal, ...]


def flat_kit(segment: Segment, fabrication: Fabrication) -> FlatKit:
    """All flat patterns of a segment that has passed its checks, in the segment's axes.

    InputError for a tab, lead, electrode or cut that cannot be made, and for what does not fit the stock.
    """
    layout = film_layout(segment, fabrication)
    every = metals(layout)
    _refuse_close_neighbours(layout, len(every), fabrication)
    _refuse_wide_kerf(layout, len(every), fabrication)
    panel = panel_of(layout, len(every), fabrication)
    patterns = [
        film_pattern(segment, fabrication, layout, every, panel),
        *mask_patterns(fabrication, every, panel),
        *adhesive_patterns(segment, fabrication, layout, panel),
        *(_sheet(name, segment, fabrication, layout) for name in sheet_components(segment, fabrication)),
    ]
    placed = [turned(pattern, layout.frame.turn_deg) for pattern in patterns]
    placed[0] = _with_draw_direction(placed[0], segment, layout, panel)
    for pattern in placed:
        _refuse_unfit(pattern, fabrication)
    return FlatKit(tuple(placed), layout, every)


def _sheet(name: str, segment: Segment, fabrication: Fabrication, layout: FilmLayout) -> FlatPattern:
    layer = next(one for one in layers(segment) if one.name == name)
    cut = body_outline(name, segment, layout.frame)
    return FlatPattern(
        name=f"sheet-{name}",
        title=f"{NAMES[name].capitalize()}, cut from sheet",
        material=f"{layer.material} sheet",
        thickness_mm=layer.thickness_mm,
        count=fabrication.array[0] * fabrication.array[1],
        instruction="Cut from sheet of this thickness with a sharp knife or laser.",
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _with_draw_direction(film: FlatPattern, segment: Segment, layout: FilmLayout, panel: Panel) -> FlatPattern:
    """A double arrow on the panel beside the body, where it is cut off with the panel."""
    room = panel.half_v - layout.half_body
    place = (0.0, -layout.half_body - room / 2)
    quarter = round(layout.frame.turn_deg / 90.0) % 4
    x, y = (place, (-place[1], place[0]), (-place[0], -place[1]), (place[1], -place[0]))[quarter]
    mark = arrow("ENGRAVE", (x, y), segment.film.draw_angle_deg, 0.8 * min(room, 2 * layout.body_end))
    return replace(film, marks=(*film.marks, mark))


def _refuse_unfit(pattern: FlatPattern, fabrication: Fabrication) -> None:
    """What is larger than the stock."""
    size, stock = sorted(pattern.size_mm), sorted(fabrication.sheet_mm)
    if any(one > other + ROUNDING_MM for one, other in zip(size, stock, strict=True)):
        raise InputError(
            f"fabrication.sheet_mm = {list(fabrication.sheet_mm)}: the panel of {pattern.name} needs {size[0]:.3g} x "
            f"{size[1]:.3g} mm; take a larger sheet or a shorter tab"
        )


def _refuse_close_neighbours(layout: FilmLayout, count: int, fabrication: Fabrication) -> None:
    """Films of one array lie side by side."""
    widest = 2 * max(layout.half_body, half_head_mm(count), layout.half_tab)
    if layout.frame.count_across > 1 and (fabrication.pitch_mm or 0.0) < widest - ROUNDING_MM:
        raise InputError(
            f"fabrication.pitch_mm = {fabrication.pitch_mm}: films side by side are {widest:.3g} mm wide each; must be "
            "at least that"
        )


def _refuse_wide_kerf(layout: FilmLayout, count: int, fabrication: Fabrication) -> None:
    """The narrowest cut-outs are the leads in the masks."""
    narrowest = lead_width(layout, count)
    if narrowest < 2 * fabrication.kerf_mm:
        raise InputError(
            f"fabrication.kerf_mm = {fabrication.kerf_mm:g}: the leads of {narrowest:.3g} mm in the masks are narrower "
            "than two cuts; use a finer cutter or a wider tab"
        )
