"""The rigid case: a tray whose walls touch the held layers only."""

from typing import Any

from geometry.bodies import Box
from geometry.effector_checks import covers_footprint
from geometry.layer_solids import upright_box
from geometry.parameters import Segment
from geometry.stack import Layer, layers

WALL_MM = 0.4
FLOOR_MM = 0.4
"""Thinnest supported wall of stereolithography, 0.4 mm (addema.se, layerx3d.in, forgelabs.com)."""
CLEARANCE_MM = 0.3
"""Beside layers that are not held: the smallest loose clearance of stereolithography (same sources)."""


def case_solid(segment: Segment) -> Any:
    """The tray, or for a free boundary the base plate alone, as a build123d solid.

    Walls rise to the top of the highest held layer. Beside a layer below it that is not held, the cavity is
    wider by the clearance, so that this layer can bulge.
    """
    outside = case_outside(segment)
    tray = upright_box(outside.half_x, outside.half_y, outside.bottom, outside.top)
    for bottom, top, gap in _cavities(segment):
        # cut through the open top, so that no skin is left there
        above = top + FLOOR_MM if top == outside.top else top
        half_x, half_y = segment.length_mm / 2 + gap, segment.width_mm / 2 + gap
        tray = (tray - upright_box(half_x, half_y, bottom, above)).solid()
    return tray


def case_outside(segment: Segment) -> Box:
    """The outer box of the case, in mm."""
    cavities = _cavities(segment)
    out = WALL_MM + max((gap for _, _, gap in cavities), default=0.0)
    top = cavities[-1][1] if cavities else 0.0
    return Box(segment.length_mm / 2 + out, segment.width_mm / 2 + out, -FLOOR_MM, top)


def case_is_printable(segment: Segment) -> bool:
    """Whether every ledge of the case is at least as thick as the thinnest wall."""
    cavities = _cavities(segment)
    ledges = [top - bottom for bottom, top, gap in cavities if gap == 0.0]
    return len(cavities) < 2 or min(ledges) >= WALL_MM


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
        gap = 0.0 if layer in held else CLEARANCE_MM
        if runs and runs[-1][2] == gap:
            runs[-1] = (runs[-1][0], layer.top_mm, gap)
        else:
            runs.append((layer.bottom_mm, layer.top_mm, gap))
    return runs
