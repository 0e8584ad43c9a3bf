"""One step of all hypotheses: they move, meet columns of dots, are weighed by the charges, merged and thinned out."""

from typing import NamedTuple

import numba as nb
import numpy as np

from foundation.arrays import Bools, Floats
from softdot.reading.line_filter.hypothesis_arrays import (
    BACK,
    COLUMNS,
    FORTH,
    HEIGHT,
    KEPT_HEIGHTS,
    LEVEL,
    LOG_SPEED,
    LOG_WEIGHT,
    MEAN_LOG_SPEED,
    OFFSET,
    PLACE,
    ROWS,
    SEEN,
    SPREAD,
    STILL,
    TOUCH,
    UNSEEN,
    WAY,
    YAW,
    column_of,
    kind_before,
)
from softdot.reading.line_filter.merging import merged
from solve.compiled import MATH, piece

MOST_CHILDREN = 60_000
"""Room for the children of a step; those beyond are not looked at."""
MOST_OPTIONS = 12
RARE_STEPS = 3
"""What a hand does rarely is tried in one of so many steps, as often as if it were tried in all of them."""
CHANCE, CHANGE, NEW_WAY, ASIDE, TURN, CONTACT = range(6)
"""Columns of the ways in which a hypothesis may go on: log-probability, and what changes."""
OLD_MM = 1.8
"""Way behind the array's middle at which a column that passed without contact is looked at no more."""
LARGEST_RESIDUAL = 3.0
"""Standard deviations that the drift takes from one residual at most."""
LEAST_SPREAD = 0.04**2
"""Least variance of a height."""
REAR, FRONT = 1, 2
"""Bits of the columns in the window that a hypothesis meets for the first time."""


class Sensor(NamedTuple):
    """What the charges are compared with: charges of single dots, what dots beside each other add, pitches, and gain,
    floor of the variance and drift of each channel (n,).

    drift_pC, bend_pC : standard deviations in a step of the walk of the drift, and of its way per step.
    """

    lone: Floats
    beside: Floats
    within: Bools
    dot_pitch_mm: float
    cell_pitch_mm: float
    alive: Bools
    gain: Floats
    floor_pC2: Floats
    drift_pC: Floats
    bend_pC: Floats


class HandMotion(NamedTuple):
    """Log-probabilities of a step, and constants of the weights.

    faster, jump : steps of the log-speed; relax, settle : shares of the way of log-speed and mean to each other in a
    step. log_blank, log_dots (4,) : of a blank column, and of each other pattern, by kind_before. log_unseen :
    of one that passes without contact. height, height_spread : mean and variance of the height of dots, as shares of
    the nominal charge. rough : standard deviation of a charge over the charge; degrees : of Student's t. kept_log,
    most_kept : how far behind the best, and how many hypotheses are kept.
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
    log_blank: Floats
    log_dots: Floats
    log_unseen: float
    height: float
    height_spread: float
    rough: float
    degrees: float
    kept_log: float
    most_kept: int


@piece()
def _window(place, sensor):  # type: ignore[no-untyped-def]
    """Row of the table for a place, and number of the column behind."""
    rear = place - 0.5 * sensor.cell_pitch_mm
    cell = np.floor(rear / sensor.cell_pitch_mm)
    places = sensor.within.shape[0]
    row = min(int((rear / sensor.cell_pitch_mm - cell) * places), places - 1)
    return row, 2 * int(cell) + (1 if sensor.within[row] else 2)


@piece()
def _take_heights(memory, h, first, pattern, fresh, settings, found):  # type: ignore[no-untyped-def]
    """Fill number, height and spread (4, 6) of the dots of a pattern in the window, and return how many these are."""
    count = 0
    for side in range(2):
        slot = ROWS * ((first + side) & (KEPT_HEIGHTS - 1))
        for row in range(ROWS):
            dot = ROWS * side + row
            if pattern >> dot & 1:
                found[0, count] = dot
                if fresh >> side & 1:
                    found[1, count], found[2, count] = settings.height, settings.height_spread
                else:
                    found[1, count], found[2, count] = memory[h, HEIGHT + slot + row], memory[h, SPREAD + slot + row]
                count += 1
    return count


@piece(MATH)
def _evidence(memory, h, at, pattern, found, count, measured, temper, sensor, settings, rest):  # type: ignore[no-untyped-def]
    """Log-likelihood of the charges measured (n,), channel after channel; at : yaw, row and offset in the table.

    Heights and spreads of the dots that were found (4, count) are moved on by the Kalman filter; rest (n,) is what is
    left of the charges but for single dots. Student's t, whose scale grows with the charge; temper weakens it.
    """
    channels = measured.shape[0]
    yaw, row, offset = at
    mean = 0.0
    for k in range(count):
        mean += found[1, k]
    mean = mean / count if count else 0.0
    widths, spreads, tails = 1.0, 1.0, 1.0
    for j in range(channels):
        rest[j] = measured[j] - memory[h, LEVEL + j] - settings.step_s * memory[h, LEVEL + channels + j]
        if not sensor.alive[j]:
            continue
        gain = sensor.gain[j]
        more, charge, spread = gain * mean * sensor.beside[row, offset, pattern, j], 0.0, 0.0
        for k in range(count):
            one = gain * sensor.lone[yaw, row, offset, int(found[0, k]), j]
            found[3, k] = one
            charge += one * found[1, k]
            spread += one * one * found[2, k]
        rest[j] -= more
        residual = rest[j] - charge
        variance = sensor.floor_pC2[j] + (settings.rough * (charge + more)) ** 2
        whole = variance + temper * spread
        unit = residual * residual / (settings.degrees * whole)
        widths *= variance
        spreads *= whole / variance
        tails *= 1.0 + unit
        believed = min(1.0, (1.0 + 1.0 / settings.degrees) / (1.0 + unit)) * residual
        for k in range(count):
            own = found[3, k] * found[2, k] * temper / whole
            found[1, k] += own * believed
            found[2, k] = max(found[2, k] * (1.0 - own * found[3, k]), LEAST_SPREAD)
    return -0.5 * temper * (np.log(widths) + (settings.degrees + 1.0) * np.log(tails)) - 0.5 * np.log(spreads)


@nb.njit(cache=True)
def advance(state, choice, memory, measured, temper, may_touch, turn, sensor, settings, room):  # type: ignore[no-untyped-def]
    """The hypotheses after a step with the charges measured (n,), and the logarithm of their evidence.

    temper : exponent of the likelihood. may_touch : whether lost contact may be found again. turn : of what is rare.
    room : four arrays for children, state (m, 4), choice (m, 6), number of the parent (m,) and bits of new columns.
    """
    made, made_choice, parent, fresh = room
    count = 0
    top = state[:, LOG_WEIGHT].max()
    options = np.empty((2, 3, MOST_OPTIONS, 6))
    for touch in range(2):
        for way in range(3):
            _fill_options(options[touch, way], way - 1, touch, may_touch, turn, settings)
    for h in range(state.shape[0]):
        touch, way = choice[h, TOUCH], choice[h, WAY] + 1
        for one in range(MOST_OPTIONS):
            if state[h, LOG_WEIGHT] + options[touch, way, one, CHANCE] < top - settings.kept_log:
                continue
            if count > MOST_CHILDREN - 65:
                break
            begin = count
            count = _children(
                state, choice, h, options, touch, way, one, made, made_choice, fresh, count, sensor, settings
            )  # fmt: skip
            for child in range(begin, count):
                parent[child] = h
    agreed = merged(made, made_choice, count, top)
    weight = _weigh(made, made_choice, memory, parent, fresh, agreed, measured, temper, sensor, settings)
    chosen = agreed[_best_ones(weight, settings)]
    kept_state, kept_choice, kept_memory = made[chosen], made_choice[chosen], memory[parent[chosen]]
    _remember(kept_state, kept_choice, kept_memory, fresh[chosen], measured, temper, sensor, settings)
    return kept_state, kept_choice, kept_memory, _log_sum(kept_state[:, LOG_WEIGHT]) - _log_sum(state[:, LOG_WEIGHT])


@nb.njit(cache=True)
def _weigh(made, made_choice, memory, parent, fresh, agreed, measured, temper, sensor, settings):  # type: ignore[no-untyped-def]
    """Add the evidence of charges (n,) to the weights of children that stand for others (k,), and return these (k,)."""
    found, rest = np.empty((4, 2 * ROWS)), np.empty(measured.shape[0])
    weight = np.empty(len(agreed))
    for k in range(len(agreed)):
        child = agreed[k]
        row, first, pattern = _pattern(made[child, PLACE], made_choice, child, sensor)
        at = (made_choice[child, YAW], row, made_choice[child, OFFSET])
        dots = _take_heights(memory, parent[child], first, pattern, fresh[child], settings, found)
        made[child, LOG_WEIGHT] += _evidence(
            memory, parent[child], at, pattern, found, dots, measured, temper, sensor, settings, rest
        )  # fmt: skip
        weight[k] = made[child, LOG_WEIGHT]
    return weight


@nb.njit(cache=True)
def _best_ones(weight, settings):  # type: ignore[no-untyped-def]
    """Numbers of the weights that are near enough to the best, and not more than may be kept."""
    least = weight.max() - settings.kept_log
    if len(weight) > settings.most_kept:
        rank = len(weight) - settings.most_kept
        least = max(least, np.partition(weight, rank)[rank])
    return np.flatnonzero(weight >= least)


@nb.njit(cache=True)
def weighed(state, choice, memory, measured, sensor, settings):  # type: ignore[no-untyped-def]
    """Beam after they were weighed by the charges measured (n,), without a motion."""
    made, every = state.copy(), np.arange(len(state))
    known = np.zeros(len(state), dtype=np.int64)
    weight = _weigh(made, choice, memory, every, known, every, measured, 1.0, sensor, settings)
    chosen = _best_ones(weight, settings)
    return made[chosen], choice[chosen], memory[chosen]


@nb.njit(cache=True)
def _log_sum(weights):  # type: ignore[no-untyped-def]
    top = weights.max()
    return top + np.log(np.exp(weights - top).sum())


@piece()
def _pattern(place, choice, h, sensor):  # type: ignore[no-untyped-def]
    """Row of the table, number of the column behind, and the pattern of both columns in the window.

    What passed without contact counts as blank, and so does everything without contact.
    """
    row, first = _window(place, sensor)
    if choice[h, TOUCH] == 0:
        return row, first, 0
    rear = column_of(choice[h, COLUMNS], choice[h, SEEN], first)
    front = column_of(choice[h, COLUMNS], choice[h, SEEN], first + 1)
    return row, first, (rear & 7) | (front & 7) << 3


@nb.njit(cache=True)
def _fill_options(options, way, touch, may_touch, turn, settings):  # type: ignore[no-untyped-def]
    """Fill the ways (12, 6) in which a hypothesis may go on, whose chances sum up to 1; others have none."""
    options[:, CHANCE], options[:, CHANGE] = -np.inf, 0.0
    options[:, NEW_WAY] = way
    options[:, ASIDE:CONTACT] = 0
    options[:, CONTACT] = touch
    usual = 1 if way == STILL else 3
    for k in range(1, usual):
        options[k, CHANCE], options[k, CHANGE] = np.log(1.0 / 6.0), (2 * k - 3) * settings.faster
    options[0, CHANCE] = np.log(2.0 / 3.0) if usual == 3 else 0.0
    number = usual
    if way == STILL:
        options[number, CHANCE], options[number, NEW_WAY] = settings.log_go, FORTH
        options[number + 1, CHANCE], options[number + 1, NEW_WAY] = settings.log_back, BACK
        number += 2
    else:
        part = CHANGE if turn == 0 else ASIDE if turn == 1 else TURN
        for sign in (-1, 1):
            chance = settings.log_jump if turn == 0 else settings.log_aside if turn == 1 else settings.log_turn
            options[number, CHANCE], options[number, part] = chance, sign * (settings.jump if turn == 0 else 1.0)
            number += 1
        if turn == 0:
            options[number, CHANCE], options[number, NEW_WAY] = settings.log_stop, STILL
            number += 1
        elif turn == 2:
            options[number, CHANCE] = settings.log_back if way == FORTH else settings.log_forth
            options[number, NEW_WAY] = -way
            number += 1
    if touch == 1 and turn == 1:
        options[number, CHANCE], options[number, CONTACT] = settings.log_lift, 0
        number += 1
    elif touch == 0:
        options[number, CHANCE], options[number, CONTACT] = settings.log_touch, 1
        number += 1
    options[:usual, CHANCE] += np.log(max(1.0 - np.exp(options[usual:number, CHANCE]).sum(), 0.05))
    if touch == 0 and not may_touch:
        options[number - 1, CHANCE] = -np.inf


@piece()
def _children(state, choice, h, options, touch, way, one, made, made_choice, fresh, count, sensor, settings):  # type: ignore[no-untyped-def]
    """Add hypothesis h as it went on in one way, once for each pattern that a new column may have; their number."""
    option = options[touch, way, one]
    offset, yaw = choice[h, OFFSET] + int(option[ASIDE]), choice[h, YAW] + int(option[TURN])
    if not (0 <= offset < sensor.lone.shape[2] and 0 <= yaw < sensor.lone.shape[0]):
        return count
    way, touch = int(option[NEW_WAY]), int(option[CONTACT])
    speed, mean = state[h, LOG_SPEED], state[h, MEAN_LOG_SPEED]
    if way != STILL:
        speed = mean if choice[h, WAY] == STILL else speed + settings.relax * (mean - speed) + option[CHANGE]
        mean += settings.settle * (speed - mean)
    place = state[h, PLACE] + way * np.exp(speed) * settings.step_s
    first = _window(place, sensor)[1]
    columns, seen = choice[h, COLUMNS], choice[h, SEEN]
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
            chance, own = state[h, LOG_WEIGHT] + option[CHANCE], columns
            if is_new and touch == 0:
                chance += settings.log_unseen
            if rears == 8:
                kind = kind_before(own, seen, first)
                own = own ^ ((UNSEEN ^ a) << (4 * (seen - 1 - first)))
                chance += settings.log_blank[kind] if a == 0 else settings.log_dots[kind]
            if fronts == 8:
                kind = kind_before(own, seen, first + 1)
                own = own ^ ((UNSEEN ^ b) << (4 * (seen - 2 - first)))
                chance += settings.log_blank[kind] if b == 0 else settings.log_dots[kind]
            made[count, PLACE], made[count, LOG_SPEED], made[count, MEAN_LOG_SPEED] = place, speed, mean
            made[count, LOG_WEIGHT] = chance
            made_choice[count, WAY], made_choice[count, OFFSET], made_choice[count, YAW] = way, offset, yaw
            made_choice[count, TOUCH], made_choice[count, SEEN], made_choice[count, COLUMNS] = touch, seen, own
            fresh[count] = (REAR if rears == 8 else 0) | (FRONT if fronts == 8 else 0)
            count += 1
    return count


@nb.njit(cache=True)
def _remember(state, choice, memory, fresh, measured, temper, sensor, settings):  # type: ignore[no-untyped-def]
    """Move the memories (h, 24 + 2 n) on: heights of dots, and level and rate of the drift by a steady filter."""
    channels = measured.shape[0]
    found, rest = np.empty((4, 2 * ROWS)), np.empty(channels)
    for h in range(state.shape[0]):
        row, first, pattern = _pattern(state[h, PLACE], choice, h, sensor)
        yaw, offset = choice[h, YAW], choice[h, OFFSET]
        count = _take_heights(memory, h, first, pattern, fresh[h], settings, found)
        _evidence(memory, h, (yaw, row, offset), pattern, found, count, measured, temper, sensor, settings, rest)
        for k in range(count):
            side, across = divmod(int(found[0, k]), ROWS)
            slot = ROWS * ((first + side) & (KEPT_HEIGHTS - 1)) + across
            memory[h, HEIGHT + slot], memory[h, SPREAD + slot] = found[1, k], found[2, k]
        for j in range(channels):
            charge = 0.0
            for k in range(count):
                charge += sensor.gain[j] * sensor.lone[yaw, row, offset, int(found[0, k]), j] * found[1, k]
            width = np.sqrt((sensor.floor_pC2[j] + (settings.rough * charge) ** 2) / temper)
            residual = min(max(rest[j] - charge, -LARGEST_RESIDUAL * width), LARGEST_RESIDUAL * width)
            bend = sensor.bend_pC[j] / (width + sensor.bend_pC[j])
            level = min(1.0, np.sqrt(2.0 * bend + sensor.drift_pC[j] ** 2 / (sensor.drift_pC[j] ** 2 + width**2)))
            memory[h, LEVEL + j] += settings.step_s * memory[h, LEVEL + channels + j] + level * residual
            memory[h, LEVEL + channels + j] += bend * residual / settings.step_s


@nb.njit(cache=True)
def predicted_charges(state, choice, memory, sensor):  # type: ignore[no-untyped-def]
    """Charges (n,) of the first hypothesis, without gain and drift."""
    row, first, pattern = _pattern(state[0, PLACE], choice, 0, sensor)
    yaw, offset = choice[0, YAW], choice[0, OFFSET]
    charge = np.zeros(sensor.gain.shape[0])
    count, mean = 0, 0.0
    for dot in range(2 * ROWS):
        if pattern >> dot & 1:
            side, across = divmod(dot, ROWS)
            height = memory[0, HEIGHT + ROWS * ((first + side) & (KEPT_HEIGHTS - 1)) + across]
            charge += height * sensor.lone[yaw, row, offset, dot]
            count, mean = count + 1, mean + height
    if count:
        charge += mean / count * sensor.beside[row, offset, pattern]
    return charge
