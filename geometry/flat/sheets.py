"""Sheets that are cut: the film with the masks of its electrodes, adhesive pads and rings, pinned on one panel.

All flat patterns of a kit.
"""

from dataclasses import dataclass, replace

import numpy as np

from geometry.base import InputError
from geometry.fabrication.clamp_frame import ExitFrame, frame_layout
from geometry.fabrication.parameters import Fabrication, sheet_components
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.electrodes import (
    FilmLayout,
    Metal,
    distinct,
    film_layout,
    half_head_mm,
    head_length_mm,
    lead_width,
    metals,
)
from geometry.flat.pattern import Circle, Dimension, FlatPattern, Label, Outline, Point, arrow, rectangle, turned
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


def panel_of(layout: FilmLayout, count: int, fabrication: Fabrication) -> Panel:
    """The panel around a film with this many pads."""
    hole = fabrication.pin_diameter_mm + 2 * fabrication.pin_clearance_mm
    zone = hole / 2 + RIM_MM
    first = -layout.body_end - INNER_RIM_MM - hole / 2
    last = layout.tab_end + head_length_mm() + INNER_RIM_MM + hole / 2
    half_v = max(layout.half_body, half_head_mm(count), layout.half_tab) + 2 * RIM_MM
    return Panel((first - zone, last + zone), half_v, ((first, 0.0), (last, 0.0)), hole)


MASK_MM = 0.1
"""Thickness of masking film, about."""


def film_pattern(
    segment: Segment, fabrication: Fabrication, layout: FilmLayout, every: tuple[Metal, ...], panel: Panel
) -> FlatPattern:
    """Film with tab and head, both faces of metal, on its panel."""
    count = len(every)
    return FlatPattern(
        name="film",
        title="Film",
        material=f"{segment.film.material} film, metal on both faces",
        thickness_mm=segment.film.thickness_um * 1e-3,
        count=fabrication.array[0] * fabrication.array[1],
        instruction="Lay the draw direction of the stock along the double arrow. Cut edge and holes of the panel "
        "first, take off the metal outside of the electrodes on each face, cut the outline of the film last.",
        cuts=(*panel.cuts, film_outline(layout, count)),
        marks=(*(metal.outline for metal in every), panel.words("TOP: this face towards the dot")),
        dimensions=(*panel.dimensions, *_film_dimensions(layout, count)),
        kerf_mm=fabrication.kerf_mm,
    )


def film_outline(layout: FilmLayout, count: int) -> Outline:
    """Body, tab and head that carries this many pads."""
    end, half, tab = layout.body_end, layout.half_body, layout.half_tab
    head, start, last = max(half_head_mm(count), tab), layout.tab_end, layout.tab_end + head_length_mm()
    right: list[Point] = [(-end, -half), (end, -half), (end, -tab), (start, -tab), (start, -head), (last, -head)]
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


def _film_dimensions(layout: FilmLayout, count: int) -> tuple[Dimension, ...]:
    end, half, tab = layout.body_end, layout.half_body, layout.half_tab
    head, start, last = max(half_head_mm(count), tab), layout.tab_end, layout.tab_end + head_length_mm()
    middle = (end + start) / 2
    return (
        Dimension((-end, half), (end, half), "x", 1.2),
        Dimension((end, tab), (start, tab), "x", 2.2),
        Dimension((start, head), (last, head), "x", 0.8),
        Dimension((-end, -half), (-end, half), "y", -1.4),
        Dimension((middle, -tab), (middle, tab), "y", 1.2),
        Dimension((last, -head), (last, head), "y", 2.0),
    )


def _lead_dimensions(window: Outline) -> tuple[Dimension, ...]:
    """Width of the pad at the far end."""
    far = max(u for u, _ in window.points)
    ends = sorted(v for u, v in window.points if u == far)
    return (Dimension((far, ends[0]), (far, ends[-1]), "y", 1.5),)


PAD = "Bonds {where}: rub it onto the lower one, peel off the liner."
RING = "Rub it onto the flange of the film, {where}; the window leaves the pressed part free."


def adhesive_patterns(
    segment: Segment, fabrication: Fabrication, layout: FilmLayout, panel: Panel
) -> list[FlatPattern]:
    """One pad for each bonded face from the base up, and for a film with a flange two rings on its panel."""
    frame = layout.frame
    whole = body_outline("medium2", segment, frame)
    foot = body_outline("effector", segment, frame)
    joints = [
        ("base-medium2", "Adhesive: base to medium 2", whole, "the frame and medium 2"),
        ("medium2-film", "Adhesive: medium 2 to film", whole, "medium 2 and the film"),
        ("film-medium1", "Adhesive: film to medium 1", whole, "the film and medium 1"),
    ]
    if segment.effector is not None:
        joints.append(("medium1-effector", "Adhesive: medium 1 to effector", foot, "medium 1 and the effector"))
    found = [_pad(name, title, cut, where, fabrication) for name, title, cut, where in joints]
    return found + (_rings(segment, fabrication, layout, panel) if layout.flange > 0.0 else [])


def body_outline(name: str, segment: Segment, frame: ExitFrame) -> Outline | Circle:
    """The outline of a layer on CUT, seen from its cable."""
    body = bodies(segment)[-1]
    halves = (segment.length_mm / 2, segment.width_mm / 2)
    if name == "effector" and segment.effector is not None:
        if not isinstance(body, Box):
            return Circle("CUT", (0.0, 0.0), float(body.reach(np.array([1.0, 0.0, 0.0]))), hole=False)
        halves = (body.half_x, body.half_y)
    along, across = halves if frame.turn_deg in (0.0, 180.0) else halves[::-1]
    return rectangle("CUT", (-along, along), (-across, across))


def body_dimensions(cut: Outline | Circle) -> tuple[Dimension, ...]:
    """Both sizes of a rectangle, or the diameter."""
    if isinstance(cut, Circle):
        return (Dimension((-cut.radius, 0.0), (cut.radius, 0.0), "x", -cut.radius - 1.5),)
    (u0, v0), _, (u1, v1), _ = cut.points
    return (Dimension((u0, v0), (u1, v0), "x", -1.5), Dimension((u0, v0), (u0, v1), "y", -1.5))


def _pad(name: str, title: str, cut: Outline | Circle, where: str, fabrication: Fabrication) -> FlatPattern:
    return FlatPattern(
        name=f"adhesive-{name}",
        title=title,
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=fabrication.array[0] * fabrication.array[1],
        instruction=PAD.format(where=where),
        cuts=(cut,),
        dimensions=body_dimensions(cut),
        kerf_mm=fabrication.kerf_mm,
    )


def _rings(segment: Segment, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> list[FlatPattern]:
    case = frame_layout(segment, fabrication)
    faces = []
    if case.body is not None:
        faces.append(("lower", case.body.gap, "on the face towards the body of the frame"))
    if case.ring:
        faces.append(("upper", case.ring[0].gap, "on the face towards the ring of the frame"))
    return [_ring(name, gap, where, fabrication, layout, panel) for name, gap, where in faces if gap < layout.flange]


def _ring(name: str, gap: float, where: str, fabrication: Fabrication, layout: FilmLayout, panel: Panel) -> FlatPattern:
    end, half = layout.body_end, layout.half_body
    inner_u, inner_v = layout.frame.along / 2 + gap, layout.frame.across / 2 + gap
    return FlatPattern(
        name=f"adhesive-flange-{name}",
        title=f"Adhesive: {name} ring on the film's flange",
        material="double-sided adhesive sheet",
        thickness_mm=fabrication.adhesive_thickness_mm,
        count=fabrication.array[0] * fabrication.array[1],
        instruction=f"Pin its panel onto that of the film before the film is cut out. {RING.format(where=where)}",
        cuts=(
            *panel.cuts,
            rectangle("CUT", (-end, end), (-half, half)),
            rectangle("CUT", (-inner_u, inner_u), (-inner_v, inner_v), hole=True),
        ),
        marks=(panel.words(f"RING, {name}"),),
        dimensions=(
            *panel.dimensions,
            Dimension((-end, half), (end, half), "x", 1.2),
            Dimension((-end, -half), (-end, half), "y", -1.4),
            Dimension((-inner_u, -inner_v), (inner_u, -inner_v), "x", -2.2),
            Dimension((inner_u, -inner_v), (inner_u, inner_v), "y", 2.2),
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
