"""A dot from a scanned surface: the plate around it, its axis, its height over the radius, and what that leaves."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.dot_profile import DotProfile

POINTS, LEAST_POINTS, SEED = 200_000, 400, 0
"""Points that are laid on the surface, evenly by area, and how many must lie on the upper part of the dot."""
PLANE_TRIALS, PLANE_BAND = 400, 0.01
"""Planes through three points that are tried, and the band about one in which points count, over the patch's length."""
RINGS, OUTERMOST = 20, 6
"""Rings of equal area, so that the tip is not drawn from a handful of points: within the upper two thirds of the
height, and how many such areas are searched for the foot.
"""
DEGREE = 6
"""Of the even polynomial over the radius, in r^2, about which the axis is found."""
HEIGHTS_MM, LENGTHS_MM = (0.02, 5.0), (0.2, 100.0)
"""Heights of dots and lengths of patches that are no sign of another unit."""
LARGEST_SHARE = 0.2
"""Root mean square of the deviation over the height above which a scan is not of one dot."""


@dataclass(frozen=True)
class ScannedDot:
    """A dot that was fitted to a scan. points_mm (n, 3) : of the scan, x and y from the axis, z above the plate.

    profile : the meridian. deviation_mm (n,) : height of each point less that of the profile. plate_roughness_mm : root
    mean square about the plane. tilt_deg : of the plate against the x-y plane of the file.
    """

    points_mm: Floats
    profile: DotProfile
    deviation_mm: Floats
    plate_roughness_mm: float
    tilt_deg: float

    @property
    def on_dot(self) -> Any:
        """Which points (n,) lie on the dot, not on the plate."""
        return np.hypot(*self.points_mm[:, :2].T) <= self.profile.radius_mm[-1]

    @property
    def deviation_rms_mm(self) -> float:
        """Root mean square deviation of the points on the dot."""
        return float(np.sqrt(np.mean(self.deviation_mm[self.on_dot] ** 2)))

    @property
    def deviation_95_mm(self) -> float:
        """Deviation below which 95 % of the points on the dot lie."""
        return float(np.quantile(np.abs(self.deviation_mm[self.on_dot]), 0.95))

    @property
    def out_of_round_mm(self) -> float:
        """Amplitude of cos 2 phi and sin 2 phi in the deviation: half the difference of the heights along two axes."""
        x, y = self.points_mm[self.on_dot, :2].T
        twice = 2.0 * np.arctan2(y, x)
        rows = np.column_stack([np.cos(twice), np.sin(twice)])
        return float(np.hypot(*np.linalg.lstsq(rows, self.deviation_mm[self.on_dot], rcond=None)[0]))


def scanned_dot(file: Path) -> ScannedDot:
    """The dot in a surface in mm around it, as STL or another format of trimesh; a closed solid stands upright.

    The plate is the plane in whose band most points lie (random sample consensus: Fischler and Bolles, Commun. ACM 24,
    1981, 381-395), the axis the normal about which heights scatter least, the profile the median of each ring, made to
    fall outwards by isotonic regression. InputError for a file that holds no such surface.
    """
    what = f"scan '{file}'"
    points, upright = _points_of(file, what)
    level, roughness, tilt = _above_plate(points, upright)
    height = float(np.quantile(level[:, 2], 0.9995))
    low, high = HEIGHTS_MM
    if not max(low, 4.0 * roughness) <= height <= high:
        raise InputError(
            f"{what}: rises {height:.3g} mm above a plate of {roughness:.2g} mm roughness; a dot is {low:g} to "
            f"{high:g} mm high and higher than the plate is rough; give the surface of one dot and the plate around it"
        )
    count = int((level[:, 2] > 0.3 * height).sum())
    if count < LEAST_POINTS:
        raise InputError(
            f"{what}: the dot covers too little of it, {count} of {POINTS} points; cut the scan closer to it"
        )
    level[:, :2] -= _axis(level, height)
    profile = _profile(level, height, roughness)
    radius = np.hypot(*level[:, :2].T)
    shown = profile.height_mm - profile.curve(np.minimum(radius, profile.radius_mm[-1]))
    found = ScannedDot(level, profile, level[:, 2] - shown, roughness, tilt)
    if found.deviation_rms_mm > LARGEST_SHARE * profile.height_mm:
        raise InputError(
            f"{what}: the points lie {found.deviation_rms_mm:.3g} mm (root mean square) from any surface of "
            f"revolution, of {profile.height_mm:.3g} mm height; cut the scan to one dot and the plate around it"
        )
    return found


def _points_of(file: Path, what: str) -> tuple[Floats, bool]:
    """Points (n, 3) on what is seen from above, and whether z is known to point up. InputError."""
    import trimesh

    if not Path(file).is_file():
        raise InputError(f"{what}: there is no such file")
    try:
        surface = trimesh.load_mesh(file)
    except Exception as error:  # readers of other libraries raise anything
        raise InputError(f"{what}: cannot be read as a surface ({type(error).__name__})") from None
    if not isinstance(surface, trimesh.Trimesh) or not len(surface.faces):
        raise InputError(f"{what}: holds no triangles")
    if not np.isfinite(surface.vertices).all():
        raise InputError(f"{what}: has corners that are not finite")
    length, (low, high) = float(surface.extents.max()), LENGTHS_MM
    if not low <= length <= high:
        raise InputError(f"{what}: is {length:.3g} mm long; must be {low:g} to {high:g} mm, so state it in mm")
    solid = bool(surface.is_watertight)
    if solid:  # its walls and underside are not the plate
        surface.update_faces(surface.face_normals[:, 2] > 0.0)
    points, _ = trimesh.sample.sample_surface(surface, POINTS, seed=SEED)
    return np.asarray(points, float), solid


def _above_plate(points: Floats, upright: bool) -> tuple[Floats, float, float]:
    """Points in the frame of the plate, z above it; roughness in mm and tilt in degrees.

    Of an open patch the dot lies on the side on which the points rise farther from the plane.
    """
    middle, normal = _plane(points)
    away = (points - middle) @ normal
    if (upright and normal[2] < 0.0) or (not upright and -away.min() > away.max()):
        normal, away = -normal, -away
    spread = 1.4826 * float(np.median(np.abs(away[np.abs(away) < 2.0 * PLANE_BAND * np.ptp(points, axis=0).max()])))
    across = np.linalg.svd(normal[None])[2][1:]
    level = np.column_stack([(points - middle) @ across.T, away])
    return level, spread, float(np.degrees(np.arccos(min(abs(normal[2]), 1.0))))


def _plane(points: Floats) -> tuple[Floats, Floats]:
    """A point (3,) and the normal (3,) of the plane in whose band most points lie, fitted to these."""
    chance = np.random.default_rng(SEED)
    band = PLANE_BAND * float(np.ptp(points, axis=0).max())
    few = points[chance.choice(len(points), 5000)]
    best, most = (points[0], np.array([0.0, 0.0, 1.0])), -1
    for corners in chance.choice(len(few), (PLANE_TRIALS, 3)):
        first, second, third = few[corners]
        normal = np.cross(second - first, third - first)
        size = float(np.linalg.norm(normal))
        if size > 0.0:
            count = int((np.abs((few - first) @ (normal / size)) < band).sum())
            if count > most:
                best, most = (first, normal / size), count
    for _ in range(10):  # least squares of what lies within three times the scatter
        away = (points - best[0]) @ best[1]
        near = np.abs(away) < min(band, 3.0 * 1.4826 * float(np.median(np.abs(away[np.abs(away) < band]))) + 1e-9)
        middle = points[near].mean(axis=0)
        normal = np.linalg.svd(points[near] - middle, full_matrices=False)[2][2]
        best = middle, normal
    return best


def _axis(level: Floats, height: float) -> Floats:
    """Place (2,) of the axis: about it an even polynomial over the radius leaves least of the heights."""
    from scipy.optimize import minimize

    high = level[level[:, 2] > 0.3 * height]
    high = high[:: max(1, len(high) // 20_000)]
    reach = float(np.ptp(high[:, :2], axis=0).max())

    def left(place: Floats) -> float:
        square = ((high[:, :2] - place) ** 2).sum(axis=1) / reach**2
        rows = np.polynomial.legendre.legvander(2.0 * square - 1.0, DEGREE)
        rest = high[:, 2] - rows @ np.linalg.lstsq(rows, high[:, 2], rcond=None)[0]
        return float(rest @ rest)

    start = (high[:, :2].min(axis=0) + high[:, :2].max(axis=0)) / 2.0
    steps = start + 0.05 * reach * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    found = minimize(left, start, method="Nelder-Mead", options={"initial_simplex": steps, "xatol": 1e-5 * reach})
    return np.asarray(found.x)


def _profile(level: Floats, height: float, roughness: float) -> DotProfile:
    """The meridian by rings out to where the dot is no higher than a part of the roughness, or 0.5 % of its height."""
    from scipy.optimize import isotonic_regression

    square = (level[:, :2] ** 2).sum(axis=1)
    low = max(0.3 * roughness, 0.005 * height)  # a median scatters less than the points
    upper = float(np.quantile(square[level[:, 2] > 0.3 * height], 0.99))
    ring = (square * RINGS / upper).astype(int)
    kept = np.flatnonzero(ring < OUTERMOST * RINGS)
    order = kept[np.argsort(ring[kept], kind="stable")]
    parts = np.split(order, np.unique(ring[order], return_index=True)[1][1:])
    places = np.array([np.mean(square[part]) for part in parts])
    medians = np.array([np.median(level[part, 2]) for part in parts])
    falling = isotonic_regression(medians, weights=[len(part) for part in parts], increasing=False).x
    last = int(np.argmax(falling <= low)) if (falling <= low).any() else len(falling) - 1
    tip = falling[0] + (falling[0] - falling[1]) * places[0] / (places[1] - places[0])
    rows = np.sqrt(np.append(0.0, places[: last + 1]))
    depth = tip - np.append(falling[:last], 0.0)
    return DotProfile(tuple(rows.tolist()), (0.0, *depth.tolist()))
