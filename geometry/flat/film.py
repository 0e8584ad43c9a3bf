"""The film and the masks of its electrodes."""

from geometry.fabrication.parameters import Fabrication
from geometry.flat.electrodes import Metal, distinct, half_head_mm, head_length_mm
from geometry.flat.layout import FilmLayout
from geometry.flat.panel import Panel
from geometry.flat.pattern import Dimension, FlatPattern, Outline, Point
from geometry.parameters import Segment

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
    for face, metals, flip in (("top", tops, 1.0), ("bottom", [bottom], -1.0)):
        windows = tuple(_window(metal.outline, flip) for metal in metals)
        first = metals[0].rect
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
