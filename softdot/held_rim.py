"""A dot that comes down on the rim of a surface whose sides the case holds: rigid meets rigid."""

import numpy as np

from geometry.dot_shape import DotShape
from geometry.effector_checks import covers_footprint
from geometry.parameters import Segment
from geometry.stack import layers
from mesh.types import Floats


def held_rim_warnings(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> list[str]:
    """A warning where a dot of a solid section reaches the held rim before the final depth in mm."""
    free_mm = travel_to_rim_mm(segment, dot_shape)
    if free_mm >= indentation_mm:
        return []
    return [
        f"a dot meets the held rim of the segment at an indentation of {max(free_mm, 0.0):.3g} mm, and neither "
        "can deform: the computation will stop there; move the dot, enlarge the segment or hold fewer layers"
    ]


def travel_to_rim_mm(segment: Segment, dot_shape: DotShape) -> float:
    """Indentation at which a spherical cap touches the held rim of the top face, infinite when none does."""
    stack = layers(segment)
    held = segment.boundary == "clamped" and stack[-1].name in segment.held_layers
    if not held or dot_shape.kind != "cap" or segment.section != "solid" or not covers_footprint(segment):
        return np.inf
    in_dot = np.column_stack([dot_shape.centers_xy_mm, np.full(len(dot_shape.centers_xy_mm), dot_shape.radius_mm)])
    balls = dot_shape.origin_mm + in_dot @ dot_shape.rotation.T
    away = _to_rim(balls[:, :2], segment.length_mm / 2, segment.width_mm / 2)
    below = np.sqrt(np.maximum(dot_shape.radius_mm**2 - away**2, 0.0))
    reach = np.where(away < dot_shape.radius_mm, balls[:, 2] - below - stack[-1].top_mm, np.inf)
    return float(reach.min())


def _to_rim(points: Floats, half_x: float, half_y: float) -> Floats:
    """Distance (n,) of points (n, 2) inside or outside a rectangle to its outline."""
    over = np.abs(points) - [half_x, half_y]
    outside = np.linalg.norm(np.maximum(over, 0.0), axis=1)
    return np.asarray(np.where((over <= 0.0).all(axis=1), -over.max(axis=1), outside))
