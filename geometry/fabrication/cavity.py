"""The cavity of one component: the designed part, enlarged for shrinkage, with draft where a mould needs it."""

from dataclasses import dataclass
from math import radians, sqrt, tan
from typing import Any

from geometry.bodies import Box, Disc, Dome, bodies
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.shapes import scaled
from geometry.layer_solids import layer_solids
from geometry.parameters import Segment


@dataclass(frozen=True)
class Cavity:
    """One cavity in the frame of the mould: floor at z = 0, lid at z = height, axis at x = y = 0. In mm.

    designed : the part as designed, in the same place and the same way up, not enlarged.
    enlarged : the part divided by 1 - shrinkage, without draft.
    solid : what is hollow in the mould.
    size_x, size_y : of the opening.
    shape : "box", "disc" or "dome".
    """

    designed: Any
    enlarged: Any
    solid: Any
    size_x: float
    size_y: float
    height: float
    shape: str
    shrinkage: float


def cavity_of(name: str, segment: Segment, shrinkage: float, draft_deg: float, fabrication: Fabrication) -> Cavity:
    """The cavity of a component; the draft, in degrees, leaves a dome as it is.

    Draft leaves the section at mid-height as designed, so that the deviation is as small as it can be.
    """
    designed = designed_part(name, segment, fabrication)
    enlarged = scaled(designed, 1.0 / (1.0 - shrinkage))
    shape, size = _shape(name, segment), enlarged.bounding_box().size
    widening = draft_widening(shape, size.Z, draft_deg)
    return Cavity(
        designed=designed,
        enlarged=enlarged,
        solid=_drafted(shape, size, widening) if widening > 0.0 else enlarged,
        size_x=size.X + 2 * widening,
        size_y=size.Y + 2 * widening,
        height=size.Z,
        shape=shape,
        shrinkage=shrinkage,
    )


def designed_part(name: str, segment: Segment, fabrication: Fabrication) -> Any:
    """The part on the floor of its mould: with lid_face = 'base' it stands on its head."""
    from build123d import Pos, Rot

    solid = layer_solids(segment, segment.film.thickness_um * 1e-3)[name]
    low = solid.bounding_box().min.Z
    if fabrication.lid_face == "top":
        return Pos(0, 0, -low) * solid
    return Pos(0, 0, solid.bounding_box().max.Z) * Rot(180, 0, 0) * solid


def draft_widening(shape: str, height: float, draft_deg: float) -> float:
    """By how much draft widens each side at the lid and narrows it at the floor, in mm; a dome needs none."""
    return 0.0 if shape == "dome" else tan(radians(draft_deg)) * height / 2


def draft_deviation(shape: str, height: float, draft_deg: float) -> float:
    """Largest distance between the drafted and the designed surface in mm: at the corners of a box."""
    return draft_widening(shape, height, draft_deg) * (sqrt(2.0) if shape == "box" else 1.0)


def _shape(name: str, segment: Segment) -> str:
    body = bodies(segment)[-1] if name == "effector" else Box(1.0, 1.0, 0.0, 1.0)
    return {Box: "box", Disc: "disc", Dome: "dome"}[type(body)]


def _drafted(shape: str, size: Any, widening: float) -> Any:
    """A box or cylinder that is wider at the top and narrower at the bottom."""
    from build123d import Plane, Solid, Wire

    if shape == "disc":
        return Solid.make_cone(size.X / 2 - widening, size.X / 2 + widening, size.Z)
    wires = [
        Wire.make_rect(size.X + 2 * wide, size.Y + 2 * wide, Plane((0, 0, z)))
        for z, wide in ((0.0, -widening), (size.Z, widening))
    ]
    return Solid.make_loft(wires, ruled=True)
