"""Sheets that are cut: the film with the masks of its electrodes, adhesive pads and rings, pinned on one panel.

All flat patterns of a kit.
"""

from dataclasses import dataclass, replace

import numpy as np

from geometry.base import InputError
from geometry.fabrication.clamp_frame import WallRun, check_tab, frame_layout
from geometry.fabrication.device import Device
from geometry.fabrication.parameters import Fabrication, sheet_components
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.electrodes import Metal, distinct, metals
from geometry.flat.film import PAD_LENGTH_MM, FilmLayout, film_layout
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, Outline, Point, arrow, rectangle, turned
from geometry.flat.spacers import spacer_patterns
from geometry.parameters import Segment
from geometry.stack import Box, bodies, layers

RIM_MM, INNER_RIM_MM = 2.0, 4.0
"""Of panel around a registration hole and beside the film, and between both: room for a size on the drawing."""


@dataclass(frozen=True)
class Panel:
    """u : its ends, towards the cable. half_v : half its size across.

    holes : middles of the registration holes; hole_mm : their diameter.
    They lie on the axis of the tab, so that the panel can be turned over about it.
    """

    u: tuple[float, float]
    half_v: float
    holes: tuple[Point, Point]
    hole_mm: float

    @property
    def cuts(self) -> tuple[Outline | Circle, ...]:
        """Edge and holes."""
        edge = rectangle("CUT", self.u, (-self.half_v, self.half_v))
        return (edge, *(Circle("CUT", place, self.hole_mm / 2) for place in self.holes))

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Of the edge, and from hole to hole."""
        low, first, second = -self.half_v, *self.holes
        return (
            Dimension((self.u[0], low), (self.u[1], low), "x", -4.5),
            Dimension(first, second, "x", -self.half_v - 2.5),
            Dimension((self.u[0], low), (self.u[0], self.half_v), "y", -4.5),
            Dimension((first[0], -self.hole_mm / 2), (first[0], self.hole_mm / 2), "y", -4.5),
        )

    def words(self, text: str) -> Label:
        """A line along the upper edge, which shows which face is up and which way round."""
        return Label("ENGRAVE", ((self.u[0] + self.u[1]) / 2, self.half_v - 0.9), text)


def panel_of(layout: FilmLayout, fabrication: Fabrication) -> Panel:
    """The panel around a film."""
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    zone = hole / 2 + RIM_MM
    first = -layout.back_end - INNER_RIM_MM - hole / 2
    last = layout.tab_end + layout.head_length + INNER_RIM_MM + hole / 2
    half_v = max(layout.half_body, layout.half_head) + 2 * RIM_MM
    return Panel((first - zone, last + zone), half_v, ((first, 0.0), (last, 0.0)), hole)


NAME_MM = 0.6
MASK_MM = 0.1
"""Thickness of masking film, about."""


def film_pattern(
    device: Device, fabrication: Fabrication, layout: FilmLayout, every: tuple[Metal, ...], panel: Panel
) -> FlatPattern:
    """Film with tab and head, both faces of metal, on its panel."""
    film = device.segment.film
    return FlatPattern(
        name="film",
        title="Film",
        material=f"{film.material} film, metal on both faces",
        thickness_mm=film.thickness_um * 1e-3,
        count=devices(fabrication),
        instruction="Lay the draw direction of the stock along the double arrow. Cut edge and holes of the panel "
        "first, take off the metal outside of the electrodes on each face, cut the outline of the film last.",
        cuts=(*panel.cuts, film_outline(layout)),
        marks=(
            *(metal.outline for metal in every),
            panel.words("TOP: this face towards the dot"),
            *(_names(layout, every) if device.is_array else ()),
        ),
        dimensions=(*panel.dimensions, *_film_dimensions(layout)),
        kerf_mm=fabrication.kerf_mm,
    )


def _names(layout: FilmLayout, every: tuple[Metal, ...]) -> list[Label]:
    """What each electrode is called and the number of each pad, beside the sizes that are not cut."""
    u = layout.tab_end + layout.taper + PAD_LENGTH_MM / 2
    pads = [Label("DIMENSION", (u, layout.pads[layout.count - one.pad]), f"{one.pad}", NAME_MM) for one in every]
    middles = [((one.rect[0] + one.rect[1]) / 2, (one.rect[2] + one.rect[3]) / 2) for one in every]
    tops = [
        (one.name.removeprefix("segment-"), at) for one, at in zip(every, middles, strict=True) if one.face == "top"
    ]
    return [*pads, *(Label("DIMENSION", at, name, NAME_MM) for name, at in tops)]


def devices(fabrication: Fabrication) -> int:
    """How many stand in one clamp frame."""
    return fabrication.array[0] * fabrication.array[1]


def film_outline(layout: FilmLayout) -> Outline:
    """Body, tab and head."""
    end, half, tab, back = layout.body_end, layout.half_body, layout.half_tab, layout.back_end
    head, start, last = layout.half_head, layout.tab_end, layout.tab_end + layout.head_length
    right: list[Point] = [(-back, -half), (end, -half), (end, -tab), (start, -tab), (start, -head), (last, -head)]
    left = [(u, -v) for u, v in reversed(right)]
    return Outline("CUT", distinct([*right, *left]))


def mask_patterns(fabrication: Fabrication, every: tuple[Metal, ...], panel: Panel) -> tuple[FlatPattern, FlatPattern]:
    """Windows of the size of the metal; that of the bottom is seen from below, its panel turned over about the tab."""
    *tops, bottom = every
    masks = []
    for face, own, flip in (("top", tops, 1.0), ("bottom", [bottom], -1.0)):
        windows = tuple(_window(metal.outline, flip) for metal in own)
        first = own[0].rect
        sizes = (
            Dimension((first[0], flip * first[2]), (first[1], flip * first[2]), "x", -2.0 * flip),
            Dimension((first[0], flip * first[2]), (first[0], flip * first[3]), "y", -2.0),
        )
        masks.append(
            FlatPattern(
                name=f"mask-{face}",
                title=f"Mask for the {face} electrode",
                material="low-tack masking film",
                thickness_mm=MASK_MM,
                count=1,
                instruction=f"Pin it over the {face} face of the film. For film without metal: print or spray silver "
                "ink through the windows. For film with metal: draw the pattern with etch resist through them.",
                cuts=(*panel.cuts, *windows),
                marks=(panel.words(f"MASK for the {face} face, this side up"),),
                dimensions=(*panel.dimensions, *sizes, *_lead_dimensions(windows[0])),
                kerf_mm=fabrication.kerf_mm,
            )
        )
    return masks[0], masks[1]


def _window(outline: Outline, flip: float) -> Outline:
    """The metal as a hole; counter-clockwise after the flip too."""
    points = tuple((u, flip * v) for u, v in outline.points)
    return Outline("CUT", points if flip > 0.0 else points[::-1], hole=True)


def _film_dimensions(layout: FilmLayout) -> tuple[Dimension, ...]:
    end, half, tab, back = layout.body_end, layout.half_body, layout.half_tab, layout.back_end
    head, start, last = layout.half_head, layout.tab_end, layout.tab_end + layout.head_length
    middle = (end + start) / 2
    return (
        Dimension((-back, half), (end, half), "x", 1.2),
        Dimension((end, tab), (start, tab), "x", 2.2),
        Dimension((start, head), (last, head), "x", 0.8),
        Dimension((-back, -half), (-back, half), "y", -1.4),
        Dimension((middle, -tab), (middle, tab), "y", 1.2),
        Dimension((last, -head), (last, head), "y", 2.0),
    )


def _lead_dimensions(window: Outline) -> tuple[Dimension, ...]:
    """Width of the pad at the far end."""
    far = max(u for u, _ in window.points)
    ends = sorted(v for u, v in window.points if u == far)
    return (Dimension((far, ends[0]), (far, ends[-1]), "y", 1.5),)


PAD = "Bonds {where}: rub it onto the lower one, peel off the liner."
RING = "Rub it onto the flange of the film, {where}; the {left} free."


JOINTS = (
    ("base", "medium2", "the frame and medium 2"),
    ("medium2", "film", "medium 2 and the film"),
    ("film", "medium1", "the film and medium 1"),
    ("medium1", "effector", "medium 1 and the effector"),
)


def adhesive_patterns(device: Device, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    """One pattern for each bonded face from the base up, and for a film with a flange two rings on its panel.

    A face between a layer that runs through and islands is bonded at the islands.
    """
    present = {layer.name for layer in layers(device.segment)}
    found = []
    for low, high, where in JOINTS:
        if high in present:
            own = high if device.pieces(high) >= device.pieces(low if low != "base" else high) else low
            cut, count = body_outline(own, device, layout), devices(fabrication) * device.pieces(own)
            title = f"Adhesive: {NAMES.get(low, low)} to {NAMES.get(high, high)}"
            found.append(_pad(f"{low}-{high}", title, cut, where, count, fabrication))
    return found + (_rings(device, fabrication, layout, panel) if layout.flange > 0.0 else [])


def body_outline(name: str, device: Device, layout: FilmLayout) -> Outline | Circle:
    """The outline of one piece of a layer on CUT, seen from its cable."""
    source = device.source(name)
    body, halves = bodies(source)[-1], (source.length_mm / 2, source.width_mm / 2)
    if name == "effector":
        if not isinstance(body, Box):
            return Circle("CUT", (0.0, 0.0), float(body.reach(np.array([1.0, 0.0, 0.0]))), hole=False)
        halves = (body.half_x, body.half_y)
    u0, u1, v0, v1 = layout.frame.seen((-halves[0], halves[0], -halves[1], halves[1]))
    return rectangle("CUT", (u0, u1), (v0, v1))


def body_dimensions(cut: Outline | Circle) -> tuple[Dimension, ...]:
    """Both sizes of a rectangle, or the diameter."""
    if isinstance(cut, Circle):
        return (Dimension((-cut.radius, 0.0), (cut.radius, 0.0), "x", -cut.radius - 1.5),)
    (u0, v0), _, (u1, v1), _ = cut.points
    return (Dimension((u0, v0), (u1, v0), "x", -1.5), Dimension((u0, v0), (u0, v1), "y", -1.5))


def _pad(name: str, title: str, cut: Outline | Circle, where: str, count: int, fabrication: Fabrication) -> FlatPattern:
    return FlatPattern(
        name=f"adhesive-{name}",
        title=title,
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=count,
        instruction=PAD.format(where=where),
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _rings(device: Device, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    case = frame_layout(device, fabrication)
    faces: list[tuple[str, WallRun, str]] = []
    if case.body is not None:
        faces.append(("lower", case.body, "on the face towards the body of the frame"))
    if case.ring:
        faces.append(("upper", case.ring[0], "on the face towards the ring of the frame"))
    return [
        _ring(name, run, where, fabrication, layout, panel) for name, run, where in faces if run.gap < layout.flange
    ]


def _ring(
    name: str, run: WallRun, where: str, fabrication: Fabrication, layout: FilmLayout, panel: Panel
) -> FlatPattern:
    """As wide as the film, with the openings of the frame as windows; between them it bonds the film to a grid."""
    end, half, back = layout.body_end, layout.half_body, layout.back_end
    gap = run.gap
    windows = [((u0 - gap, u1 + gap), (v0 - gap, v1 + gap)) for u0, u1, v0, v1 in run.feet]
    (inner_u, inner_v), several = windows[0], len(windows) > 1
    rub = RING.format(
        where=where, left="windows leave the pressed parts" if several else "window leaves the pressed part"
    )
    return FlatPattern(
        name=f"adhesive-flange-{name}",
        title=f"Adhesive: {name} ring on the film's flange",
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=devices(fabrication),
        instruction=f"Pin its panel onto that of the film before the film is cut out. {rub}",
        cuts=(
            *panel.cuts,
            rectangle("CUT", (-back, end), (-half, half)),
            *(rectangle("CUT", u, v, hole=True) for u, v in windows),
        ),
        marks=(panel.words(f"RING, {name}"),),
        dimensions=(
            *panel.dimensions,
            Dimension((-back, half), (end, half), "x", 1.2),
            Dimension((-back, -half), (-back, half), "y", -1.4),
            Dimension((inner_u[0], inner_v[0]), (inner_u[1], inner_v[0]), "x", -2.2),
            Dimension((inner_u[1], inner_v[0]), (inner_u[1], inner_v[1]), "y", 2.2),
        ),
        kerf_mm=fabrication.kerf_mm,
    )


NAMES = {"effector": "effector", "medium1": "medium 1", "medium2": "medium 2"}


@dataclass(frozen=True)
class FlatKit:
    """patterns : all that is cut; layout, metals : of the film, for what is computed from them."""

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
        *(_sheet(name, device, fabrication, layout) for name in sheet_components(device.segment, fabrication)),
    ]
    placed = [turned(pattern, layout.frame.turn_deg) for pattern in patterns]
    placed[0] = _with_draw_direction(placed[0], device.segment, layout, panel)
    placed += spacer_patterns(device, fabrication)
    for pattern in placed:
        _refuse_unfit(pattern, fabrication)
    return FlatKit(tuple(placed), layout, every)


def _sheet(name: str, device: Device, fabrication: Fabrication, layout: FilmLayout) -> FlatPattern:
    layer = next(one for one in layers(device.segment) if one.name == name)
    if device.layout.grooves(name):
        raise InputError(
            f"array.grooves: names '{name}', which is cut from sheet, and grooves are formed by a mould; give "
            f"fabrication.routes.{name} = 'cast' and a material with a recipe"
        )
    cut = body_outline(name, device, layout)
    return FlatPattern(
        name=f"sheet-{name}",
        title=f"{NAMES[name].capitalize()}, cut from sheet",
        material=f"{layer.material} sheet",
        thickness_mm=layer.thickness_mm,
        count=devices(fabrication) * device.pieces(name),
        instruction="Cut from sheet of this thickness with a sharp knife or laser.",
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _with_draw_direction(film: FlatPattern, segment: Segment, layout: FilmLayout, panel: Panel) -> FlatPattern:
    """A double arrow on the panel beside the tab or the body, where it is cut off with the panel."""
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


def _refuse_close_neighbours(layout: FilmLayout, fabrication: Fabrication) -> None:
    """Films of one clamp frame lie side by side."""
    widest = 2 * max(layout.half_body, layout.half_head)
    if layout.frame.count_across > 1 and (fabrication.pitch_mm or 0.0) < widest - ROUNDING_MM:
        raise InputError(
            f"fabrication.pitch_mm = {fabrication.pitch_mm}: films side by side are {widest:.3g} mm wide each; must be "
            "at least that"
        )


def _refuse_wide_kerf(layout: FilmLayout, fabrication: Fabrication) -> None:
    """The narrowest cut-outs are the leads in the masks."""
    narrowest = layout.lead if layout.lattice is None else min(layout.lead, layout.trace_width)
    if narrowest < 2 * fabrication.kerf_mm:
        raise InputError(
            f"fabrication.kerf_mm = {fabrication.kerf_mm:g}: the leads of {narrowest:.3g} mm in the masks are narrower "
            "than two cuts; use a finer cutter or a wider tab"
        )
