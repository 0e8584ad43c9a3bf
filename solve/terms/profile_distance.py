"""Signed distance to a measured dot, a surface of revolution about its meridian, with gradient and Hessian."""

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from foundation.arrays import Floats
from geometry.dot_profile import DotProfile

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

SAMPLES = 2000
NEWTON_STEPS = 8


def profile_distance(profile: DotProfile, points_mm: Floats) -> tuple[Floats, Floats, Floats]:
    """Distance (n,) in mm, gradient (n, 3) and Hessian (n, 3, 3) in 1/mm at points (n, 3) in the frame of the dot.

    The nearest point lies in the plane through the axis. Curvatures of a surface at a distance d are k / (1 + k d);
    around the axis that is the radial part of the normal over the distance from the axis. Beyond the last row of the
    profile it is the distance from its edge, where the plate is nearer.
    """
    x, y, z = points_mm.T
    away = np.hypot(x, y)
    foot = _foot(profile, away, z)
    slope, bend = profile.curve(foot, 1), profile.curve(foot, 2)
    scale = np.sqrt(1.0 + slope**2)
    outward, upward = slope / scale, -1.0 / scale
    arm = np.stack([away - foot, z - profile.curve(foot)])
    gap = arm[0] * outward + arm[1] * upward
    beyond = (foot >= profile.radius_mm[-1]) & (away > foot)
    gap = np.where(beyond, np.hypot(*arm), gap)
    on_meridian = bend / scale**3
    along = on_meridian / np.maximum(1.0 + on_meridian * gap, 1e-6)
    off_axis = away > 1e-6 * profile.radius_mm[-1]
    around = np.where(off_axis, outward / np.where(off_axis, away, 1.0), along)
    radial = np.stack([np.where(off_axis, x, 1.0), np.where(off_axis, y, 0.0)]) / np.where(off_axis, away, 1.0)
    zero = np.zeros_like(gap)
    normal = np.stack([outward * radial[0], outward * radial[1], upward], axis=1)
    tangent = np.stack([-upward * radial[0], -upward * radial[1], outward], axis=1)
    ring = np.stack([-radial[1], radial[0], zero], axis=1)
    hessian = along[:, None, None] * _squared(tangent) + around[:, None, None] * _squared(ring)
    return gap, normal, hessian


def _squared(direction: Floats) -> Floats:
    """Dyad (n, 3, 3) of directions (n, 3) with themselves."""
    return np.asarray(direction[:, :, None] * direction[:, None, :])


def _foot(profile: DotProfile, away: Floats, z: Floats) -> Floats:
    """Radius (n,) of the nearest point of the meridian: that of its samples, then Newton's method beside it."""
    radius, tree = _samples(profile)
    start = radius[tree.query(np.column_stack([away, z]))[1]]
    low, high = np.maximum(start - radius[1], 0.0), np.minimum(start + radius[1], radius[-1])
    foot = start
    for _ in range(NEWTON_STEPS):
        depth, slope, bend = (profile.curve(foot, order) for order in range(3))
        growth = 1.0 + slope**2 + (depth - z) * bend
        step = (foot - away + (depth - z) * slope) / np.where(growth > 0.0, growth, 1.0 + slope**2)
        foot = np.clip(foot - step, low, high)
    return np.asarray(foot)


@lru_cache(maxsize=8)
def _samples(profile: DotProfile) -> "tuple[Floats, cKDTree]":
    """Radii (s,) at even distances, and the points of the meridian there."""
    from scipy.spatial import cKDTree

    points = profile.meridian_mm(SAMPLES)
    return points[:, 0], cKDTree(points)
