"""Whether an effector can stand on its segment."""

from geometry.errors import InputError
from geometry.parameters import Effector, Segment

USED_SIZES: dict[str, tuple[str, ...]] = {
    "layer": (),
    "block": ("length_mm", "width_mm"),
    "cylinder": ("diameter_mm",),
    "dome": ("diameter_mm",),
}
ROUNDING_MM = 1e-9


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
    _check_within(segment, effector)
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
    used = USED_SIZES[effector.shape]
    sliced = segment.section == "plane-strain"
    for name in ("length_mm", "width_mm", "diameter_mm"):
        value = getattr(effector, name)
        if value is None and name in used and not (sliced and name == "width_mm"):
            raise InputError(f"segment.effector.{name} is missing: shape = '{effector.shape}' needs it")
        if value is not None and name not in used:
            raise InputError(
                f"segment.effector.{name} = {value:g}: shape = '{effector.shape}' has no such size, leave it out"
            )
    if sliced and effector.width_mm not in (None, segment.width_mm):
        raise InputError(
            f"segment.effector.width_mm = {effector.width_mm:g}: segment.section = 'plane-strain' has "
            f"nothing that varies over y; leave it out or give segment.width_mm, {segment.width_mm:g}"
        )


def _check_within(segment: Segment, effector: Effector) -> None:
    """The foot lies within the footprint."""
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
    """A spherical cap is at most a hemisphere: h <= d / 2."""
    diameter = effector.diameter_mm or 0.0
    if effector.height_mm > diameter / 2 + ROUNDING_MM:
        raise InputError(
            f"segment.effector.height_mm = {effector.height_mm:g}: a dome is at most half as high as its "
            f"foot is wide, {diameter / 2:g} for diameter_mm = {diameter:g}"
        )
