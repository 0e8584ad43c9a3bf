"""Solids of an array: layers that run through, islands and electrodes of each segment, grid, case and dots."""

from dataclasses import replace
from typing import Any

from geometry.array.layout import ArrayLayout, Rectangle, SegmentPlace
from geometry.assembly import CASE_WALL_MM, case_is_printable, case_solid, dot_solid
from geometry.dot import DotShape
from geometry.solids import Part, labelled_part, layer_solids, upright_box
from geometry.stack import Layer, layers


def array_parts(layout: ArrayLayout, dot_shape: DotShape) -> tuple[Part, ...]:
    """All parts of an array from the top down: layers, grid, case or base plate, and dots.

    Layers that run through keep their own names, islands are called segment-r1c2-effector. A film that runs through
    passes the grid as one sheet; other layers that the grid holds end at its walls.
    """
    parts = []
    for layer in reversed(layers(layout.segment)):
        if layout.is_cut(layer.name):
            parts += [_island_part(layout, layer, place) for place in layout.places]
        else:
            parts.append(labelled_part(layer.name, _shared_layer_solid(layout, layer), layer.material, printable=False))
    if layout.array.grid_layers:
        parts.append(_relabelled_part(labelled_part("case", grid_solid(layout), None, printable=True), "grid"))
    rim = layout.whole.model_copy(
        update={"boundary": layout.segment.boundary, "held_layers": layout.segment.held_layers}
    )
    if layout.array.grid_layers:  # its frame holds the rim
        rim = rim.model_copy(update={"boundary": "free"})
    parts.append(labelled_part("case", case_solid(rim), None, case_is_printable(rim)))
    parts.append(labelled_part("dot", dot_solid(dot_shape, layout.whole), None, printable=True))
    return tuple(parts)


def electrode_face(layout: ArrayLayout, place: SegmentPlace) -> Any:
    """The electrode of a segment on top of the film, a build123d Face without thickness."""
    from build123d import Face, Plane

    film = next(layer for layer in layers(layout.segment) if layer.name == "film")
    margin = layout.array.electrode_margin_mm
    x, y = (size - 2 * margin for size in layout.size_mm)
    face = Face.make_rect(x, y, Plane(origin=(place.x_mm, place.y_mm, film.top_mm)))
    face.label = f"{place.label}-electrode"
    return face


def _island_part(layout: ArrayLayout, layer: Layer, place: SegmentPlace) -> Part:
    from build123d import Pos

    alone = layer_solids(layout.segment, layout.segment.film.thickness_um * 1e-3)[layer.name]
    solid = Pos(place.x_mm, place.y_mm, 0) * alone
    part = labelled_part(layer.name, solid, layer.material, printable=False)
    return _relabelled_part(part, f"{place.label}-{layer.name}")


def _relabelled_part(part: Part, label: str) -> Part:
    part.solid.label = label
    return replace(part, label=label)


def _shared_layer_solid(layout: ArrayLayout, layer: Layer) -> Any:
    """The solid of a layer over the whole array, without its grooves; a compound where these cut it through."""
    solid = upright_box(*layout.half_mm, layer.bottom_mm, layer.top_mm)
    for groove in groove_solids(layout, layer):
        solid = solid - groove
    return solid


def groove_solids(layout: ArrayLayout, layer: Layer) -> list[Any]:
    """Boxes over the whole array that the grooves of a layer take away from it."""
    found, whole = [], [(-half, half) for half in layout.half_mm]
    for groove in layout.grooves(layer.name):
        bottom, half = layer.top_mm - groove.depth_mm, groove.width_mm / 2
        for axis in (0, 1):
            for seam in layout.seams(axis):
                along = list(whole)
                along[axis] = (seam - half, seam + half)
                found.append(_box((*along[0], *along[1]), bottom, layer.top_mm))
    return found


def grid_solid(layout: ArrayLayout) -> Any:
    """The stiff grid: a frame around every segment over the heights of the layers that it holds."""
    half_x, half_y = layout.half_mm
    wall = max(CASE_WALL_MM, *(gap for gap in layout.gap_mm if gap < half_x + half_y))
    grid: Any = None
    for layer in layers(layout.segment):
        if layer.name not in layout.array.grid_layers or not layout.is_cut(layer.name):
            continue
        slab = upright_box(half_x + wall, half_y + wall, layer.bottom_mm, layer.top_mm)
        for rectangle in layout.rectangles(layer.name):
            slab = slab - _box(rectangle, layer.bottom_mm, layer.top_mm)
        grid = slab if grid is None else grid + slab
    if grid is None:  # only a film that runs through: the grid clamps it from above
        film = next(layer for layer in layers(layout.segment) if layer.name == "film")
        grid = upright_box(half_x + wall, half_y + wall, film.top_mm, film.top_mm + CASE_WALL_MM)
        for rectangle in layout.rectangles("film"):
            grid = grid - _box(rectangle, film.top_mm, film.top_mm + CASE_WALL_MM)
    return grid


def _box(rectangle: Rectangle, bottom: float, top: float) -> Any:
    from build123d import Pos, Solid

    x0, x1, y0, y1 = rectangle
    return Pos(x0, y0, bottom) * Solid.make_box(x1 - x0, y1 - y0, top - bottom)
