"""Where and how a layer is measured, by its shape: only a box has corners, and a dome has no height at its edge."""

from dataclasses import dataclass

import numpy as np

from export.build_sheet.contents import Contents
from geometry.bodies import Box, Disc, Dome, bodies

GAUGE = "Use a thickness gauge that barely presses, or a microscope with a scale: a calliper squeezes soft rubber."


@dataclass(frozen=True)
class Gauging:
    """shape : "box", "cylinder" or "dome". quantity : "thickness" or "height", of size_mm. where : the points.

    foot : what to measure across and its sizes as text, None for a layer as wide as the segment. grip : where to hold
    it. keep : which of the cast parts are good, to follow "Keep the parts".
    """

    shape: str
    quantity: str
    size_mm: float
    where: str
    foot: tuple[str, str] | None
    grip: str
    keep: str


def gauging(contents: Contents, name: str) -> Gauging:
    """A layer other than the film."""
    layer = next(one for one in contents.layers if one.name == name)
    body, size = bodies(contents.segment)[-1], layer.thickness_mm
    if name == "effector" and isinstance(body, Disc | Dome):
        across = 2 * float(body.reach(np.array([1.0, 0.0, 0.0])))
        foot = ("diameter of its foot", f"{across:.4g} mm")
        if isinstance(body, Dome):
            keep = f"whose crown is {size:.4g} mm above their base and whose foot is {across:.4g} mm across"
            return Gauging("dome", "height", size, "from its base to its crown", foot, "at the edge", keep)
        keep = f"that are {size:.4g} mm high in the middle and all around the rim, and {across:.4g} mm across"
        return Gauging("cylinder", "height", size, "in the middle and all around its rim", foot, "at the rim", keep)
    keep, sides = f"that are {size:.4g} mm thick at all four corners", None
    if name == "effector" and isinstance(body, Box):
        length, width = 2 * body.half_x, 2 * body.half_y
        if (length, width) != (contents.segment.length_mm, contents.segment.width_mm):
            sides = ("length (x) and width (y) of its foot", f"{length:.4g} × {width:.4g} mm")
            keep += f", and {length:.4g} × {width:.4g} mm wide"
    return Gauging("box", "thickness", size, "at its four corners", sides, "at a corner", keep)
