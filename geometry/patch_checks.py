"""Whether a delaminated patch lies within its interface."""

from geometry.errors import InputError
from geometry.parameters import Segment

ROUNDING_MM = 1e-9


def check_patch(segment: Segment, bond: str, center_mm: tuple[float, float], diameter_mm: float) -> None:
    """Raise InputError for a disc that leaves the interface of a bond, of a slice for a strip that does so in x.

    bond : its name as in the mechanism delamination; only below the effector is the interface smaller than the
    footprint. A round foot counts as its square.
    """
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
    """Half the size in x and y of an interface."""
    effector = segment.effector
    sizes = (segment.length_mm, segment.width_mm)
    if bond == "bond-effector-medium1" and effector is not None and effector.shape != "layer":
        foot = (effector.length_mm or effector.diameter_mm, effector.width_mm or effector.diameter_mm)
        sizes = (foot[0] or sizes[0], foot[1] or sizes[1])
    return sizes[0] / 2, sizes[1] / 2
