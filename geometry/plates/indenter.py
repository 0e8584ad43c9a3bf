"""An indenter tip for a force gauge: a post with a dot on its flat end."""

from dataclasses import dataclass
from typing import Any

from foundation.errors import InputError
from geometry.plates.plate import PlacedDot, Plate, printed_part, standing_dots
from geometry.solids import upright_cylinder

POST_DIAMETER_MM = 10.0
"""Diameter of the post; half of it is the thickness over the hole."""
CONE_HEIGHT_PER_RADIUS = 1.2
"""Height over radius of the cone that ends the hole: steeper than 45 degrees."""


@dataclass(frozen=True)
class GaugeThread:
    """A male thread of force gauges. hole_mm : diameter of the hole that is tapped; depth_mm : of the thread."""

    hole_mm: float
    depth_mm: float


THREADS = {
    "M6": GaugeThread(5.0, 10.0),
    "M4": GaugeThread(3.3, 8.0),
    "10-32": GaugeThread(4.04, 10.0),
}
"""Holes: nominal diameter less pitch for ISO coarse threads (ISO 2306), drill no. 21 for 10-32 UNF."""


def indenter_tip(base_diameter_mm: float, height_mm: float, thread: str = "M6") -> Plate:
    """A post, foot at z = 0, with a dot on its flat end and a blind hole for the thread of the gauge.

    The hole ends in a cone, so that it prints without a support. InputError for an unknown thread and for a dot
    wider than the post.
    """
    if thread not in THREADS:
        raise InputError(f"--thread = '{thread}': no such thread, known are {', '.join(THREADS)}")
    if base_diameter_mm >= POST_DIAMETER_MM:
        raise InputError(f"base_diameter_mm = {base_diameter_mm:g}: must be less than the post of {POST_DIAMETER_MM:g}")
    hole = THREADS[thread]
    top = hole.depth_mm + CONE_HEIGHT_PER_RADIUS * hole.hole_mm / 2 + POST_DIAMETER_MM / 2
    dot = PlacedDot(0.0, 0.0, top, base_diameter_mm, height_mm)
    post = upright_cylinder(POST_DIAMETER_MM / 2, 0.0, top).cut(_threaded_hole(hole)).solid()
    solid = post.fuse(*standing_dots([dot])).solid()
    return Plate(printed_part("tip", solid), (dot,), (POST_DIAMETER_MM, POST_DIAMETER_MM, top + height_mm))


def _threaded_hole(hole: GaugeThread) -> Any:
    """A cylinder with a cone on top, from below the foot."""
    from build123d import Pos, Solid

    radius, start = hole.hole_mm / 2, -1.0
    bore = upright_cylinder(radius, start, hole.depth_mm)
    cone = Pos(0, 0, hole.depth_mm) * Solid.make_cone(radius, 0.0, CONE_HEIGHT_PER_RADIUS * radius)
    return bore.fuse(cone).solid()
