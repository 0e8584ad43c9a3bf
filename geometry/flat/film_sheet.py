"""Patterns of the film as it is cut, and of the masks of its electrodes."""

from geometry.fabrication.device import Device
from geometry.fabrication.parameters import Fabrication
from geometry.flat.electrodes import Metal, distinct_points
from geometry.flat.film import PAD_LENGTH_MM, FilmLayout
from geometry.flat.panel import Panel
from geometry.flat.pattern import Dimension, FlatPattern, Label, Outline
from geometry.polygons import Point

NAME_HEIGHT_MM = 0.6
MASK_THICKNESS_MM = 0.1
"""Approximate thickness of masking film."""


def film_pattern(
    device: Device, fabrication: Fabrication, layout: FilmLayout, every: tuple[Metal, ...], panel: Panel
) -> FlatPattern:
    """The pattern of the film with tab and head, both faces of metal, on its panel."""
    film = device.segment.film
    return FlatPattern(
        name="film",
        title="Film",
        material=f"{film.material} film, metal on both faces",
        thickness_mm=film.thickness_um * 1e-3,
        count=device_count(fabrication),
        instruction="Lay the draw direction of the stock along the double arrow. Cut edge and holes of the panel "
        "first, take off the metal outside of the electrodes on each face, cut the outline of the film last.",
        cuts=(*panel.cuts, film_outline(layout)),
        marks=(
            *(metal.outline for metal in every),
            panel.edge_label("TOP: this face towards the dot"),
            *_name_labels(layout, every),
        ),
        dimensions=(*panel.dimensions, *_film_dimensions(layout)),
        kerf_mm=fabrication.kerf_mm,
    )


def _name_labels(layout: FilmLayout, every: tuple[Metal, ...]) -> list[Label]:
    """Labels with the name of each electrode and the number of each pad, on the layer that is not cut."""
    u = layout.tab_end + layout.taper + PAD_LENGTH_MM / 2
    pads = [
        Label("DIMENSION", (u, layout.pads[layout.pad_count - one.pad]), f"{one.pad} {_short(one)}", NAME_HEIGHT_MM)
        for one in every
    ]
    middles = [((one.rect[0] + one.rect[1]) / 2, (one.rect[2] + one.rect[3]) / 2) for one in every]
    tops = [(_short(one), at) for one, at in zip(every, middles, strict=True) if one.face == "top"]
    return [*pads, *(Label("DIMENSION", at, name, NAME_HEIGHT_MM) for name, at in tops)]


def _short(metal: Metal) -> str:
    return metal.name.removeprefix("segment-")


def device_count(fabrication: Fabrication) -> int:
    """Number of devices in one clamp frame."""
    return fabrication.array[0] * fabrication.array[1]


def film_outline(layout: FilmLayout) -> Outline:
    """The outline of body, tab and head of the film."""
    end, half, tab, back = layout.body_end, layout.half_body, layout.half_tab, layout.back_end
    head, start, last = layout.half_head, layout.tab_end, layout.tab_end + layout.head_length
    right: list[Point] = [(-back, -half), (end, -half), (end, -tab), (start, -tab), (start, -head), (last, -head)]
    left = [(u, -v) for u, v in reversed(right)]
    return Outline("CUT", distinct_points([*right, *left]))


def mask_patterns(fabrication: Fabrication, every: tuple[Metal, ...], panel: Panel) -> tuple[FlatPattern, FlatPattern]:
    """Masks of the top and the bottom face with windows as large as the metal.

    That of the bottom is seen from below, its panel turned over about the tab.
    """
    *tops, bottom = every
    masks = []
    for face, own, flip in (("top", tops, 1.0), ("bottom", [bottom], -1.0)):
        windows = tuple(_mask_window(metal.outline, flip) for metal in own)
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
                thickness_mm=MASK_THICKNESS_MM,
                count=1,
                instruction=f"Pin it over the {face} face of the film. For film without metal: print or spray silver "
                "ink through the windows. For film with metal: draw the pattern with etch resist through them.",
                cuts=(*panel.cuts, *windows),
                marks=(panel.edge_label(f"MASK for the {face} face, this side up"),),
                dimensions=(*panel.dimensions, *sizes, *_lead_dimensions(windows[0])),
                kerf_mm=fabrication.kerf_mm,
            )
        )
    return masks[0], masks[1]


def _mask_window(outline: Outline, flip: float) -> Outline:
    """The metal as a hole, counter-clockwise after the flip too."""
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
    """The dimension of the pad's width at the far end."""
    far = max(u for u, _ in window.points)
    ends = sorted(v for u, v in window.points if u == far)
    return (Dimension((far, ends[0]), (far, ends[-1]), "y", 1.5),)
