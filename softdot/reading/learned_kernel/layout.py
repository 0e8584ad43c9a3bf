"""What recordings say of their own layout: time and channels exchanged, channels of a second one in another order."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from foundation.arrays import Floats, Ints
from softdot.reading.learned_kernel.courses import courses_of
from softdot.reading.learned_kernel.touches import Touches

ROUGHER = 2.0
"""Mean square of steps from sample to sample over that from channel to channel above which the axes seem exchanged."""
LEAST_COMMON, NEARER = 3, 2.0 / 3.0
"""Cells that two files must have in common, and share of a distance below which another channel is the nearer one."""


def layout_warnings(files: list[Touches], names: list[str]) -> list[str]:
    """Sentences about files of one sensor (join_touches) that seem to hold their values in another layout."""
    found = []
    for one, name in zip(files, names, strict=True):
        over_time, over_channels = (_roughness(one.taxels, axis) for axis in (1, 2))
        if over_time > ROUGHER * over_channels:
            found.append(
                f"touches '{name}': taxels {one.taxels.shape} change {over_time / over_channels:.1f} times as much "
                "from sample to sample as from channel to channel: time and channels seem exchanged; they must be "
                "(touch, time, channel)"
            )
    for one, name in zip(files[1:], names[1:], strict=True):
        order = channel_order(files[0], one)
        moved = np.flatnonzero(order != np.arange(len(order)))
        if len(moved):
            found.append(
                f"touches '{name}': channels {_numbers(moved)} look like channels {_numbers(order[moved])} of "
                f"'{names[0]}': their order seems to be another one, and what is learned from both is wrong then"
            )
    return found


def _numbers(channels: Ints) -> str:
    return ", ".join(str(int(one) + 1) for one in channels)


def _roughness(taxels: Floats, axis: int) -> float:
    """Mean square of the steps along an axis of what touches (n, t, c) differ in."""
    steps = np.diff(taxels - taxels.mean(axis=0), axis=axis)
    return float(np.mean(steps**2)) if steps.size else np.inf


def channel_order(first: Touches, second: Touches) -> Ints:
    """For each channel (c,) of the second recording the one of the first that it is most like, from 0 on.

    By mean courses of the cells that both hold, and the assignment of least squared distance in all. Channels that are
    not plainly nearer to another one than to their own keep their place, all of them where too few cells are common.
    """
    same = np.arange(first.taxels.shape[2])
    if first.cells is None or second.cells is None:
        return same
    common = np.intersect1d(first.cells, second.cells)
    if len(common) < LEAST_COMMON:
        return same
    one, other = _mean_courses(first, common), _mean_courses(second, common)
    distance = ((one[:, :, None] - other[:, None, :]) ** 2).sum(axis=0)
    row, column = linear_sum_assignment(distance)
    order = np.empty_like(row)
    order[column] = row
    is_nearer = distance[order, same] < NEARER * distance[same, same]
    return np.where(is_nearer, order, same)


def _mean_courses(touches: Touches, cells: Ints) -> Floats:
    """Mean courses of cells, one after the other, (k * t, c)."""
    courses = courses_of(touches, keep_rest=False, place_range_mm=None)
    return np.concatenate([courses[touches.cells == cell].mean(axis=0) for cell in cells])
