"""One step of all hypotheses: they move, meet columns of dots, are weighed by the charges, merged and thinned out."""

import numba as nb
import numpy as np

from softdot.reading.line_filter.evidence import (
    FRONT,
    REAR,
    log_evidence,
    pattern_of,
    remember,
    table_row,
    take_heights,
)
from softdot.reading.line_filter.hypothesis_arrays import (
    AHEAD,
    BACK,
    COLUMNS,
    FORTH,
    LOG_SPEED,
    LOG_WEIGHT,
    MEAN_LOG_SPEED,
    PLACE,
    ROWS,
    SEEN,
    STILL,
    TOUCH,
    UNSEEN,
    WAY,
    YAW,
    column_of,
    kind_before,
)
from softdot.reading.line_filter.lateral import LEFT, RIGHT, move_aside, step_aside
from softdot.reading.line_filter.merging import merged
from solve.compiled import piece

MOST_CHILDREN = 60_000
"""Room for the children of a step; those beyond are not looked at."""
MOST_OPTIONS = 12
RARE_STEPS = 3
"""What a hand does rarely is tried in one of so many steps, as often as if it were tried in all of them."""
CHANCE, CHANGE, NEW_WAY, TURN, CONTACT, ASIDE = range(6)
"""Columns of the ways in which a hypothesis may go on: log-probability, and what changes."""
OLD_MM = 1.8
"""Way behind the array's middle at which a column that passed without contact is looked at no more."""


@nb.njit(cache=True)
def advance(state, choice, memory, measured, temper, may_touch, turn, told, sensor, settings, room):  # type: ignore[no-untyped-def]
    """The hypotheses after a step with the charges measured (n,), and the logarithm of their evidence.

    temper : exponent of the likelihood. may_touch : whether lost contact may be found again. turn : of what is rare.
    told : what was given out (softdot.reading.line_filter.merging).
    room : four arrays for children, state (m, 4), choice (m, 6), number of the parent (m,) and bits of new columns
    and of a step aside.
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
    agreed = merged(made, made_choice, memory, parent, fresh, count, top, told, sensor)
    before = state[:, PLACE]
    agreed = agreed[_best_ones(made[agreed, LOG_WEIGHT], settings.kept_log, settings.most_weighed)]
    weight, learned = _weigh(
        made, made_choice, memory, before, parent, fresh, agreed, measured, temper, sensor, settings
    )  # fmt: skip
    best = _best_ones(weight, settings.kept_log, settings.most_kept)
    chosen = agreed[best]
    kept_state, kept_choice, kept_memory = made[chosen], made_choice[chosen], memory[parent[chosen]]
    remember(kept_state, kept_choice, kept_memory, best, learned, temper, sensor, settings)
    return kept_state, kept_choice, kept_memory, _log_sum(kept_state[:, LOG_WEIGHT]) - _log_sum(state[:, LOG_WEIGHT])


@nb.njit(cache=True)
def _weigh(made, made_choice, memory, before, parent, fresh, agreed, measured, temper, sensor, settings):  # type: ignore[no-untyped-def]
    """Add the evidence of charges (n,) to the weights of children that stand for others (k,), and return these (k,)
    with what the charges taught each: number of dots (k,), these (k, 4, 6), channels (k, 3, n), lateral place (k, 9).

    before : places along the line of their parents.
    """
    many = len(agreed)
    weight, dots = np.empty(many), np.empty(many, dtype=np.int64)
    found, channel = np.empty((many, 4, 2 * ROWS)), np.empty((many, 3, measured.shape[0]))
    aside = np.empty((many, 9))
    for k in range(many):
        child = agreed[k]
        own = parent[child]
        row, first, pattern = pattern_of(made[child, PLACE], made_choice, child, sensor)
        dots[k] = take_heights(memory, own, first, pattern, fresh[child], settings, found[k])
        move_aside(memory, own, made[child, PLACE] - before[own], settings.fade, step_aside(fresh[child]), aside[k])
        at = (made_choice[child, YAW], row)
        made[child, LOG_WEIGHT] += log_evidence(
            memory, own, at, pattern, found[k], dots[k], aside[k], measured, temper, sensor, settings, channel[k]
        )  # fmt: skip
        weight[k] = made[child, LOG_WEIGHT]
    return weight, (dots, found, channel, aside)


@nb.njit(cache=True)
def _best_ones(weight, kept_log, most):  # type: ignore[no-untyped-def]
    """Numbers of the weights that are within a logarithm of the best, and about as many of the best as may be kept."""
    least = weight.max() - kept_log
    if len(weight) > most:
        rank = len(weight) - most
        least = max(least, np.partition(weight, rank)[rank])
    return np.flatnonzero(weight >= least)


@nb.njit(cache=True)
def weighed(state, choice, memory, measured, sensor, settings):  # type: ignore[no-untyped-def]
    """Beam after they were weighed by the charges measured (n,), without a motion."""
    made, every = state.copy(), np.arange(len(state))
    known = np.zeros(len(state), dtype=np.int64)
    weight, _ = _weigh(made, choice, memory, state[:, PLACE], every, known, every, measured, 1.0, sensor, settings)
    chosen = _best_ones(weight, settings.kept_log, settings.most_kept)
    return made[chosen], choice[chosen], memory[chosen]


@nb.njit(cache=True)
def _log_sum(weights):  # type: ignore[no-untyped-def]
    top = weights.max()
    return top + np.log(np.exp(weights - top).sum())


@nb.njit(cache=True)
def _fill_options(options, way, touch, may_touch, turn, settings):  # type: ignore[no-untyped-def]
    """Fill the ways (12, 6) in which a hypothesis may go on, whose chances sum up to 1; others have none."""
    options[:, CHANCE], options[:, CHANGE] = -np.inf, 0.0
    options[:, NEW_WAY] = way
    options[:, TURN], options[:, ASIDE] = 0, 0.0
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
        for sign in (-1, 1):
            if turn == 0:
                options[number, CHANCE], options[number, CHANGE] = settings.log_jump, sign * settings.jump
                number += 1
            elif turn == 2:
                options[number, CHANCE], options[number, TURN] = settings.log_turn, sign
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
        for bit in (LEFT, RIGHT):
            number += 1
            options[number, CHANCE], options[number, ASIDE] = settings.log_aside, bit
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
    yaw = choice[h, YAW] + int(option[TURN])
    if not 0 <= yaw < sensor.lone.shape[0]:
        return count
    way, touch = int(option[NEW_WAY]), int(option[CONTACT])
    speed, mean = state[h, LOG_SPEED], state[h, MEAN_LOG_SPEED]
    if way != STILL:
        speed = mean if choice[h, WAY] == STILL else speed + settings.relax * (mean - speed) + option[CHANGE]
        mean += settings.settle * (speed - mean)
    place = state[h, PLACE] + way * np.exp(speed) * settings.step_s
    first = table_row(place, sensor)[1]
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
            made_choice[count, WAY], made_choice[count, YAW] = way, yaw
            made_choice[count, TOUCH], made_choice[count, SEEN], made_choice[count, COLUMNS] = touch, seen, own
            made_choice[count, AHEAD] = choice[h, AHEAD]
            fresh[count] = int(option[ASIDE]) | (REAR if rears == 8 else 0) | (FRONT if fronts == 8 else 0)
            count += 1
    return count
