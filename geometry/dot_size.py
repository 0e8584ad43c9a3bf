"""Sizes of the dot of a segment: those of a Braille standard, or stated ones."""

from dataclasses import dataclass

from foundation.errors import InputError
from geometry.braille_standards import BrailleStandard, standard
from geometry.dot_profile import read_profile
from geometry.parameters import Dot

DEFAULT_STANDARD = "marburg-medium"
SIZE_KEYS = ("base_diameter_mm", "height_mm", "radius_mm")


@dataclass(frozen=True)
class DotSize:
    """Sizes of a dot in mm: radius of the sphere or cylinder, height over the plate, height of the cylindrical foot."""

    radius_mm: float
    height_mm: float
    foot_mm: float


def dot_standard(dot: Dot) -> BrailleStandard | None:
    """The standard that a dot follows: the named one, the default when no size is stated, else None.

    InputError where both a standard and sizes are stated.
    """
    if dot.profile_csv is not None:
        return None
    given = [name for name in SIZE_KEYS if getattr(dot, name) is not None]
    if dot.standard is None:
        return None if given else standard(DEFAULT_STANDARD)
    if given:
        raise InputError(
            f"dot.{given[0]} = {getattr(dot, given[0]):g}: dot.standard = '{dot.standard}' fixes the sizes "
            "already; give either the standard or explicit sizes"
        )
    return standard(dot.standard)


def dot_size(dot: Dot) -> DotSize:
    """The sizes of a cap, ridge or profile (radius of its tip).

    InputError for sizes that are missing, contradict each other or are not fixed.
    """
    if dot.profile_csv is not None:
        profile = read_profile(dot.profile_csv)
        return DotSize(profile.tip_radius_mm, profile.height_mm, 0.0)
    chosen = dot_standard(dot)
    if chosen is not None:
        return dot_size_from_base(chosen.nominal_mm("base_diameter_mm"), chosen.nominal_mm("height_mm"))
    if dot.radius_mm is not None:
        return _dot_size_from_radius(dot.radius_mm, dot)
    if dot.base_diameter_mm is None:
        raise InputError(
            f"dot.height_mm = {dot.height_mm:g}: a height alone is not a dot; add dot.base_diameter_mm or dot.radius_mm"
        )
    if dot.height_mm is None:
        raise InputError(
            f"dot.base_diameter_mm = {dot.base_diameter_mm:g}: a base alone is not a dot; add dot.height_mm"
        )
    return dot_size_from_base(dot.base_diameter_mm, dot.height_mm)


def dot_size_from_base(base_diameter_mm: float, height_mm: float) -> DotSize:
    """Sizes of a dot from its base and height in mm.

    A spherical cap has R = (d^2 / 4 + h^2) / 2h. Higher than d / 2 it would pass the hemisphere and undercut
    its base: such a dot is a hemisphere of radius d / 2 on a cylindrical foot of height h - d / 2.

    >>> dot_size_from_base(1.5, 0.5).radius_mm
    0.8125
    """
    half = base_diameter_mm / 2
    if height_mm > half:
        return DotSize(half, height_mm, height_mm - half)
    return DotSize((half**2 + height_mm**2) / (2 * height_mm), height_mm, 0.0)


def _dot_size_from_radius(radius_mm: float, dot: Dot) -> DotSize:
    """Sizes from the radius of the sphere or cylinder in mm; without a height it stands out by that. InputError."""
    if dot.base_diameter_mm is not None:
        raise InputError(
            f"dot.radius_mm = {radius_mm:g}: dot.base_diameter_mm = {dot.base_diameter_mm:g} is given too; "
            "give either of them"
        )
    height = radius_mm if dot.height_mm is None else dot.height_mm
    return DotSize(radius_mm, height, max(0.0, height - radius_mm))
