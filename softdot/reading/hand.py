"""The motion of a hand along a line: a speed that wanders, pauses, ways back, a skewed path, contact that is lost.

The logarithm of the speed is an Ornstein-Uhlenbeck process (Phys. Rev. 36 (1930) 823),
    d ln v = -(ln v - ln v0) dt / T + c sqrt(2 / T) dW,
with standard deviation c and correlation time T.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from softdot.reading.conditions import ReadingConditions

PAUSE_S = (0.3, 1.5)
"""Shortest and longest pause."""
WAY_BACK_MM = (3.0, 10.0)
"""Shortest and longest way back."""
WANDER_HZ = 0.3
"""Bandwidth of the wander across the line."""
LIFTED_MM, LIFT_S = -0.05, 0.02
"""Depth of an array without contact, and the time in which it is lifted and set down."""


@dataclass(frozen=True)
class HandCourse:
    """Times (t,), evenly spaced, and the place (t,) along a way that begins at 0."""

    time_s: Floats
    place_mm: Floats


def hand_course(way_mm: float, step_s: float, conditions: ReadingConditions, random: np.random.Generator) -> HandCourse:
    """The course of a hand over a way, with the pauses and ways back of the conditions at random places."""
    backs = np.sort(random.uniform(0.1, 0.9, how_many(conditions.ways_back, random))) * way_mm
    lengths = np.minimum(random.uniform(*WAY_BACK_MM, len(backs)), 0.9 * backs)
    turns, travelled = [0.0], [0.0]
    for place, length in zip(backs, lengths, strict=True):
        for goal in (place, place - length):
            travelled.append(travelled[-1] + abs(goal - turns[-1]))
            turns.append(goal)
    travelled.append(travelled[-1] + way_mm - turns[-1])
    turns.append(way_mm)
    moved = _moved_mm(travelled[-1], step_s, conditions, random)
    pauses = how_many(conditions.pauses, random)
    begins = np.sort(random.uniform(0.1, 0.9, pauses)) * len(moved)
    lasting = random.uniform(*PAUSE_S, pauses) / step_s
    still = np.zeros(len(moved))
    still[begins.astype(int)] = lasting
    number = np.arange(len(moved)) + np.concatenate([[0.0], np.cumsum(still)[:-1]])
    steps: Floats = np.arange(int(number[-1]) + 1, dtype=np.float64)
    even = np.interp(steps, number, moved)
    return HandCourse(step_s * steps, np.interp(even, travelled, turns))


def how_many(mean: float, random: np.random.Generator) -> int:
    """A number of events: the mean where it is whole, else one of its neighbours, so that their mean is that."""
    return int(mean) + int(mean % 1.0 > 0.0 and random.random() < mean % 1.0)


def _moved_mm(way_mm: float, step_s: float, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Way (t,) that was travelled, forth and back, until all of it is done."""
    from scipy.signal import lfilter

    if conditions.speed_cv == 0.0:
        count = int(np.ceil(way_mm / conditions.speed_mm_per_s / step_s)) + 1
        return np.asarray(conditions.speed_mm_per_s * step_s * np.arange(count))
    spread, fade = conditions.speed_cv, float(np.exp(-step_s / conditions.speed_time_s))
    moved: Floats = np.zeros(1)
    level = random.standard_normal()
    while moved[-1] < way_mm:
        count = 256 + int(1.2 * (way_mm - moved[-1]) / conditions.speed_mm_per_s / step_s)
        kicks = np.sqrt(1.0 - fade**2) * random.standard_normal(count)
        wander = np.asarray(lfilter([1.0], [1.0, -fade], kicks, zi=[fade * level])[0])
        level = float(wander[-1])
        speed = conditions.speed_mm_per_s * np.exp(spread * wander)
        moved = np.concatenate([moved, moved[-1] + step_s * np.cumsum(speed)])
    end = int(np.searchsorted(moved, way_mm))
    return np.minimum(moved[: end + 1], way_mm)


def wander_mm(count: int, step_s: float, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Slow wander (t,) across the line with the standard deviation of the conditions."""
    if conditions.wander_mm == 0.0:
        return np.zeros(count)
    slow = slow_process(count, 2.0 * np.pi * WANDER_HZ * step_s, random)
    return np.asarray(conditions.wander_mm * np.clip(slow, -3.0, 3.0))


def slow_process(count: int, share: float, random: np.random.Generator) -> Floats:
    """A process (t,) with standard deviation 1: white noise behind two low-passes; share : step over their time."""
    from scipy.signal import lfilter

    fade, warm = float(np.exp(-share)), min(int(10.0 / share), 200_000)
    once = lfilter([1.0 - fade], [1.0, -fade], random.standard_normal(count + warm))
    slow = lfilter([1.0 - fade], [1.0, -fade], once)[warm:]
    return np.asarray(slow / np.sqrt((1.0 - fade) ** 4 * (1.0 + fade**2) / (1.0 - fade**2) ** 3))


def lift_share(time_s: Floats, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Share (t,) from 0 to 1 by which the array is lifted from the line."""
    lifted = np.zeros(len(time_s))
    for _ in range(how_many(conditions.contact_losses, random)):
        begin = random.uniform(0.15, 0.85) * time_s[-1]
        outside = np.maximum(begin - time_s, time_s - begin - conditions.contact_loss_s)
        lifted = np.maximum(lifted, np.clip(1.0 - outside / LIFT_S, 0.0, 1.0))
    return lifted
