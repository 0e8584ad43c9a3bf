"""A recording as the reduced model's kernel takes it, and what the force sensor reads in the end."""

from collections.abc import Mapping

import numpy as np

from foundation.arrays import Floats, Ints
from solve.added import Motion
from solve.materials.prony import Prony
from solve.physics import Physics
from solve.reduced.rig import compliance_mm_per_N
from solve.reduced.time_stepping import BY_DEPTH, BY_FORCE


def check_recording(
    time_s: Floats, depth_mm: Floats | None, force_N: Floats | None, gap_mm: float
) -> tuple[Floats, Floats, int]:
    """Time (t,) in s, drive (t,) in mm from touch or in N, and its kind. ValueError for what is no recording."""
    if (depth_mm is None) == (force_N is None):
        raise ValueError("give either depth_mm or force_N")
    given = depth_mm if depth_mm is not None else force_N
    time, drive = np.ascontiguousarray(time_s, dtype=np.float64), np.array(given, dtype=np.float64)
    if time.ndim != 1 or drive.shape != time.shape or len(time) < 2:
        raise ValueError("time_s and the drive need the same length, at least 2")
    if not (np.isfinite(time).all() and np.isfinite(drive).all() and (np.diff(time) > 0.0).all()):
        raise ValueError("time_s must increase, and both it and the drive be finite")
    return time, drive - (gap_mm if depth_mm is not None else 0.0), BY_DEPTH if depth_mm is not None else BY_FORCE


def branches(viscosity: Mapping[str, Prony], layers: tuple[str, ...]) -> tuple[Floats, Floats, Ints]:
    """Relative moduli, times (s) and layer numbers (b,) of all Prony branches."""
    rows = [
        (g, tau, layers.index(name))
        for name, series in viscosity.items()
        for g, tau in zip(series.relative_moduli, series.relaxation_times, strict=True)
        if g > 0.0
    ]
    table = np.array(rows).reshape(-1, 3)
    return table[:, 0].copy(), table[:, 1].copy(), table[:, 2].astype(np.int64)


def sensor_force_N(drive: Floats, kind: int, path: Floats, contact: Floats, physics: Physics, motion: Motion) -> Floats:
    """Reading (t,) of the force sensor in N: the force that drives, that of the rig's spring, or of the contact.

    To either of the latter comes what the physics adds. motion : the drive.
    """
    if kind == BY_FORCE:
        return drive.copy()
    compliance = compliance_mm_per_N(physics)
    if compliance > 0.0:
        return np.asarray((drive - path) / compliance + physics.added_force_N(motion, dot_is_free=True))
    return np.asarray(contact + physics.added_force_N(motion, dot_is_free=False))


def second_differences(time: Floats, path: Floats) -> Floats:
    """Second derivative (t,) of a path (t,), at rest before and after."""
    step = np.diff(time)
    rate = np.concatenate([[0.0], np.diff(path) / step, [0.0]])
    width = np.concatenate([step[:1], 0.5 * (step[1:] + step[:-1]), step[-1:]])
    return np.asarray(np.diff(rate) / width)
