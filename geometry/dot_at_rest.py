"""The dot at rest: its rotation, where it just touches, and whether it overlaps the segment."""

from dataclasses import dataclass, replace
from math import cos, hypot, radians, sin

import numpy as np

from foundation.errors import InputError
from geometry.dot import DotShape, Floats
from geometry.dot_cell import cell_tips, single_tip
from geometry.dot_profile import read_profile
from geometry.dot_size import DotSize, dot_size
from geometry.parameters import Dot, Segment
from geometry.part_checks import refuse_out_of_plane
from geometry.stack import bodies, layers

TOUCHING_TOLERANCE_MM = 1e-9
FOOT_SAMPLES = 17


@dataclass(frozen=True)
class Overlap:
    """The name of what overlaps the segment, and the depth of the overlap in mm."""

    what: str
    depth_mm: float


def tilt_rotation(tilt_deg: tuple[float, float]) -> Floats:
    """Rotation matrix (3, 3) about x by tilt_deg[0], then about y by tilt_deg[1]. InputError from 90 degrees."""
    for axis, tilt in enumerate(tilt_deg):
        if abs(tilt) >= 90.0:
            raise InputError(f"dot.tilt_deg[{axis}] = {tilt:g}: must be above -90 and below 90")
    a, b = radians(tilt_deg[0]), radians(tilt_deg[1])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cos(a), -sin(a)], [0.0, sin(a), cos(a)]])
    about_y = np.array([[cos(b), 0.0, sin(b)], [0.0, 1.0, 0.0], [-sin(b), 0.0, cos(b)]])
    return np.asarray(about_y @ about_x)


def rest_origin(shape: "DotShape", segment: Segment, offset_mm: tuple[float, float]) -> Floats:
    """Position (3,) of the pressed dot's tip at rest in mm; the origin in shape is not used."""
    top = layers(segment)[-1].top_mm - float(shape.tips_mm[:, 2].min())  # a higher dot of its cell touches first
    ball = np.array([*offset_mm, top + shape.radius_mm])
    origin = ball - shape.rotation @ [0.0, 0.0, shape.radius_mm]
    if shape.kind == "plate":
        normal = shape.rotation[:, 2]
        reach = max(body.reach(normal) for body in bodies(segment))
        origin[2] += (reach - normal @ origin) / normal[2]
    elif shape.kind == "ridge":
        origin[2] += _ridge_lift(shape, segment, ball)
    return np.asarray(origin)


def _ridge_lift(shape: "DotShape", segment: Segment, ball: Floats) -> float:
    """Height in mm by which a ridge rises to touch the effector (else the top) with its lowest point over it.

    On the plane y = const the cylinder is lowest where its normal has no x part; over a range of y the lowest
    of these points is at one end.
    """
    axis = shape.rotation[:, 1]
    if axis[2] == 0.0:
        return 0.0
    slope = hypot(axis[1], axis[2])
    below = shape.radius_mm * np.array([0.0, axis[2], -axis[1]]) / slope
    half = bodies(segment)[-1].reach(np.array([0.0, 1.0, 0.0]))
    top = ball[2] - shape.radius_mm
    along = [(y - ball[1] - below[1]) / axis[1] for y in (-half, half)]
    return float(max(top - (ball[2] + s * axis[2] + below[2]) for s in along))


def overlap_at_rest(shape: "DotShape", segment: Segment) -> Overlap:
    """The deepest overlap of the plate and of the neighbouring dots with the resting segment; 0 mm for none."""
    normal = shape.rotation[:, 2]
    face = float(normal @ shape.origin_mm) + shape.height_mm
    solids = bodies(segment)
    deepest = Overlap("plate", max(body.reach(normal) for body in solids) - face)
    for tip in shape.tips_mm[1:]:
        foot = max(0.0, shape.height_mm - tip[2] - shape.radius_mm)
        for z in shape.radius_mm + np.linspace(0.0, foot, FOOT_SAMPLES if foot else 1):
            ball = shape.origin_mm + shape.rotation @ np.add(tip, [0.0, 0.0, z])
            depth = float(shape.radius_mm - min(body.distance(ball) for body in solids))
            if depth > deepest.depth_mm:
                deepest = Overlap("neighbouring dot", depth)
    return deepest if deepest.depth_mm > TOUCHING_TOLERANCE_MM else Overlap("nothing", 0.0)


def refuse_overlap(shape: "DotShape", segment: Segment, dot: Dot) -> None:
    """Raise InputError, with the largest tilt, where the plate or a neighbouring dot overlaps the segment."""
    found = overlap_at_rest(shape, segment)
    if found.depth_mm == 0.0:
        return
    x, y = dot.tilt_deg
    share = _allowed_share(shape, segment, dot)
    allowed_x, allowed_y = (_rounded_towards_zero(share * tilt) for tilt in (x, y))
    raise InputError(
        f"dot.tilt_deg = [{x:g}, {y:g}]: the {found.what} overlaps the segment by {found.depth_mm:.3g} mm "
        f"at rest; in this direction at most [{allowed_x}, {allowed_y}] is allowed"
    )


def _allowed_share(shape: "DotShape", segment: Segment, dot: Dot) -> float:
    """Largest share of the tilt, 0 to 1, without overlap, by bisection; without tilt nothing can overlap."""
    low, high = 0.0, 1.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        tilt = (middle * dot.tilt_deg[0], middle * dot.tilt_deg[1])
        turned = replace(shape, rotation=tilt_rotation(tilt))
        turned = replace(turned, origin_mm=rest_origin(turned, segment, dot.offset_mm))
        low, high = (middle, high) if overlap_at_rest(turned, segment).depth_mm == 0.0 else (low, middle)
    return low


def _rounded_towards_zero(angle: float) -> str:
    """An angle rounded towards zero to a hundredth of a degree, so that what is printed is allowed."""
    return f"{int(angle * 100) / 100:g}"


def resolve_dot(dot: Dot, segment: Segment) -> DotShape:
    """The exact dot at rest over a segment; a dot without stated sizes is a cap of Marburg Medium.

    At rest the lowest point of the pressed ball or cylinder is at the top of the stack, whatever the offset;
    over a dome or beside a narrow effector a gap remains. A tilt turns the dot about the centre of the
    pressed ball, so that this holds. A ridge tilted along its axis, and a plate, are lifted until they
    only touch.
    Raises InputError for contradicting sizes, for what a plane-strain section cannot hold, for an impossible
    cell and for a dot, plate or neighbour that would overlap the resting segment.
    """
    _refuse_out_of_plane(dot, segment)
    size = DotSize(0.0, 0.0, 0.0) if dot.shape == "plate" else dot_size(dot)
    tips, height = cell_tips(dot, size.height_mm) if dot.shape == "cap" else single_tip(dot, size.height_mm)
    profile = None if dot.profile_csv is None else read_profile(dot.profile_csv)
    if profile is not None and any(dot.tilt_deg):
        raise InputError(f"dot.tilt_deg = {list(dot.tilt_deg)}: dot.shape = 'profile' stands upright; must be [0, 0]")
    turned = DotShape(dot.shape, size.radius_mm, height, tips, np.zeros(3), tilt_rotation(dot.tilt_deg), profile)
    origin = rest_origin(turned, segment, dot.offset_mm) + np.array([0.0, 0.0, dot.gap_mm])
    rest = replace(turned, origin_mm=origin)
    refuse_overlap(rest, segment, dot)
    return rest


def _refuse_out_of_plane(dot: Dot, segment: Segment) -> None:
    """Refuse what varies over y in a plane-strain section."""
    if segment.section != "plane-strain":
        return
    plane = "segment.section = 'plane-strain' has nothing that varies over y"
    if dot.shape in ("cap", "profile"):
        raise InputError(f"dot.shape = '{dot.shape}': {plane}; use dot.shape = 'ridge' or 'plate'")
    if dot.cell is not None:
        raise InputError(f"dot.cell = '{dot.cell}': {plane}; leave the cell out")
    refuse_out_of_plane(segment, "dot.offset_mm[1]", dot.offset_mm[1])
    if dot.tilt_deg[0] != 0.0:
        raise InputError(f"dot.tilt_deg[0] = {dot.tilt_deg[0]:g}: {plane}; the tilt about x must be 0")
