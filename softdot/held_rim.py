"""A dot that comes down on the rim of a surface whose sides the case holds: rigid meets rigid."""

import numpy as np

from geometry.dot import DotShape
from geometry.parameters import Segment
from geometry.part_checks import covers_footprint
from geometry.stack import layers
from mesh.types import Floats
from solve.terms.contact import RigidDot

SAMPLES = 201
"""Points along each edge of the rim."""


def held_rim_warnings(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> list[str]:
    """A warning where the dot, of any shape and tilt, reaches the held rim before the final depth in mm."""
    free_mm = travel_to_rim_mm(segment, dot_shape, indentation_mm)
    if free_mm >= indentation_mm:
        return []
    return [
        f"a dot meets the held rim of the segment at an indentation of {free_mm:.3g} mm, and neither can deform: the "
        "computation will stop there or soon after; move the dot, enlarge the segment or hold fewer layers"
    ]


def travel_to_rim_mm(segment: Segment, dot_shape: DotShape, indentation_mm: float) -> float:
    """Indentation at which the dot touches the held rim of the top face, infinite where it stays clear of it."""
    stack = layers(segment)
    if segment.boundary != "clamped" or stack[-1].name not in segment.held_layers or not covers_footprint(segment):
        return np.inf
    rim, dot = _rim(segment, stack[-1].top_mm), RigidDot(dot_shape, 1.0)

    def clear(travel_mm: float) -> bool:
        return bool(dot.distance(rim, np.array([0.0, 0.0, -travel_mm]))[0].min() > 0.0)

    if clear(indentation_mm):
        return np.inf
    low, high = 0.0, indentation_mm  # what the dot has reached it does not leave on its way down
    while high - low > 1e-6 * indentation_mm:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if clear(middle) else (low, middle)
    return low


def _rim(segment: Segment, top_mm: float) -> Floats:
    """Points (n, 3) on the outline of the top face; of a slice its two ends."""
    x, y = segment.length_mm / 2.0, segment.width_mm / 2.0
    if segment.section == "plane-strain":
        return np.array([[-x, 0.0, top_mm], [x, 0.0, top_mm]])
    share = np.linspace(-1.0, 1.0, SAMPLES)
    sides = [np.column_stack([sign * x * np.ones(SAMPLES), y * share]) for sign in (-1.0, 1.0)]
    sides += [np.column_stack([x * share, sign * y * np.ones(SAMPLES)]) for sign in (-1.0, 1.0)]
    return np.column_stack([np.concatenate(sides), np.full(4 * SAMPLES, top_mm)])
