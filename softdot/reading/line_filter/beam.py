"""One step of all hypotheses: they move, meet columns of dots, are weighed by the charges, merged and thinned out.

The numbers of a hypothesis lie in rows of three arrays: state (h, 4) and choice (h, 6) by the names below, and drift
(h, n) of the charge of each channel. Columns of dots that were seen are kept sixteen at a time, four bits each, the
last one lowest; 8 stands for a column that passed without contact.
"""

from typing import NamedTuple

import numba as nb
import numpy as np

from foundation.arrays import Bools, Floats
from solve.compiled import piece

PLACE, LOG_SPEED, MEAN_LOG_SPEED, LOG_WEIGHT = range(4)
WAY, OFFSET, YAW, TOUCH, SEEN, COLUMNS = range(6)
UNSEEN, KEPT_COLUMNS = 8, 16
FORTH, STILL, BACK = 1, 0, -1
MOST_CHILDREN = 60_000
"""Room for the children of a step; those beyond are not looked at."""
MOST_OPTIONS = 12
CHANCE, CHANGE, NEW_WAY, ASIDE, TURN, CONTACT = range(6)
"""Columns of the ways in which a hypothesis may go on: log-probability, and what changes."""
PLACE_BIN_MM, SPEED_BIN = 0.12, 0.18
"""Within these two hypotheses are merged."""
OLD_MM = 1.8
"""Way behind the array's middle at which a column that passed without contact is looked at no more."""
LARGEST_RESIDUAL = 3.0
"""Standard deviations that the drift takes from one residual at most."""


class Sensor(NamedTuple):
    """What the charges are compared with: the table, its pitches, and gain, floor of the variance and drift of each
    channel (n,). drift_pC : standard deviation of the drift in a step.
    """

    charge: Floats
    within: Bools
    dot_pitch_mm: float
    cell_pitch_mm: float
    alive: Bools
    gain: Floats
    floor_pC2: Floats
    drift_pC: Floats


class HandMotion(NamedTuple):
    """Log-probabilities of a step, and constants of the weights.

    faster, jump : steps of the log-speed; relax, settle : shares of the way of log-speed and mean to each other in a
    step. rough : standard deviation of a charge over the charge; degrees : of Student's t. kept_log, most_kept : how
    far behind the best, and how many hypotheses are kept.
    """

    step_s: float
    faster: float
    jump: float
    relax: float
    settle: float
    log_jump: float
    log_stop: float
    log_go: float
    log_back: float
    log_forth: float
    log_aside: float
    log_turn: float
    log_lift: float
    log_touch: float
    log_blank: float
    rough: float
    degrees: float
    kept_log: float
    most_kept: int


@nb.njit(cache=True)
def column_of(columns, seen, number):  # type: ignore[no-untyped-def]
    """The pattern of a column by its number; blank before the first one and where it is kept no more."""
    back = seen - 1 - number
    if number < 0 or back >= KEPT_COLUMNS:
        return 0
    return (columns >> (4 * back)) & 15


@piece()
def _window(place, sensor):  # type: ignore[no-untyped-def]
    """Row of the table for a place, and number of the column behind."""
    rear = place - 0.5 * sensor.cell_pitch_mm
    cell = np.floor(rear / sensor.cell_pitch_mm)
    places = sensor.within.shape[0]
    row = min(int((rear / sensor.cell_pitch_mm - cell) * places), places - 1)
    return row, 2 * int(cell) + (1 if sensor.within[row] else 2)


@piece()
def _log_likelihood(predicted, measured, drift, sensor, settings):  # type: ignore[no-untyped-def]
    """Log-likelihood of the charges measured (n,) by Student's t, whose scale grows with the charge."""
    squares, tails = 1.0, 1.0
    for j in range(measured.shape[0]):
        if sensor.alive[j]:
            charge = sensor.gain[j] * predicted[j]
            variance = sensor.floor_pC2[j] + (settings.rough * charge) ** 2
            squares *= variance
            tails *= 1.0 + (measured[j] - drift[j] - charge) ** 2 / (settings.degrees * variance)
    return -0.5 * np.log(squares) - 0.5 * (settings.degrees + 1.0) * np.log(tails)


@nb.njit(cache=True)
def advance(state, choice, drift, measured, temper, may_touch, sensor, settings, room):  # type: ignore[no-untyped-def]
    """The hypotheses after a step with the charges measured (n,), and the logarithm of their evidence.

    temper : exponent of the likelihood. may_touch : whether lost contact may be found again. room : three arrays for
    children, state (m, 4), choice (m, 6) and number of the parent (m,).
    """
    made, made_choice, parent = room
    count, best = 0, -np.inf
    top = state[:, LOG_WEIGHT].max()
    options = np.empty((MOST_OPTIONS, 6))
    for h in range(state.shape[0]):
        number = _options(choice[h], options, may_touch, settings)
        for one in range(number):
            if state[h, LOG_WEIGHT] + options[one, CHANCE] < top - settings.kept_log or count > MOST_CHILDREN - 65:
                continue
            begin = count
            count = _children(state[h], choice[h], options[one], made, made_choice, count, sensor, settings)
            for child in range(begin, count):
                parent[child] = h
                row, first = _window(made[child, PLACE], sensor)
                if made_choice[child, TOUCH] == 1:
                    pattern = _pattern(made_choice[child], first)
                    predicted = sensor.charge[made_choice[child, YAW], row, made_choice[child, OFFSET], pattern]
                else:
                    predicted = sensor.charge[0, 0, 0, 0]
                made[child, LOG_WEIGHT] += temper * _log_likelihood(predicted, measured, drift[h], sensor, settings)
                best = max(best, made[child, LOG_WEIGHT])
    kept_state, kept_choice, kept_parent = _merged(made, made_choice, parent, count, best, settings)
    kept_drift = _drifted(kept_state, kept_choice, drift[kept_parent], measured, sensor, settings)
    return kept_state, kept_choice, kept_drift, _log_sum(kept_state[:, LOG_WEIGHT]) - _log_sum(state[:, LOG_WEIGHT])


@nb.njit(cache=True)
def weighed(state, choice, drift, measured, sensor, settings):  # type: ignore[no-untyped-def]
    """Beam after they were weighed by the charges measured (n,), without a motion."""
    made = state.copy()
    for h in range(state.shape[0]):
        row, first = _window(made[h, PLACE], sensor)
        pattern = _pattern(choice[h], first) if choice[h, TOUCH] == 1 else 0
        predicted = sensor.charge[choice[h, YAW], row, choice[h, OFFSET], pattern]
        made[h, LOG_WEIGHT] += _log_likelihood(predicted, measured, drift[h], sensor, settings)
    best = made[:, LOG_WEIGHT].max()
    kept_state, kept_choice, parent = _merged(made, choice, np.arange(len(made)), len(made), best, settings)
    return kept_state, kept_choice, drift[parent]


@nb.njit(cache=True)
def _log_sum(weights):  # type: ignore[no-untyped-def]
    top = weights.max()
    return top + np.log(np.exp(weights - top).sum())


@piece()
def _pattern(choice, first):  # type: ignore[no-untyped-def]
    """The pattern of both columns in the window; what passed without contact counts as blank."""
    rear = column_of(choice[COLUMNS], choice[SEEN], first)
    front = column_of(choice[COLUMNS], choice[SEEN], first + 1)
    return (rear & 7) | (front & 7) << 3


@nb.njit(cache=True)
def _options(choice, options, may_touch, settings):  # type: ignore[no-untyped-def]
    """Fill the ways in which a hypothesis may go on, and return their number."""
    way, touch = choice[WAY], choice[TOUCH]
    options[:, CHANGE] = 0.0
    options[:, NEW_WAY] = way
    options[:, ASIDE:CONTACT] = 0
    options[:, CONTACT] = touch
    options[0, CHANCE] = 0.0
    if way == STILL:
        options[1, CHANCE], options[1, NEW_WAY] = settings.log_go, FORTH
        options[2, CHANCE], options[2, NEW_WAY] = settings.log_back, BACK
        number = 3
    else:
        options[0, CHANCE] = np.log(2.0 / 3.0)
        for k in range(2):
            sign = 2 * k - 1
            options[1 + k, CHANCE], options[1 + k, CHANGE] = np.log(1.0 / 6.0), sign * settings.faster
            options[3 + k, CHANCE], options[3 + k, CHANGE] = settings.log_jump, sign * settings.jump
            options[5 + k, CHANCE], options[5 + k, ASIDE] = settings.log_aside, sign
            options[7 + k, CHANCE], options[7 + k, TURN] = settings.log_turn, sign
        options[9, CHANCE], options[9, NEW_WAY] = settings.log_stop, STILL
        options[10, CHANCE] = settings.log_back if way == FORTH else settings.log_forth
        options[10, NEW_WAY] = -way
        number = 11
    if touch == 1:
        options[number, CHANCE], options[number, CONTACT] = settings.log_lift, 0
        number += 1
    elif may_touch:
        options[number, CHANCE], options[number, CONTACT] = settings.log_touch, 1
        number += 1
    return number


@nb.njit(cache=True)
def _children(state, choice, option, made, made_choice, count, sensor, settings):  # type: ignore[no-untyped-def]
    """Add a hypothesis that went on in one way, once for each pattern that a new column may have; their number."""
    offset, yaw = choice[OFFSET] + int(option[ASIDE]), choice[YAW] + int(option[TURN])
    if not (0 <= offset < sensor.charge.shape[2] and 0 <= yaw < sensor.charge.shape[0]):
        return count
    way, touch = int(option[NEW_WAY]), int(option[CONTACT])
    speed, mean = state[LOG_SPEED], state[MEAN_LOG_SPEED]
    if way != STILL:
        speed = mean if choice[WAY] == STILL else speed + settings.relax * (mean - speed) + option[CHANGE]
        mean += settings.settle * (speed - mean)
    place = state[PLACE] + way * np.exp(speed) * settings.step_s
    first = _window(place, sensor)[1]
    columns, seen = choice[COLUMNS], choice[SEEN]
    while seen <= first:
        columns, seen = columns << 4 | UNSEEN, seen + 1
    is_new = seen == first + 1
    if is_new:
        columns, seen = columns << 4 | UNSEEN, seen + 1
    rear, front = column_of(columns, seen, first), column_of(columns, seen, first + 1)
    near = first // 2 * sensor.cell_pitch_mm + first % 2 * sensor.dot_pitch_mm > place - OLD_MM
    rears = 8 if touch == 1 and rear == UNSEEN and near else 1
    fronts = 8 if touch == 1 and front == UNSEEN else 1
    for a in range(rears):
        for b in range(fronts):
            chance, own = state[LOG_WEIGHT] + option[CHANCE], columns
            if is_new and touch == 0:
                chance += settings.log_blank  # as much as a blank one, so that what is blank needs no lost contact
            if rears == 8:
                own = own ^ ((UNSEEN ^ a) << (4 * (seen - 1 - first)))
                chance += settings.log_blank if a == 0 else np.log((1.0 - np.exp(settings.log_blank)) / 7.0)
            if fronts == 8:
                own = own ^ ((UNSEEN ^ b) << (4 * (seen - 2 - first)))
                chance += settings.log_blank if b == 0 else np.log((1.0 - np.exp(settings.log_blank)) / 7.0)
            made[count, PLACE], made[count, LOG_SPEED], made[count, MEAN_LOG_SPEED] = place, speed, mean
            made[count, LOG_WEIGHT] = chance
            made_choice[count, WAY], made_choice[count, OFFSET], made_choice[count, YAW] = way, offset, yaw
            made_choice[count, TOUCH], made_choice[count, SEEN], made_choice[count, COLUMNS] = touch, seen, own
            count += 1
    return count


@nb.njit(cache=True)
def _merged(made, made_choice, parent, count, best, settings):  # type: ignore[no-untyped-def]
    """The children that are good enough, and one of all that agree, with the sum of their weights."""
    size = 64
    while size < 2 * count:
        size *= 2
    slots = np.full(size, -1, dtype=np.int64)
    keys, kept = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    weight = np.empty(count)
    number = 0
    for child in range(count):
        if made[child, LOG_WEIGHT] < best - settings.kept_log:
            continue
        key = _key(made[child], made_choice[child])
        slot = key & (size - 1)
        while slots[slot] >= 0 and keys[slots[slot]] != key:
            slot = (slot + 1) & (size - 1)
        own = np.exp(made[child, LOG_WEIGHT] - best)
        if slots[slot] < 0:
            slots[slot], keys[number], kept[number], weight[number] = number, key, child, own
            number += 1
        else:
            same = slots[slot]
            weight[same] += own
            if made[child, LOG_WEIGHT] > made[kept[same], LOG_WEIGHT]:
                kept[same] = child
    least = 0.0
    if number > settings.most_kept:
        least = np.partition(weight[:number], number - settings.most_kept)[number - settings.most_kept]
    chosen = np.flatnonzero(weight[:number] >= least)
    state, choice = np.empty((len(chosen), 4)), np.empty((len(chosen), 6), dtype=np.int64)
    parents = np.empty(len(chosen), dtype=np.int64)
    for k in range(len(chosen)):
        state[k], choice[k] = made[kept[chosen[k]]], made_choice[kept[chosen[k]]]
        state[k, LOG_WEIGHT] = best + np.log(weight[chosen[k]])
        parents[k] = parent[kept[chosen[k]]]
    return state, choice, parents


@piece()
def _key(state, choice):  # type: ignore[no-untyped-def]
    """A number that hypotheses share which agree in all that decides how they go on."""
    key = np.int64(np.floor(state[PLACE] / PLACE_BIN_MM))
    for part in (
        np.int64(np.floor(state[LOG_SPEED] / SPEED_BIN)), choice[WAY], choice[OFFSET], choice[YAW], choice[TOUCH],
        choice[SEEN], choice[COLUMNS] & 0xFFFF,
    ):  # fmt: skip
        key = (key ^ (key >> 29)) * np.int64(0x3F58476D1CE4E5B9) + part + np.int64(0x1E3779B97F4A7C15)
    return key ^ (key >> 31)


@nb.njit(cache=True)
def _drifted(state, choice, drift, measured, sensor, settings):  # type: ignore[no-untyped-def]
    """The drifts (h, n) after a step of a steady Kalman filter."""
    for h in range(state.shape[0]):
        row, first = _window(state[h, PLACE], sensor)
        pattern = _pattern(choice[h], first) if choice[h, TOUCH] == 1 else 0
        for j in range(measured.shape[0]):
            charge = sensor.gain[j] * sensor.charge[choice[h, YAW], row, choice[h, OFFSET], pattern, j]
            variance = sensor.floor_pC2[j] + (settings.rough * charge) ** 2
            residual = measured[j] - drift[h, j] - charge
            most = LARGEST_RESIDUAL * np.sqrt(variance)
            gain = sensor.drift_pC[j] / np.sqrt(sensor.drift_pC[j] ** 2 + variance)
            drift[h, j] += gain * min(max(residual, -most), most)
    return drift


@nb.njit(cache=True)
def predicted_charges(state, choice, sensor):  # type: ignore[no-untyped-def]
    """Charges (n,) of one hypothesis, without gain and drift."""
    row, first = _window(state[PLACE], sensor)
    pattern = _pattern(choice, first) if choice[TOUCH] == 1 else 0
    return sensor.charge[choice[YAW], row, choice[OFFSET], pattern].astype(np.float64)
