"""Whether a drive can be what it is called: its sign, its zero, its size, and a force that drifts.

These checks come before all that a diagnosis asks for: with a wrong sign rests are presses, and noise is sought in
vain.
"""

from pathlib import Path

import numpy as np

from diagnose.signals.phases import rest_level
from diagnose.signals.recording import Run, Specimen
from foundation.arrays import Bools, Floats
from foundation.errors import InputError

OPPOSED_CORRELATION = -0.5
"""Correlation of a displacement with a force below which one of the two has the wrong sign."""
LARGEST_ADHESION_RATIO = 2.0
"""Pull over push of a dot: one that is let go may adhere, but hardly with more than this."""
LOWEST_RANGE_SHARE, FLAT_SLOPE_SHARE = 0.15, 0.1
"""Lowest share of the drive's range, and the slope of the force there over that of the whole press.

A force with less slope has not begun to rise: that of a sphere has two fifths (Hertz), that of a flat punch all.
"""
SHALLOWEST_MM = 0.002
"""By which a moulded surface gives way before it bears."""
FASTEST_MM_PER_S = 3e3
"""The range of a drive over the time of its whole run: faster is an impact, and no press."""
DRIFT_RANGE_SHARE = 0.1  # of the range of a force, between the samples before a press and behind it


def refuse_unlike_drive(run: Run, path: Path, specimen: Specimen | None, height_mm: float) -> None:
    """Refuse a drive of the wrong sign, without a zero at the first touch, or deeper than the stack is high.

    InputError.

    height_mm : of the segment, infinite where it is not known.
    """
    where = f"recording '{path}', column"
    _refuse_opposed_signs(run, where)
    if specimen is not None:
        _refuse_wrong_sign_of_coupon(run, specimen, where)
        return
    force = run.channels.get("force_N")
    if force is not None and _has_wrong_sign(_measured_values(run, "force_N"), LARGEST_ADHESION_RATIO):
        raise InputError(
            f"{where} force_N: goes down to {np.nanmin(force):.3g} N and up to {np.nanmax(force):.3g} N only; force "
            "counts positive in compression, turn its sign"
        )
    if run.drive == "displacement_mm":
        _refuse_too_fast(run, where)
        _refuse_off_zero(run, where, height_mm)


def drive_suspicions(run: Run, path: Path) -> list[str]:
    """Sentences on a displacement that rests inside the segment, and on a force that drifts."""
    if run.drive != "displacement_mm":
        return []
    level, noise = rest_level(run.drive_values)
    if (deepest := float(run.drive_values.max())) < SHALLOWEST_MM:
        return [
            f"recording '{path}', column displacement_mm: reaches {deepest:.3g} mm only, less than a surface gives way "
            "before it bears; is it in millimetres?"
        ]
    said = _drift_sentences(run, path) if "force_N" in run.channels else []
    if level > max(5.0 * noise, 0.05 * float(np.ptp(run.drive_values))):
        said.append(
            f"recording '{path}', column displacement_mm: is {level:.3g} mm before it moves, which is inside the "
            "segment; it counts from the first touch, is its zero or its sign wrong?"
        )
    return said


def _drift_sentences(run: Run, path: Path) -> list[str]:
    """Sentences on a force that differs after the presses from that before them, both clear of the dot; at most one."""
    clear = run.usable("force_N") & (run.drive_values < 0.0)
    touching = np.flatnonzero(run.drive_values > 0.0)
    if not len(touching):
        return []
    number = np.arange(len(clear))
    before, after = clear & (number < touching[0]), clear & (number > touching[-1])
    if min(before.sum(), after.sum()) < 8:
        return []
    force = run.channels["force_N"]
    first, last = float(np.mean(force[before])), float(np.mean(force[after]))
    whole = float(np.ptp(force[run.usable("force_N")]))
    if min(abs(first), abs(last)) > max(whole, 3.0 * run.nuisance.get("offset_N", 0.0)):
        return [f"recording '{path}', column force_N: is {first:.3g} N while nothing touches; is its zero off?"]
    if abs(last - first) < DRIFT_RANGE_SHARE * whole:
        return []
    return [
        f"recording '{path}', column force_N: drifts from {first:.3g} to {last:.3g} N while nothing touches, which is "
        f"more than {DRIFT_RANGE_SHARE:.0%} of its range"
    ]


def _measured_values(run: Run, name: str) -> Floats:
    return run.channels[name][run.valid[name]]


def _both_measured(run: Run) -> Bools:
    """Flags (t,) of samples at which displacement and force were measured; none where one was not recorded."""
    if not {"displacement_mm", "force_N"} <= run.channels.keys():
        return np.zeros(len(run.time_s), dtype=bool)
    return run.valid["displacement_mm"] & run.valid["force_N"]


def _refuse_opposed_signs(run: Run, where: str) -> None:
    there = _both_measured(run)
    if there.sum() < 3:
        return
    displacement, force = run.channels["displacement_mm"][there], run.channels["force_N"][there]
    if min(np.ptp(displacement), np.ptp(force)) == 0.0:
        return
    correlation = float(np.corrcoef(displacement, force)[0, 1])
    if correlation < OPPOSED_CORRELATION:
        raise InputError(
            f"{where} displacement_mm: runs against force_N (correlation {correlation:.2f}): displacement counts "
            "positive into the segment or along the test, force positive in it; turn the sign of one of them"
        )


def _refuse_too_fast(run: Run, where: str) -> None:
    speed = float(np.ptp(run.drive_values)) / float(run.time_s[-1] - run.time_s[0])
    if speed > FASTEST_MM_PER_S:
        raise InputError(
            f"{where} time_s: displacement_mm goes {np.ptp(run.drive_values):.3g} mm in "
            f"{run.time_s[-1] - run.time_s[0]:.3g} s by it, which is no press; is it in seconds?"
        )


def _has_wrong_sign(values: Floats, factor: float) -> bool:
    """Whether values (t,) go down instead of up, from their beginning and from zero, by more than a factor."""
    low, high, first = float(values.min()), float(values.max()), float(np.median(values[:5]))
    return -low > factor * max(high, 0.0) and first - low > factor * (high - first)


def _refuse_wrong_sign_of_coupon(run: Run, specimen: Specimen, where: str) -> None:
    values = _measured_values(run, run.drive)
    if specimen.kind != "shear" and _has_wrong_sign(values, 1.0):
        raise InputError(
            f"{where} {run.drive}: goes down to {values.min():.4g} and up to {values.max():.4g} only; in a "
            f"{specimen.kind} test displacement_mm and force_N both count positive, turn their signs"
        )


def _refuse_off_zero(run: Run, where: str, height_mm: float) -> None:
    """InputError for a displacement deeper than the segment, or far from 0 where the force has not begun to rise."""
    drive = run.drive_values
    deepest = float(drive.max())
    if deepest > height_mm:
        raise InputError(
            f"{where} displacement_mm: reaches {deepest:.4g} mm, the segment is {height_mm:.4g} mm high; displacement "
            "counts from the first touch, so its zero or its unit is off"
        )
    there = _both_measured(run)
    _, noise = rest_level(drive)
    if float(drive.min()) <= max(5.0 * noise, 0.05 * np.ptp(drive)) or there.sum() < 3:
        return
    displacement, force = drive[there], run.channels["force_N"][there]
    low = displacement < displacement.min() + LOWEST_RANGE_SHARE * np.ptp(displacement)
    if low.sum() < 8 or np.ptp(displacement[low]) == 0.0:
        return
    slope, whole = (float(np.polyfit(displacement[at], force[at], 1)[0]) for at in (low, np.ones_like(low)))
    if slope < FLAT_SLOPE_SHARE * whole:
        raise InputError(
            f"{where} displacement_mm: is {displacement.min():.4g} mm where force_N has not begun to rise; it counts "
            "from the first touch, so its zero is off"
        )
