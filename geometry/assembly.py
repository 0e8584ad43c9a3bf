"""Solids of all parts of the assembly: layers, the rigid case, the dot with its neighbours and their plate."""

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.dot import DotShape
from geometry.dot_profile import DotProfile
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.solids import Part, labelled_part, layer_solids, sphere, upright_box, upright_cylinder
from geometry.stack import Box, Layer, layers

PLATE_THICKNESS_MM = 1.0
"""More than the 0.6 mm of an unsupported wall in stereolithography (addema.se, layerx3d.in, forgelabs.com)."""
PLATE_MARGIN_MM = 1.0
"""Plate beyond the footprint and the dots, on each side."""

Floats = NDArray[np.float64]


def dot_solid(dot_shape: DotShape, segment: Segment) -> Any:
    """The rigid dot with its plate at rest in the segment frame, as one build123d Solid."""
    from build123d import Plane, Solid

    low, high = _plate_corners(dot_shape, segment)
    face = dot_shape.height_mm
    plate = _box(low, high, face, face + PLATE_THICKNESS_MM)
    solid = plate
    if dot_shape.kind != "plate":
        dots = [_dot_in_cell(dot_shape, tip, low[1], high[1]) for tip in dot_shape.tips_mm]
        solid = plate.fuse(*dots).solid()
    rotation, origin = dot_shape.rotation, dot_shape.origin_mm
    place = Plane(origin=tuple(origin), x_dir=tuple(rotation[:, 0]), z_dir=tuple(rotation[:, 2])).location
    assert isinstance(solid, Solid)
    return place * solid


def _plate_corners(dot_shape: DotShape, segment: Segment) -> tuple[Floats, Floats]:
    """Lowest and highest x, y (2,) of the plate in the dot frame: it covers the footprint and all dots."""
    top = layers(segment)[-1].top_mm
    signs = product((-1, 1), (-1, 1), (0, 1))
    scale = np.array([segment.length_mm / 2, segment.width_mm / 2, top])
    corners = (np.array(list(signs)) * scale - dot_shape.origin_mm) @ dot_shape.rotation
    centers, reach = dot_shape.tips_mm[:, :2], dot_shape.base_diameter_mm / 2
    points = np.vstack([corners[:, :2], centers - reach, centers + reach])
    return points.min(axis=0) - PLATE_MARGIN_MM, points.max(axis=0) + PLATE_MARGIN_MM


def cap_solid(radius_mm: float, height_mm: float, foot_mm: float) -> Any:
    """One round dot as a build123d Solid: its tip at the origin, its base at z = height_mm."""
    from build123d import Pos

    equator = min(radius_mm, height_mm)
    lower = upright_box(2 * radius_mm, 2 * radius_mm, -radius_mm, equator)
    cap = ((Pos(0, 0, radius_mm) * sphere(radius_mm)) & lower).solid()
    return cap.fuse(upright_cylinder(radius_mm, equator, height_mm)).solid() if foot_mm > 0.0 else cap


def _dot_in_cell(dot_shape: DotShape, tip: Floats, low_y: float, high_y: float) -> Any:
    """One cap on its foot, one ridge over the whole plate, or a profile, in the dot frame."""
    from build123d import Pos

    if dot_shape.kind == "ridge":
        return _ridge(dot_shape, low_y, high_y)
    if dot_shape.profile is not None:
        return _revolved(dot_shape.profile)
    height = dot_shape.height_mm - tip[2]
    cap = cap_solid(dot_shape.radius_mm, height, max(0.0, height - dot_shape.radius_mm))
    return Pos(*tip) * cap


MERIDIAN_POINTS = 40


def _revolved(profile: DotProfile) -> Any:
    """A measured dot: a spline through points of its meridian, turned about its axis."""
    from build123d import Axis, Edge, Face, Solid, Wire

    meridian = [(float(radius), 0.0, float(depth)) for radius, depth in profile.meridian_mm(MERIDIAN_POINTS)]
    base = (0.0, 0.0, profile.height_mm)
    edges = [Edge.make_spline([*meridian]), Edge.make_line(meridian[-1], base), Edge.make_line(base, meridian[0])]
    return Solid.revolve(Face(Wire(edges)), 360.0, Axis.Z)


def _ridge(dot_shape: DotShape, low_y: float, high_y: float) -> Any:
    """The part of a cylinder along y that stands out of the plate, on its foot."""
    from build123d import Pos, Rot, Solid

    radius, face = dot_shape.radius_mm, dot_shape.height_mm
    equator = min(radius, face)
    lying = Pos(0, high_y, radius) * Rot(90, 0, 0) * Solid.make_cylinder(radius, high_y - low_y)
    ridge = lying & _box(np.array([-2 * radius, low_y]), np.array([2 * radius, high_y]), -radius, equator)
    if face > radius:
        foot = _box(np.array([-radius, low_y]), np.array([radius, high_y]), equator, face)
        return ridge.solid().fuse(foot).solid()
    return ridge.solid()


def _box(low: Floats, high: Floats, bottom: float, top: float) -> Any:
    from build123d import Pos, Solid

    return Pos(low[0], low[1], bottom) * Solid.make_box(high[0] - low[0], high[1] - low[1], top - bottom)


CASE_WALL_MM = 0.4
CASE_FLOOR_MM = 0.4
"""Thinnest supported wall of stereolithography, 0.4 mm (addema.se, layerx3d.in, forgelabs.com)."""
CASE_CLEARANCE_MM = 0.3
"""Gap beside layers that are not held: the smallest loose clearance of stereolithography (same sources)."""


def case_solid(segment: Segment) -> Any:
    """The tray, or for a free boundary the base plate alone, as a build123d solid.

    Walls rise to the top of the highest held layer. Beside a layer below it that is not held, the cavity is
    wider by the clearance, so that this layer can bulge.
    """
    outside = case_outer_box(segment)
    tray = upright_box(outside.half_x, outside.half_y, outside.bottom, outside.top)
    cavities = []
    for bottom, top, gap in _cavities(segment):
        # cut through the open top, so that no skin is left there
        above = top + CASE_FLOOR_MM if top == outside.top else top
        cavities.append(upright_box(segment.length_mm / 2 + gap, segment.width_mm / 2 + gap, bottom, above))
    return (tray - cavities).solid() if cavities else tray


def case_outer_box(segment: Segment) -> Box:
    """The outer box of the case, in mm."""
    cavities = _cavities(segment)
    out = CASE_WALL_MM + max((gap for _, _, gap in cavities), default=0.0)
    top = cavities[-1][1] if cavities else 0.0
    return Box(segment.length_mm / 2 + out, segment.width_mm / 2 + out, -CASE_FLOOR_MM, top)


def case_is_printable(segment: Segment) -> bool:
    """Whether every ledge of the case is at least as thick as the thinnest wall."""
    cavities = _cavities(segment)
    ledges = [top - bottom for bottom, top, gap in cavities if gap == 0.0]
    return len(cavities) < 2 or min(ledges) >= CASE_WALL_MM


def _is_held(layer: Layer, segment: Segment) -> bool:
    """Whether the case touches the sides of a layer."""
    if segment.boundary == "free" or layer.name not in segment.held_layers:
        return False
    return layer.name != "effector" or covers_footprint(segment)


def _cavities(segment: Segment) -> list[tuple[float, float, float]]:
    """Bottom, top and gap in mm of the runs of layers within the walls; none when no layer is held."""
    held = [layer for layer in layers(segment) if _is_held(layer, segment)]
    runs: list[tuple[float, float, float]] = []
    for layer in layers(segment):
        if not held or layer.top_mm > held[-1].top_mm:
            break
        gap = 0.0 if layer in held else CASE_CLEARANCE_MM
        if runs and runs[-1][2] == gap:
            runs[-1] = (runs[-1][0], layer.top_mm, gap)
        else:
            runs.append((layer.bottom_mm, layer.top_mm, gap))
    return runs


def build_parts(segment: Segment, dot_shape: DotShape) -> tuple[Part, ...]:
    """The parts from the top down: effector (if any), medium1, film, medium2, case, dot.

    They are what would be made: a plane-strain section gives the same solids, width_mm wide. The segment and
    the dot must have passed their checks.
    """
    solids = layer_solids(segment, segment.film.thickness_um * 1e-3)
    soft = [
        labelled_part(layer.name, solids[layer.name], layer.material, printable=False)
        for layer in reversed(layers(segment))
    ]
    case = labelled_part("case", case_solid(segment), None, case_is_printable(segment))
    dot = labelled_part("dot", dot_solid(dot_shape, segment), None, printable=True)
    return (*soft, case, dot)
