"""What charges say of a hypothesis: their likelihood, and heights, lateral place and drift that they move on."""

import numba as nb
import numpy as np

from softdot.reading.line_filter.hypothesis_arrays import (
    COLUMNS,
    HEIGHT,
    KEPT_HEIGHTS,
    LATERAL,
    LEVEL,
    PLACE,
    ROWS,
    SEEN,
    SPREAD,
    TOUCH,
    YAW,
    column_of,
)
from softdot.reading.line_filter.lateral import (
    LINE_A,
    WANDER,
    lateral_place,
    place_spread,
    see,
    table_offset,
)
from solve.compiled import MATH, piece

LARGEST_RESIDUAL = 3.0
"""Standard deviations that the drift takes from one residual at most."""
LEAST_SPREAD = 0.04**2
"""Least variance of a height."""
WIDEST_GAIN = 2.5
"""Largest factor of a gain."""
REAR, FRONT = 1, 2
"""Bits of the columns in the window that a hypothesis meets for the first time."""


@piece()
def table_row(place, sensor):  # type: ignore[no-untyped-def]
    """Row of the table for a place, and number of the column behind."""
    rear = place - 0.5 * sensor.cell_pitch_mm
    cell = np.floor(rear / sensor.cell_pitch_mm)
    places = sensor.within.shape[0]
    row = min(int((rear / sensor.cell_pitch_mm - cell) * places), places - 1)
    return row, 2 * int(cell) + (1 if sensor.within[row] else 2)


@piece()
def take_heights(memory, h, first, pattern, fresh, settings, found):  # type: ignore[no-untyped-def]
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
def log_evidence(memory, h, at, pattern, found, count, aside, measured, temper, sensor, settings, channel):  # type: ignore[no-untyped-def]
    """Log-likelihood of the charges measured (n,), channel after channel; at : yaw and row in the table.

    Heights and spreads of the dots that were found (4, count), and the lateral place (9,), are moved on by the Kalman
    filter; channel (3, n) is filled with what is left of the charges but for single dots, and with gains and their
    variances. Student's t, whose scale grows with the
    charge; temper weakens it.
    """
    yaw, row = at
    channels = measured.shape[0]
    before = aside[LINE_A] + aside[WANDER]
    offset, share, per_mm = table_offset(before)
    mean = 0.0
    for k in range(count):
        mean += found[1, k]
    mean = mean / count if count else 0.0
    widths, wholes, tails = 1.0, 1.0, 1.0
    for j in range(channels):
        rest = measured[j] - memory[h, LEVEL + j] - settings.step_s * memory[h, LEVEL + channels + j]
        gain, gain_spread = memory[h, LEVEL + 2 * channels + j], memory[h, LEVEL + 3 * channels + j]
        gain_spread = min(gain_spread + settings.gain_walk, settings.gain_spread)
        channel[0, j], channel[1, j], channel[2, j] = rest, gain, gain_spread
        if not sensor.alive[j]:
            continue
        low, high = sensor.beside[row, offset, pattern, j], sensor.beside[row, offset + 1, pattern, j]
        more, charge, spread = gain * mean * (low + share * (high - low)), 0.0, 0.0
        slope = gain * mean * per_mm * (high - low)
        for k in range(count):
            dot = int(found[0, k])
            low, high = sensor.lone[yaw, row, offset, dot, j], sensor.lone[yaw, row, offset + 1, dot, j]
            one = gain * (low + share * (high - low))
            found[3, k] = one
            charge += one * found[1, k]
            spread += one * one * found[2, k]
            slope += gain * per_mm * (high - low) * found[1, k]
        channel[0, j] -= more
        residual = rest - more - charge - slope * (aside[LINE_A] + aside[WANDER] - before)
        per_gain = (charge + more) / gain
        variance = sensor.floor_pC2[j] + (settings.rough * (charge + more)) ** 2
        whole = variance + temper * (spread + slope * slope * place_spread(aside) + per_gain * per_gain * gain_spread)
        sharp = 1.0 / whole
        unit = 1.0 + residual * residual * sharp / settings.degrees
        widths *= variance
        wholes *= whole
        tails *= unit
        believed = min(1.0, (1.0 + 1.0 / settings.degrees) / unit) * residual
        sharp *= temper
        for k in range(count):
            own = found[3, k] * found[2, k] * sharp
            found[1, k] += own * believed
            found[2, k] = max(found[2, k] * (1.0 - own * found[3, k]), LEAST_SPREAD)
        own = per_gain * gain_spread * sharp
        channel[1, j] = min(max(gain + own * believed, 1.0 / WIDEST_GAIN), WIDEST_GAIN)
        channel[2, j] = max(gain_spread * (1.0 - own * per_gain), settings.least_gain_spread)
        see(aside, slope * sharp, believed, slope)
    of_widths = np.log(widths)
    return 0.5 * ((1.0 - temper) * of_widths - temper * (settings.degrees + 1.0) * np.log(tails) - np.log(wholes))


@piece()
def pattern_of(place, choice, h, sensor):  # type: ignore[no-untyped-def]
    """Row of the table, number of the column behind, and the pattern of both columns in the window.

    What passed without contact counts as blank, and so does everything without contact.
    """
    row, first = table_row(place, sensor)
    if choice[h, TOUCH] == 0:
        return row, first, 0
    rear = column_of(choice[h, COLUMNS], choice[h, SEEN], first)
    front = column_of(choice[h, COLUMNS], choice[h, SEEN], first + 1)
    return row, first, (rear & 7) | (front & 7) << 3


@nb.njit(cache=True)
def remember(state, choice, memory, chosen, learned, temper, sensor, settings):  # type: ignore[no-untyped-def]
    """Move the memories (h, 33 + 5 n) on: heights, lateral place, gains, and the drift by a steady filter.

    The rate of the drift has a bend of its own: under a steadily drifting resting voltage no lag is left to gains and
    dots. The gains are those of a steady Kalman filter of white noise integrated three times, with Butterworth's poles.

    chosen (h,) : which of what the charges taught the hypotheses belongs to each (softdot.reading.line_filter.beam).
    """
    dots, founds, channels_of, asides = learned
    channels = channels_of.shape[2]
    for h in range(state.shape[0]):
        row, first, _ = pattern_of(state[h, PLACE], choice, h, sensor)
        yaw, own = choice[h, YAW], chosen[h]
        count, found, channel = dots[own], founds[own], channels_of[own]
        memory[h, LATERAL:LEVEL] = asides[own]
        for k in range(count):
            side, across = divmod(int(found[0, k]), ROWS)
            slot = ROWS * ((first + side) & (KEPT_HEIGHTS - 1)) + across
            memory[h, HEIGHT + slot], memory[h, SPREAD + slot] = found[1, k], found[2, k]
        offset, share, _ = table_offset(lateral_place(memory, h))
        for j in range(channels):
            charge = 0.0
            for k in range(count):
                dot = int(found[0, k])
                low, high = sensor.lone[yaw, row, offset, dot, j], sensor.lone[yaw, row, offset + 1, dot, j]
                charge += channel[1, j] * (low + share * (high - low)) * found[1, k]
            width = np.sqrt((sensor.floor_pC2[j] + (settings.rough * charge) ** 2) / temper)
            residual = min(max(channel[0, j] - charge, -LARGEST_RESIDUAL * width), LARGEST_RESIDUAL * width)
            memory[h, LEVEL + 2 * channels + j], memory[h, LEVEL + 3 * channels + j] = channel[1, j], channel[2, j]
            bend = (sensor.bend_pC[j] / (width + sensor.bend_pC[j])) ** (1.0 / 3.0)
            level = min(1.0, np.sqrt(4.0 * bend**2 + sensor.drift_pC[j] ** 2 / (sensor.drift_pC[j] ** 2 + width**2)))
            rate, step = LEVEL + channels + j, settings.step_s
            memory[h, LEVEL + j] += step * memory[h, rate] + level * residual
            memory[h, rate] += step * memory[h, LEVEL + 4 * channels + j] + 2.0 * bend**2 * residual / step
            memory[h, LEVEL + 4 * channels + j] += bend**3 * residual / step**2


@nb.njit(cache=True)
def predicted_charges(state, choice, memory, sensor, wider):  # type: ignore[no-untyped-def]
    """Charges (3, n) of the first hypothesis without drift: of single dots, what these do to each other, and change of
    the former with the width of the sensor.
    """
    row, first, pattern = pattern_of(state[0, PLACE], choice, 0, sensor)
    yaw, (offset, share, _) = choice[0, YAW], table_offset(lateral_place(memory, 0))
    charge = np.zeros((3, sensor.lone.shape[4]))
    count, mean = 0, 0.0
    for dot in range(2 * ROWS):
        if pattern >> dot & 1:
            side, across = divmod(dot, ROWS)
            height = memory[0, HEIGHT + ROWS * ((first + side) & (KEPT_HEIGHTS - 1)) + across]
            for part, table in ((0, sensor.lone), (2, wider)):
                low, high = table[yaw, row, offset, dot], table[yaw, row, offset + 1, dot]
                charge[part] += height * (low + share * (high - low))
            count, mean = count + 1, mean + height
    if count:
        low, high = sensor.beside[row, offset, pattern], sensor.beside[row, offset + 1, pattern]
        charge[1] = mean / count * (low + share * (high - low))
    return charge * memory[0, LEVEL + 2 * charge.shape[1] : LEVEL + 3 * charge.shape[1]]
