"""Checks of the sizes of a segment, and whether an effector and a delaminated patch fit on it."""

from foundation.errors import InputError
from geometry.parameters import Effector, Segment

SIZES_OF_SHAPE: dict[str, tuple[str, ...]] = {
    "layer": (),
    "block": ("length_mm", "width_mm"),
    "cylinder": ("diameter_mm",),
    "dome": ("diameter_mm",),
}
ROUNDING_MM = 1e-9
SMALLEST_MM, LARGEST_MM = 1e-4, 1e3
"""Sizes of a segment: the CAD kernel takes points closer than 1e-7 mm for one, a thousandth of the smallest size, and
a metre is no tactile sensor.
"""
LAYER_TABLES = "effector", "medium1", "film", "medium2"
IN_MM = "length_mm", "width_mm", "height_mm", "diameter_mm", "thickness_mm"
MM_OF_SIZE = {**dict.fromkeys(IN_MM, 1.0), "thickness_um": 1e-3}
"""Keys of sizes -> millimetres of their unit."""


def check_size_range(segment: Segment) -> None:
    """Raise InputError for a size of the segment that is far from that of any sensor."""
    tables = {"segment": segment, **{f"segment.{name}": getattr(segment, name) for name in LAYER_TABLES}}
    for name, table in tables.items():
        for key, unit_mm in MM_OF_SIZE.items():
            size = getattr(table, key, None)
            if size is None:
                continue
            if size * unit_mm < SMALLEST_MM:
                raise InputError(f"{name}.{key} = {size:g}: must be at least {SMALLEST_MM / unit_mm:g}")
            if size * unit_mm > LARGEST_MM:
                raise InputError(f"{name}.{key} = {size:g}: must be at most {LARGEST_MM / unit_mm:g}")


def refuse_out_of_plane(segment: Segment, key: str, y: float) -> None:
    """Raise InputError for a place y, stated by a key, beside the middle of a plane-strain segment."""
    if segment.section == "plane-strain" and y != 0.0:
        raise InputError(f"{key} = {y:g}: segment.section = 'plane-strain' has nothing that varies over y; must be 0")


def check_effector(segment: Segment) -> None:
    """Raise InputError for an effector with missing, unused or too large sizes; nothing without effector."""
    effector = segment.effector
    if effector is None:
        return
    if segment.section == "plane-strain" and effector.shape in ("cylinder", "dome"):
        raise InputError(
            f"segment.effector.shape = '{effector.shape}': segment.section = 'plane-strain' has nothing "
            "round about z; use 'block' or 'layer'"
        )
    _check_sizes(segment, effector)
    _check_foot(segment, effector)
    if effector.shape == "dome":
        _check_dome(effector)


def covers_footprint(segment: Segment) -> bool:
    """Whether all sides of the effector are flush with those of the segment; True without effector."""
    effector = segment.effector
    if effector is None or effector.shape == "layer":
        return True
    if effector.shape != "block":
        return False
    sizes = ((effector.length_mm, segment.length_mm), (effector.width_mm, segment.width_mm))
    return all(size is None or size >= limit - ROUNDING_MM for size, limit in sizes)


def _check_sizes(segment: Segment, effector: Effector) -> None:
    used = SIZES_OF_SHAPE[effector.shape]
    sliced = segment.section == "plane-strain"
    for name in ("length_mm", "width_mm", "diameter_mm"):
        value = getattr(effector, name)
        if value is None and name in used and not (sliced and name == "width_mm"):
            raise InputError(f"segment.effector.{name} is missing: shape = '{effector.shape}' needs it")
    if sliced and effector.width_mm not in (None, segment.width_mm):
        raise InputError(
            f"segment.effector.width_mm = {effector.width_mm:g}: segment.section = 'plane-strain' has "
            f"nothing that varies over y; leave it out or give segment.width_mm, {segment.width_mm:g}"
        )


def _check_foot(segment: Segment, effector: Effector) -> None:
    """Refuse a foot that leaves the footprint."""
    limits = [("length_mm", segment.length_mm), ("width_mm", segment.width_mm)]
    if effector.diameter_mm is not None:
        limits = [("diameter_mm", segment.length_mm), ("diameter_mm", segment.width_mm)]
    for number, (name, limit) in enumerate(limits):
        value = getattr(effector, name)
        if value is not None and value > limit + ROUNDING_MM:
            whole = ("segment.length_mm", "segment.width_mm")[number]
            raise InputError(
                f"segment.effector.{name} = {value:g}: wider than the segment, at most {whole} = {limit:g}"
            )


def _check_dome(effector: Effector) -> None:
    """Refuse a spherical cap higher than a hemisphere, h > d / 2."""
    diameter = effector.diameter_mm or 0.0
    if effector.height_mm > diameter / 2 + ROUNDING_MM:
        raise InputError(
            f"segment.effector.height_mm = {effector.height_mm:g}: a dome is at most half as high as its "
            f"foot is wide, {diameter / 2:g} for diameter_mm = {diameter:g}"
        )


def check_patch(segment: Segment, bond: str, center_mm: tuple[float, float], diameter_mm: float) -> None:
    """Raise InputError for a disc that leaves the interface of a bond, of a slice for a strip that does so in x.

    bond : its name as in the mechanism delamination; only below the effector is the interface smaller than the
    footprint. A round foot counts as its square.
    """
    refuse_out_of_plane(segment, f"mechanisms: the delamination of '{bond}' with center_mm[1]", center_mm[1])
    half = _half_sizes(segment, bond)
    axes = "x" if segment.section == "plane-strain" else "xy"
    for axis, middle, limit in zip(axes, center_mm, half, strict=False):
        reach = abs(middle) + diameter_mm / 2
        if reach > limit + ROUNDING_MM:
            raise InputError(
                f"mechanisms: the delamination of '{bond}' with center_mm = [{center_mm[0]:g}, {center_mm[1]:g}] and "
                f"diameter_mm = {diameter_mm:g} reaches {reach:g} mm from the centre in {axis}, beyond the edge of "
                f"the interface at {limit:g} mm"
            )


def _half_sizes(segment: Segment, bond: str) -> tuple[float, float]:
    """Half the size in x and y, in mm, of the interface of a bond."""
    effector = segment.effector
    sizes = (segment.length_mm, segment.width_mm)
    if bond == "bond-effector-medium1" and effector is not None and effector.shape != "layer":
        foot = (effector.length_mm or effector.diameter_mm, effector.width_mm or effector.diameter_mm)
        sizes = (foot[0] or sizes[0], foot[1] or sizes[1])
    return sizes[0] / 2, sizes[1] / 2
