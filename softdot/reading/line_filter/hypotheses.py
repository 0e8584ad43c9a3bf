"""The hypotheses with which a line begins, or a lost track is looked for, and how a hand moves."""

from dataclasses import dataclass
from math import exp, log, sqrt
from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.line_filter.beam import RARE_STEPS
from softdot.reading.line_filter.givens import HandMotion
from softdot.reading.line_filter.hypothesis_arrays import (
    AHEAD,
    COLUMNS,
    FORTH,
    HEIGHT,
    KEPT_COLUMNS,
    LATERAL,
    LEVEL,
    PLACE,
    SEEN,
    SPREAD,
    UNSEEN,
    YAW,
)
from softdot.reading.line_filter.lateral import LINE_A, VAR_A, WANDER, WANDER_S, seen_at
from softdot.reading.line_filter.table import YAWS_DEG, LineTable, column_mm

SPEED_SPREAD_PER_SQRT_S, JUMP, JUMPS_PER_S = 0.5, 0.35, 0.5
"""Random walk of the log-speed, its jumps, and how often each happens."""
RELAX_S, SETTLE_S = 1.0, 2.0
"""Time in which the log-speed returns to its mean, and the mean follows the log-speed."""
STOPS_PER_S, GOES_PER_S, BACKS_PER_S, FORTHS_PER_S = 0.3, 1.5, 0.3, 4.0
TURNS_PER_S, LIFTS_PER_S, TOUCHES_PER_S, ASIDES_PER_S = 0.2, 0.2, 6.0, 0.1
"""How often a hand stops and goes on, goes back and forth, turns by a step, loses and finds contact, and is found to be
elsewhere beside the line: all of this is assumed.
"""
UNSEEN_SHARE = 0.6
"""Weight of a column that passes without contact, beside the patterns that it may have: assumed."""
BLANK = 0.3
"""Share of blank columns where nothing is known."""
BLANK_CELLS, BLANK_AGAIN, BLANK_FIRST, BLANK_SECOND = 0.18, 0.03, 0.05, 0.2
"""Shares of cells that are blank, of those behind a blank one, and with a blank first or second column alone."""
HEIGHT_MEAN, HEIGHT_SPREAD = 0.85, 0.3
"""Mean and standard deviation of what a dot gives over what a nominal one would, worn ones among them: assumed."""
ROUGH_SHARE, DEGREES = 0.15, 4.0
"""Standard deviation of a charge over the charge, and degrees of freedom of Student's t."""
KEPT_LOG, MOST_WEIGHED, MOST_KEPT, EARLY_KEPT = 11.0, 6000, 1500, 12_000
SPEED_FACTOR, SPEEDS = 2.2, 7
"""Factor about a rough speed within which speeds are tried, and their number."""
FARTHEST_SHARE, NEAREST_MM, ENTRY_STEP_MM = 1.4, 0.4, 0.3
"""Distance at which the first column may be seen first: of half the window, and the nearest."""
YAW_SPREAD_DEG = 6.0
"""Standard deviation of the turn of the array at the beginning, assumed."""
FARTHEST_ASIDE_MM, ASIDE_SPREAD_MM = 2.4, 0.2
"""Lateral places with which a line begins, and the standard deviation of each: they are twice as far apart."""
GAIN_SPREAD, LEAST_GAIN_SPREAD, GAIN_WALK = 0.3, 0.08, 0.02
"""Standard deviations of a gain at first and at least, and by how much it changes in the root of a second: assumed."""
ROW_BESIDE = 0.1
"""Share of lost tracks in which the array lay one row of dots farther than was thought, to each side: assumed."""
FIRST_COLUMN = 0.85
"""Share of lines whose first dots are in the first column of their cell."""


Asides = list[tuple[Floats, float]]
"""Lateral places (9,) and their log-probabilities."""


@dataclass
class Beam:
    """Rows of state (h, 4), choice (h, 6) and memory (h, 33 + 5 n) (hypothesis_arrays)."""

    state: Floats
    choice: Ints
    memory: Floats


def settings(step_s: float, is_mirrored: bool) -> HandMotion:
    """The motion of a hand in steps of a time."""
    blank = _blank_columns(is_mirrored)

    def often(per_s: float) -> float:
        return log(min(per_s * step_s, 0.5))

    def rarely(per_s: float) -> float:
        return log(min(RARE_STEPS * per_s * step_s, 0.5))

    return HandMotion(
        step_s=step_s,
        faster=SPEED_SPREAD_PER_SQRT_S * sqrt(3.0 * step_s),
        jump=JUMP,
        relax=min(step_s / RELAX_S, 1.0),
        settle=min(step_s / SETTLE_S, 1.0),
        log_jump=rarely(JUMPS_PER_S),
        log_stop=rarely(STOPS_PER_S),
        log_go=often(GOES_PER_S),
        log_back=rarely(BACKS_PER_S),
        log_forth=rarely(FORTHS_PER_S),
        log_turn=rarely(TURNS_PER_S),
        log_lift=rarely(LIFTS_PER_S),
        log_touch=often(TOUCHES_PER_S),
        log_aside=rarely(ASIDES_PER_S),
        log_blank=np.log(blank),
        log_dots=np.log((1.0 - blank) / 7.0),
        log_unseen=log(UNSEEN_SHARE),
        height=HEIGHT_MEAN,
        height_spread=HEIGHT_SPREAD**2,
        rough=ROUGH_SHARE,
        degrees=DEGREES,
        gain_spread=GAIN_SPREAD**2,
        least_gain_spread=LEAST_GAIN_SPREAD**2,
        gain_walk=GAIN_WALK**2 * step_s,
        fade=exp(-step_s / WANDER_S),
        kept_log=KEPT_LOG,
        most_weighed=MOST_WEIGHED,
        most_kept=MOST_KEPT,
    )


def _blank_columns(is_mirrored: bool) -> Floats:
    """Probabilities (4,) of a blank column, by what is known before it (softdot.reading.line_filter.beam)."""
    met, other = (BLANK_SECOND, BLANK_FIRST) if is_mirrored else (BLANK_FIRST, BLANK_SECOND)
    again = (1.0 - BLANK_AGAIN) / (1.0 - BLANK_CELLS)
    return np.array([
        BLANK_CELLS + met, BLANK_AGAIN + again * met, other / (1.0 - BLANK_CELLS - met),
        BLANK_CELLS / (BLANK_CELLS + met),
    ])  # fmt: skip


def early_settings(step_s: float, is_mirrored: bool) -> HandMotion:
    """The motion over the first column: what is rare is left out, and more hypotheses are kept."""
    rare: dict[str, Any] = dict.fromkeys(
        ("log_jump", "log_stop", "log_back", "log_turn", "log_lift", "log_aside"), -1e9
    )
    return settings(step_s, is_mirrored)._replace(most_weighed=4 * EARLY_KEPT, most_kept=EARLY_KEPT, **rare)


def at_the_first_column(table: LineTable, speed_mm_per_s: float, channels: int) -> Beam:
    """The array meets the first column of a line: of its cell the first or the second, any pattern but a blank."""
    entries = np.arange(NEAREST_MM, 0.5 * FARTHEST_SHARE * table.cell_pitch_mm, ENTRY_STEP_MM)
    speeds, asides = _speeds(speed_mm_per_s), _lateral_places()
    yaws = np.arange(2, len(YAWS_DEG) - 2, 2)
    column, pattern, entry, speed, aside, yaw = _every(2, 7, len(entries), len(speeds), len(asides), len(yaws))
    first = np.log([FIRST_COLUMN / 7.0, (1.0 - FIRST_COLUMN) / 7.0])
    turned = -0.5 * (YAWS_DEG[yaws] / YAW_SPREAD_DEG) ** 2
    places = np.array([column_mm(table, number) for number in (0, 1)])
    chance = first[column] + np.array([log_prior for _, log_prior in asides])[aside] + turned[yaw]
    state = np.stack([places[column] - entries[entry], speeds[speed], speeds[speed], chance], axis=1)
    ones = np.ones_like(column)
    choice = np.stack([FORTH * ones, yaws[yaw], ones, column + 1, pattern + 1, 0 * ones], axis=1)
    return Beam(state, choice, _memory(np.array([own for own, _ in asides])[aside], _channels(channels)))


def _every(*counts: int) -> Ints:
    """All combinations (k, h) of numbers below k counts."""
    return np.indices(counts).reshape(len(counts), -1)


def _lateral_places() -> Asides:
    """Lateral places (9,) of an array of which nothing is known, and their log-priors."""
    places = np.arange(-FARTHEST_ASIDE_MM, FARTHEST_ASIDE_MM + 0.01, 2.0 * ASIDE_SPREAD_MM)
    return [seen_at(float(place), ASIDE_SPREAD_MM) for place in places]


def _places_beside(aside: Floats, row_mm: float) -> Asides:
    """Lateral places (9,) about one that was followed: it, somewhat beside it, and one row of dots to each side."""
    found = []
    for away in (-row_mm, -2.0 * ASIDE_SPREAD_MM, 0.0, 2.0 * ASIDE_SPREAD_MM, row_mm):
        own = aside.copy()
        own[LINE_A] += away
        own[VAR_A] += ASIDE_SPREAD_MM**2
        if abs(own[LINE_A] + own[WANDER]) <= FARTHEST_ASIDE_MM or away == 0.0:
            found.append((own, log(ROW_BESIDE) if abs(away) == row_mm else 0.0))
    return found


def _channels(count: int) -> Floats:
    """Level and rate of the drift, gain, its variance, and bend of the drift (5 n,) of channels not yet known."""
    return np.concatenate([np.zeros(2 * count), np.ones(count), np.full(count, GAIN_SPREAD**2), np.zeros(count)])


def _memory(asides: Floats, channels: Floats) -> Floats:
    """Memories (h, 33 + 5 n) that know of no dot, with lateral places (h, 9) and what is known of channels (5 n,)."""
    known = np.empty((len(asides), LEVEL + len(channels)))
    known[:, HEIGHT:SPREAD], known[:, SPREAD:LATERAL] = HEIGHT_MEAN, HEIGHT_SPREAD**2
    known[:, LATERAL:LEVEL], known[:, LEVEL:] = asides, channels
    return known


def _speeds(speed_mm_per_s: float) -> Floats:
    return np.asarray(np.log(speed_mm_per_s) + log(SPEED_FACTOR) * np.linspace(-1.0, 1.0, SPEEDS))


def inside(table: LineTable, speed_mm_per_s: float, channels: int) -> Beam:
    """The array is on a line already when it begins to be heard: in the first cell, with any two columns."""
    yaw = len(YAWS_DEG) // 2
    nowhere = np.array([FORTH, yaw, 1, 0, 0, 0])
    speeds = np.log(speed_mm_per_s) + np.linspace(-1.0, 1.0, 9)
    return _anywhere(table, 0.5 * table.cell_pitch_mm, nowhere, speeds, _lateral_places(), _channels(channels))


def around(table: LineTable, best: Beam, speeds: Floats) -> Beam:
    """Around the place of one hypothesis, within half a cell to each side: any two columns, near postures and speeds.

    speeds (s,) : logarithms. Of the one hypothesis place, posture, drift and gains are taken.
    """
    asides = _places_beside(best.memory[0, LATERAL:LEVEL], table.dot_pitch_mm)
    return _anywhere(table, float(best.state[0, PLACE]), best.choice[0], speeds, asides, best.memory[0, LEVEL:])


def _anywhere(
    table: LineTable,
    middle_mm: float,
    known: Ints,
    speeds: Floats,
    asides: Asides,
    channels: Floats,
) -> Beam:
    """Hypotheses within half a cell of a place, with what a choice (6,) knows of the columns before, and its yaw."""
    half = 0.5 * table.cell_pitch_mm
    places = middle_mm + np.arange(-half, half, 0.15)
    before = np.array([_with_unseen(known, _last_in_window(table, float(place))) for place in places], dtype=np.int64)
    place, speed, aside, pattern = _every(len(places), len(speeds), len(asides), KINDS_OF_CELL)
    chance = np.array([log_prior for _, log_prior in asides])[aside] + _log_chances()[pattern]
    state = np.stack([places[place], speeds[speed], speeds[speed], chance], axis=1)
    columns = before[place, 0] & ~0xFF | pattern >> 3 | (pattern & 7) << 4
    ones = np.ones_like(place)
    choice = np.stack([FORTH * ones, known[YAW] * ones, ones, before[place, 1], columns, known[AHEAD] * ones], axis=1)
    return Beam(state, choice, _memory(np.array([own for own, _ in asides])[aside], channels))


def _log_chances() -> Floats:
    """Log-probability (64,) of two columns where nothing is known."""
    column = np.log([BLANK, *7 * [(1.0 - BLANK) / 7.0]])
    pattern = np.arange(KINDS_OF_CELL)
    return np.asarray(column[pattern & 7] + column[pattern >> 3])


def _last_in_window(table: LineTable, place: float) -> int:
    """Number of the foremost column within half a cell pitch of a place."""
    number = max(1, 2 * int(place // table.cell_pitch_mm))
    while column_mm(table, number + 1) <= place + 0.5 * table.cell_pitch_mm:
        number += 1
    return number


def _with_unseen(choice: Ints, last: int) -> tuple[int, int]:
    """Columns and their number as if the column last were the foremost; those that passed meanwhile were not seen."""
    columns, seen = int(choice[COLUMNS]), int(choice[SEEN])
    while seen <= last:
        columns, seen = columns << 4 | UNSEEN, seen + 1
    while seen > last + 1:
        columns, seen = columns >> 4, seen - 1
    mask = (1 << 4 * KEPT_COLUMNS) - 1
    columns &= mask
    return columns - (1 << 64) if columns >> 63 else columns, seen
