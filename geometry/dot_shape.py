"""The exact shape and rest position of the rigid dot, shared by CAD and contact."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from geometry.dot_centers import cell_centers, refuse_cell_of
from geometry.dot_rest import refuse_overlap, rest_origin, rotation_of
from geometry.dot_size import SIZES, DotSize, dot_size
from geometry.errors import InputError
from geometry.parameters import Dot, Segment


@dataclass(frozen=True)
class DotShape:
    """A rigid dot (or a cell of dots) on its plate.

    Dot frame: origin at the tip of the pressed dot, z into the plate; the solid lies at z >= 0.

    kind : "cap", "ridge" (cylinder along y) or "plate".
    radius_mm : of the sphere or cylinder (unused for a plate).
    height_mm : height of the plate's face over the tip; 0 for a plate.
    foot_mm : length of the cylindrical foot between the sphere's equator and the plate; 0 unless the
        height exceeds the radius.
    centers_xy_mm : (n, 2) axes of the dots in the dot frame; the pressed dot first, at (0, 0).
    origin_mm : (3,) position of the dot frame's origin in the segment frame at rest, just touching.
    rotation : (3, 3) x_segment = origin + rotation @ x_dot.
    """

    kind: Literal["cap", "ridge", "plate"]
    radius_mm: float
    height_mm: float
    foot_mm: float
    centers_xy_mm: NDArray[np.float64]
    origin_mm: NDArray[np.float64]
    rotation: NDArray[np.float64]


def resolve_dot(dot: Dot, segment: Segment) -> DotShape:
    """The exact dot at rest over a segment: nothing given means a cap of Marburg Medium.

    At rest the lowest point of the pressed ball or cylinder is at the top of the stack, whatever the offset;
    over a dome or beside a narrow effector a gap remains. A tilt turns the dot about the centre of the
    pressed ball, so that this holds. A ridge tilted along its axis, and a plate, are lifted until they
    only touch.
    Raises InputError for contradicting sizes, for what a plane-strain section cannot hold, for an impossible
    cell and for a dot, plate or neighbour that would overlap the resting segment.
    """
    _refuse_out_of_plane(dot, segment)
    size = _plate_size(dot) if dot.shape == "plate" else dot_size(dot)
    centers = cell_centers(dot) if dot.shape == "cap" else refuse_cell_of(dot)
    sizes = (size.radius_mm, size.height_mm, size.foot_mm)
    turned = DotShape(dot.shape, *sizes, centers, np.zeros(3), rotation_of(dot.tilt_deg))
    origin = rest_origin(turned, segment, dot.offset_mm) + np.array([0.0, 0.0, dot.gap_mm])
    rest = replace(turned, origin_mm=origin)
    refuse_overlap(rest, segment, dot)
    return rest


def _refuse_out_of_plane(dot: Dot, segment: Segment) -> None:
    """Refuse what varies over y in a plane-strain section."""
    if segment.section != "plane-strain":
        return
    plane = "segment.section = 'plane-strain' has nothing that varies over y"
    if dot.shape == "cap":
        raise InputError(f"dot.shape = 'cap': {plane}; use dot.shape = 'ridge' or 'plate'")
    if dot.cell is not None:
        raise InputError(f"dot.cell = '{dot.cell}': {plane}; leave the cell out")
    if dot.offset_mm[1] != 0.0:
        raise InputError(f"dot.offset_mm[1] = {dot.offset_mm[1]:g}: {plane}; must be 0")
    if dot.tilt_deg[0] != 0.0:
        raise InputError(f"dot.tilt_deg[0] = {dot.tilt_deg[0]:g}: {plane}; the tilt about x must be 0")


def _plate_size(dot: Dot) -> DotSize:
    """A plate has no sizes; InputError when some are given."""
    for name in ("standard", *SIZES):
        value = getattr(dot, name)
        if value is not None:
            raise InputError(f"dot.{name} = {value!r}: dot.shape = 'plate' has no size, leave it out")
    return DotSize(0.0, 0.0, 0.0)
