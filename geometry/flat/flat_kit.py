"""All flat patterns of a kit, cut from film, adhesive and sheet; refused where one is larger than the stock."""

from dataclasses import dataclass, replace

from foundation.errors import InputError
from geometry.fabrication.device import Device
from geometry.fabrication.frame_checks import check_tab
from geometry.fabrication.frame_layout import frame_layout
from geometry.fabrication.parameters import Fabrication, sheet_components
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.adhesive import LAYER_NAMES, adhesive_patterns, body_dimensions, body_outline
from geometry.flat.electrodes import Metal, metals
from geometry.flat.film import FilmLayout, film_layout
from geometry.flat.film_sheet import device_count, film_pattern, mask_patterns
from geometry.flat.panel import Panel, panel_of
from geometry.flat.pattern import FlatPattern, arrow, rotated_pattern
from geometry.flat.spacers import spacer_patterns
from geometry.parameters import Segment
from geometry.stack import layers


@dataclass(frozen=True)
class FlatKit:
    """All flat patterns of a kit. layout, metals : of the film, for what is computed from them."""

    patterns: tuple[FlatPattern, ...]
    layout: FilmLayout
    metals: tuple[Metal, ...]


def flat_kit(device: Device, fabrication: Fabrication) -> FlatKit:
    """All flat patterns of a device that has passed its checks, in its axes.

    InputError for a tab, lead, electrode or cut that cannot be made, and for what does not fit the stock.
    """
    layout = film_layout(device, fabrication)
    check_tab(layout, frame_layout(device, fabrication), fabrication)
    every = metals(layout)
    _refuse_close_neighbours(layout, fabrication)
    _refuse_wide_kerf(layout, fabrication)
    panel = panel_of(layout, fabrication)
    patterns = [
        film_pattern(device, fabrication, layout, every, panel),
        *mask_patterns(fabrication, every, panel),
        *adhesive_patterns(device, fabrication, layout, panel),
        *(_sheet_pattern(name, device, fabrication, layout) for name in sheet_components(device.segment, fabrication)),
    ]
    placed = [rotated_pattern(pattern, layout.frame.turn_deg) for pattern in patterns]
    placed[0] = _with_draw_direction(placed[0], device.segment, layout, panel)
    placed += spacer_patterns(device, fabrication)
    for pattern in placed:
        _refuse_too_large(pattern, fabrication)
    return FlatKit(tuple(placed), layout, every)


def _sheet_pattern(name: str, device: Device, fabrication: Fabrication, layout: FilmLayout) -> FlatPattern:
    layer = next(one for one in layers(device.segment) if one.name == name)
    if device.layout.grooves(name):
        raise InputError(
            f"array.grooves: names '{name}', which is cut from sheet, and grooves are formed by a mould; give "
            f"fabrication.routes.{name} = 'cast' and a material with a recipe"
        )
    cut = body_outline(name, device, layout)
    return FlatPattern(
        name=f"sheet-{name}",
        title=f"{LAYER_NAMES[name].capitalize()}, cut from sheet",
        material=f"{layer.material} sheet",
        thickness_mm=layer.thickness_mm,
        count=device_count(fabrication) * device.piece_count(name),
        instruction="Cut from sheet of this thickness with a sharp knife or laser.",
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _with_draw_direction(film: FlatPattern, segment: Segment, layout: FilmLayout, panel: Panel) -> FlatPattern:
    """The film's pattern with a double arrow on the panel beside the tab or the body, to be cut off with it."""
    room = panel.half_v - layout.half_body
    place = (0.0, -layout.half_body - room / 2)
    quarter = round(layout.frame.turn_deg / 90.0) % 4
    x, y = (place, (-place[1], place[0]), (-place[0], -place[1]), (place[1], -place[0]))[quarter]
    mark = arrow("ENGRAVE", (x, y), segment.film.draw_angle_deg, 0.8 * min(room, 2 * layout.body_end))
    return replace(film, marks=(*film.marks, mark))


def _refuse_too_large(pattern: FlatPattern, fabrication: Fabrication) -> None:
    """Refuse a pattern that is larger than the stock."""
    size, stock = sorted(pattern.size_mm), sorted(fabrication.sheet_mm)
    if any(one > other + ROUNDING_MM for one, other in zip(size, stock, strict=True)):
        raise InputError(
            f"fabrication.sheet_mm = {list(fabrication.sheet_mm)}: the panel of {pattern.name} needs {size[0]:.3g} x "
            f"{size[1]:.3g} mm; take a larger sheet or a shorter tab"
        )


def _refuse_close_neighbours(layout: FilmLayout, fabrication: Fabrication) -> None:
    """Refuse films of one clamp frame that do not fit side by side."""
    widest = 2 * max(layout.half_body, layout.half_head)
    if layout.frame.count_across > 1 and (fabrication.pitch_mm or 0.0) < widest - ROUNDING_MM:
        raise InputError(
            f"fabrication.pitch_mm = {fabrication.pitch_mm}: films side by side are {widest:.3g} mm wide each; must be "
            "at least that"
        )


def _refuse_wide_kerf(layout: FilmLayout, fabrication: Fabrication) -> None:
    """Refuse a kerf that is too wide for the narrowest cut-outs, the leads in the masks."""
    narrowest = layout.lead_width if layout.lattice is None else min(layout.lead_width, layout.trace_width)
    if narrowest < 2 * fabrication.kerf_mm:
        raise InputError(
            f"fabrication.kerf_mm = {fabrication.kerf_mm:g}: the leads of {narrowest:.3g} mm in the masks are narrower "
            "than two cuts; use a finer cutter or a wider tab"
        )
