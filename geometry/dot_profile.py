"""A dot whose height was measured over its radius: its file, and the meridian through the rows."""

import csv
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import read_text

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

UNITS_MM = {"mm": 1.0, "um": 1e-3}
LEAST_ROWS = 4
CHECKED_PLACES = 2000
TIP_SHARE = 0.2
"""Share of the height over which the radius of the tip is told."""


@dataclass(frozen=True)
class DotProfile:
    """Meridian of a dot, from its tip: radius_mm (k,) rising from 0, depth_mm (k,) below the tip, never falling."""

    radius_mm: tuple[float, ...]
    depth_mm: tuple[float, ...]

    @cached_property
    def curve(self) -> "PPoly":
        """Depth over radius: the cubic spline through the rows and their mirror image, so level at the tip.

        Where that would rise towards the plate: monotone cubics (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980,
        238-246), whose curvature jumps at the rows.
        """
        from scipy.interpolate import CubicSpline, PchipInterpolator

        radius, depth = np.array(self.radius_mm), np.array(self.depth_mm)
        rows = np.append(-radius[:0:-1], radius), np.append(depth[:0:-1], depth)
        spline = CubicSpline(*rows)
        slope = spline(np.linspace(0.0, radius[-1], CHECKED_PLACES), 1)
        return spline if slope.min() >= -1e-9 else PchipInterpolator(*rows)

    @property
    def height_mm(self) -> float:
        """Height of the tip over the last row, where the plate begins."""
        return self.depth_mm[-1]

    @property
    def tip_radius_mm(self) -> float:
        """Radius of the ball that fits the tip best, depth = r^2 / 2 R; of one through the base where it is flat."""
        radius, depth = np.array(self.radius_mm), np.array(self.depth_mm)
        at_tip = (depth <= TIP_SHARE * self.height_mm) & (radius > 0.0)
        weighted = float((depth * radius**2)[at_tip].sum())
        if weighted == 0.0:
            return float(radius[-1] ** 2 / (2.0 * self.height_mm))
        return float((radius**4)[at_tip].sum()) / (2.0 * weighted)

    def meridian_mm(self, count: int) -> Floats:
        """Points (count, 2) of it from the tip to the plate, radius and depth."""
        radius = np.linspace(0.0, self.radius_mm[-1], count)
        return np.column_stack([radius, self.curve(radius)])


def read_profile(file: str) -> DotProfile:
    """The profile in a CSV file with the columns radius_mm and height_mm (or _um), from the tip to the plate.

    Heights count from the last row. InputError for other columns, rows that are no numbers, and a course that is not
    that of a dot.
    """
    what = f"dot.profile_csv '{file}'"
    rows = list(csv.reader(read_text(Path(file), what).splitlines()))
    head = [cell.strip() for cell in rows[0]] if rows else []
    columns = [_column(head, name, what) for name in ("radius", "height")]
    found = [[_number(row, *column, what, line) for column in columns] for line, row in enumerate(rows[1:], 2) if row]
    radius, height = np.array(found).reshape(-1, 2).T
    _refuse_other_courses(radius, height, what)
    return DotProfile(tuple(radius.tolist()), tuple((height[0] - height).tolist()))


def _column(head: list[str], name: str, what: str) -> tuple[int, float]:
    """Number of a column and its unit in mm."""
    for unit, factor in UNITS_MM.items():
        if f"{name}_{unit}" in head:
            return head.index(f"{name}_{unit}"), factor
    known = " or ".join(f"{name}_{unit}" for unit in UNITS_MM)
    raise InputError(f"{what}: has no column {known}; its first row is '{','.join(head)}'")


def _number(row: list[str], column: int, factor: float, what: str, line: int) -> float:
    """A finite number in mm."""
    try:
        value = factor * float(row[column])
    except (ValueError, IndexError):
        value = float("nan")
    if not isfinite(value):
        raise InputError(f"{what} row {line}: '{','.join(row)}' has no finite number in column {column + 1}")
    return value


def _refuse_other_courses(radius: Floats, height: Floats, what: str) -> None:
    if len(radius) < LEAST_ROWS:
        raise InputError(f"{what}: has {len(radius)} rows, needs at least {LEAST_ROWS}")
    if radius[0] != 0.0:
        raise InputError(f"{what}: begins at a radius of {radius[0]:g} mm, must begin at the tip, 0")
    back = np.flatnonzero(np.diff(radius) <= 0.0)
    if len(back):
        raise InputError(f"{what} row {back[0] + 3}: a radius of {radius[back[0] + 1]:g} mm is not above the last one")
    rise = np.flatnonzero(np.diff(height) > 0.0)
    if len(rise):
        raise InputError(
            f"{what} row {rise[0] + 3}: the height rises to {height[rise[0] + 1]:g} mm; it must fall from the tip to "
            "the plate, so smooth the measurement"
        )
    if height[0] == height[-1]:
        raise InputError(f"{what}: has one height everywhere; that is dot.shape = 'plate'")
