"""What a press gives at any time of its waveform, between the states that were solved.

A leg is a stretch of the press over which force and charge are smooth: the way in, a hold, a way back, a stretch of a
slide. On each they follow cubics whose slope at a state is that of the parabola through it and its neighbours (Bessel's
interpolation: de Boor, A Practical Guide to Splines, 1978, chapter IV). It is linear, so that charges which add up in
the states add up between them; and local: where contact grows node by node, splines of higher order ring, and the
read-out is their slope. Over the drive where that rises or falls, as force and charge have no corner there when its
rate has; else over time.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from foundation.arrays import Floats
from solve.model import Press
from solve.result import PressResult, Trace
from solve.solution.schedule import corners_s, duration_s, first_time_s, fraction, slide_s, stretches_s
from solve.waveform import Waveform

CORNER_RATE_RATIO = 2.0
"""Ratio of two rates of loading from which relaxing stress has a corner between them that counts."""
CORNER_RATE_SHARE = 0.3
"""Of the fastest rate: below it no change counts, such as near the top of a sampled sine."""
COORDINATE_ROUND_OFF = 1e-9
EVEN_TOUCH_GROWTH = 0.1
Coordinate = Callable[[Floats], Floats]
Interpolation = Callable[[Floats, Floats], Coordinate]


@dataclass(frozen=True)
class PressLeg:
    """A stretch of a press from begin_s to end_s; along(time) : its coordinate, which grows or falls from end to end.

    at (s,) : the coordinates of its states; known (s, k) : what is known there, its second column the force.
    through : the curves through them.
    """

    begin_s: float
    end_s: float
    along: Coordinate
    at: Floats
    known: Floats
    through: "Interpolation" = field(default_factory=lambda: cubic_curve)

    def with_straight_lines(self) -> "PressLeg":
        """The leg with straight lines between its states; between two only, a parabola from the first."""
        if len(self.at) != 2:
            return replace(self, through=straight_curve)
        middle, quarter = 0.5 * (self.at[0] + self.at[1]), 0.75 * self.known[0] + 0.25 * self.known[1]
        known = np.vstack([self.known[0], quarter, self.known[1]])
        return replace(self, at=np.array([self.at[0], middle, self.at[1]]), known=known)

    def with_soft_touch(self) -> "PressLeg":
        """The leg without slope at an end without force, as far as it bends there: so a round dot touches, and no flat
        one.
        """
        at, known = _with_touch_image(self.at, self.known)
        at, known = _with_touch_image(at[::-1], known[::-1])
        return replace(self, at=at[::-1], known=known[::-1])

    @cached_property
    def curve(self) -> Coordinate:
        """Function from coordinates (n,) of the leg to values (n, k)."""
        return self.through(self.at, self.known)

    def values_at(self, time_s: Floats) -> Floats:
        """Values (n, k) at times (n,) of this leg."""
        low, high = min(self.at[0], self.at[-1]), max(self.at[0], self.at[-1])
        return self.curve(np.clip(self.along(time_s), low, high))


def _with_touch_image(at: Floats, known: Floats) -> tuple[Floats, Floats]:
    """States (s,) and (s, k), with the image of the second in the first before them, where they begin without force.

    What grows evenly has an odd image; what grows by EVEN_TOUCH_GROWTH more or less from the second to the third has an
    even one.
    """
    if len(at) < 2 or known[0, 1] != 0.0:
        return at, known
    first, even = known[1] - known[0], np.ones(known.shape[1])
    if len(at) > 2:
        more = (known[2] - known[1]) * (at[1] - at[0]) / (at[2] - at[1]) / np.where(first == 0.0, 1.0, first) - 1.0
        even = np.minimum(np.abs(more) / EVEN_TOUCH_GROWTH, 1.0)
    image = known[0] + (2.0 * even - 1.0) * first
    return np.append(2.0 * at[0] - at[1], at), np.vstack([image, known])


def _in_rising_order(at: Floats, known: Floats) -> tuple[Floats, Floats]:
    """States (s,) and (s, k) in rising order, none of them twice."""
    if at[-1] < at[0]:
        at, known = at[::-1], known[::-1]
    fresh = np.append(True, np.diff(at) > COORDINATE_ROUND_OFF * max(at[-1] - at[0], COORDINATE_ROUND_OFF))
    return at[fresh], known[fresh]


def straight_curve(at: Floats, known: Floats) -> Coordinate:
    """Straight lines through what is known (s, k) at rising or falling (s,): values (n, k) at places (n,)."""
    at, known = _in_rising_order(at, known)
    return lambda where: np.column_stack([np.interp(where, at, column) for column in known.T])


def cubic_curve(at: Floats, known: Floats) -> Coordinate:
    """The cubic curve through what is known (s, k) at rising or falling (s,): values (n, k) at places (n,)."""
    at, known = _in_rising_order(at, known)
    if len(at) == 1:
        return lambda where: np.repeat(known, len(where), axis=0)
    slopes = np.gradient(known, at, axis=0, edge_order=2 if len(at) > 2 else 1)
    change, size = np.abs(np.diff(known[:, 1:], axis=0)), np.abs(known[:, 1:]).max(axis=0)
    idle = (change <= COORDINATE_ROUND_OFF * size).all(axis=1)
    slopes[np.append(idle, False) | np.append(False, idle)] = 0.0  # clear of the segment nothing swings below zero
    curve = CubicHermiteSpline(at, known, slopes)
    return lambda where: np.asarray(curve(where))


def press_legs(result: PressResult, press: Press) -> list[PressLeg]:
    """The legs of a press as far as it went; known : depth in m, force in N and charges in C, (s, 2 + e)."""
    if result.follows_time or len(result.trace.time_s) == 1:
        return timed_legs(result.trace, press)
    return _untimed_legs(result.progress, press, press.waveform or Waveform(), _signals(result.trace))


def timed_legs(trace: Trace, press: Press) -> list[PressLeg]:
    """Legs of a press that followed its waveform: between the corners at which its rate turns or changes much."""
    known, begin = _signals(trace), float(trace.time_s[0])
    if len(known) == 1:
        return [PressLeg(begin, begin, lambda time: time, np.array([begin]), known)]
    return _legs_between_turns(trace.time_s, press, press.waveform or Waveform(), known)


def _signals(trace: Trace) -> Floats:
    """Depth in m, force in N and charges in C of every state, (s, 2 + e)."""
    return np.column_stack([trace.indentation_m, trace.reaction_force_N, trace.film_charge_C])


def _untimed_legs(done: Floats, press: Press, waveform: Waveform, known: Floats) -> list[PressLeg]:
    """Legs where time does not matter: the waveform passes the states of the way in, up and down; then it slides.

    done : (t,) progress of the states as in PressResult.
    """
    pressed = done <= 1.0 + COORDINATE_ROUND_OFF
    begin, end = float(corners_s(waveform)[0]), duration_s(waveform)
    reached = float(done[pressed][-1])
    largest = float(fraction(waveform, corners_s(waveform)).max())
    if not reached >= largest * (1.0 - COORDINATE_ROUND_OFF):  # it stopped short
        end = float(first_time_s(waveform, np.array([reached]))[0])
    legs = [PressLeg(begin, end, lambda time: fraction(waveform, time), done[pressed], known[pressed])]
    for number, (start, stop) in enumerate(pairwise(slide_s(press)), start=1):
        on = (done >= number - COORDINATE_ROUND_OFF) & (done <= number + 1 + COORDINATE_ROUND_OFF)
        if on.sum() < 2:
            break
        leg_s = stop - start
        stop = start + leg_s * min(1.0, float(done[on][-1]) - number)
        legs.append(PressLeg(start, stop, lambda time: time, start + leg_s * (done[on] - number), known[on]))
    return legs


def _legs_between_turns(time_s: Floats, press: Press, waveform: Waveform, known: Floats) -> list[PressLeg]:
    """Legs between the turns of the waveform and the waypoints of a slide, with the states of each."""
    edges = np.union1d(_turns_s(waveform), slide_s(press)) if press.path_xy_mm else _turns_s(waveform)
    begin, end = time_s[0], time_s[-1]
    apart = np.diff(edges, prepend=-np.inf) > COORDINATE_ROUND_OFF * (end - begin)
    edges = np.append(edges[apart & (edges < end - COORDINATE_ROUND_OFF * (end - begin))], end)
    legs = []
    for begin, stop in pairwise(edges):
        slack = COORDINATE_ROUND_OFF * (stop - begin)
        on = (time_s >= begin - slack) & (time_s <= stop + slack)
        drive = fraction(waveform, time_s[on])
        steps = np.diff(drive)
        one_way = bool((steps > COORDINATE_ROUND_OFF).all() or (steps < -COORDINATE_ROUND_OFF).all())
        along: Coordinate = (lambda time: fraction(waveform, time)) if one_way else (lambda time: time)
        legs.append(PressLeg(float(begin), float(stop), along, drive if one_way else time_s[on], known[on]))
    return legs


def _turns_s(waveform: Waveform) -> Floats:
    """Times (n,) of the first and the last corner, and of those at which the rate turns or changes by a factor."""
    corners = stretches_s(waveform)
    rate = np.diff(fraction(waveform, corners)) / np.diff(corners)
    before, after = rate[:-1], rate[1:]
    fast, slow = np.maximum(np.abs(before), np.abs(after)), np.minimum(np.abs(before), np.abs(after))
    changes = (fast > CORNER_RATE_RATIO * slow) & (fast > CORNER_RATE_SHARE * fast.max(initial=0.0))
    turns = (before * after <= 0.0) & (fast > 0.0) | changes
    return np.asarray(corners[np.concatenate([[True], turns, [True]])])
