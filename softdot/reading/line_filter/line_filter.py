"""The filter of one direction: all hypotheses of where the array is and what passed, and the cells they agree on."""

from collections import deque
from dataclasses import dataclass, field, replace

import numpy as np

from foundation.arrays import Floats
from softdot.reading.cells import DOTS
from softdot.reading.line_filter.beam import MOST_CHILDREN, RARE_STEPS, advance, weighed
from softdot.reading.line_filter.evidence import predicted_charges
from softdot.reading.line_filter.givens import Sensor
from softdot.reading.line_filter.hypotheses import Beam, around, early_settings, settings
from softdot.reading.line_filter.hypothesis_arrays import (
    AHEAD,
    COLUMNS,
    HEIGHT,
    KEPT_COLUMNS,
    KEPT_HEIGHTS,
    LATERAL,
    LEVEL,
    LOG_SPEED,
    LOG_WEIGHT,
    PLACE,
    ROWS,
    SEEN,
    SPREAD,
    STILL,
    TOUCH,
    UNSEEN,
    WAY,
    YAW,
)
from softdot.reading.line_filter.lateral import LINE_A, WANDER
from softdot.reading.line_filter.table import YAWS_DEG, LineTable

LAG_COLUMNS, FIRST_COLUMNS = 4, 12
"""Columns that must follow a cell before it is given out, and least number of all: posture and heights come first."""
FLOOR_SHARE = 0.045
"""Standard deviation of a charge of none over the largest charge of one dot."""
TOUCH_SHARE = 0.08
"""Share of the largest charge of one dot above which lost contact may be found again."""
FIT_S = 0.2
"""Time over which the fit of the best hypothesis is averaged."""
LOST_FIT, FOUND_FIT = 4.0, 2.0
"""Mean squared residuals in their variance above which a track is lost, and below which it is found again."""
PATIENCE_S = 0.6
"""Time that a new start has before the next one."""
EARLY_SHARE, EARLY_STEPS = 0.6, 40
"""More hypotheses are kept until a charge reaches this share of the largest one of a dot, for so many steps at most."""
HEIGHTS_PRIOR, HEIGHTS_MEMORY, KNOWN_SPREAD, HEIGHT_SPREADS = 10.0, 60.0, 0.03, (0.1**2, 0.4**2)
"""Of the heights of a line's dots: weight of what was assumed and memory, both in dots, largest variance of one that
counts, and least and largest variance of all.
"""
WIDTH_SPREAD, MOST_WIDER, WIDTH_MEMORY_MM, WIDTH_STEP = 0.05, 0.1, 100.0, 0.004
"""By how much a sensor may be wider than its kernel: standard deviation, assumed, and most; the way over which this is
remembered, and the change from which charges are made anew.
"""
NEAR_MM = 3.0
"""Way from the middle of a cell within which the fit counts for it."""


@dataclass(frozen=True)
class PassedCell:
    """A cell as the hypotheses have it: number, the most likely one (-1 where none was seen), its probability, time
    at which the array's middle passed it, the worst fit meanwhile, and the largest distance of the array's middle from
    the middle row meanwhile. shares (64,) : probability of each.
    """

    number: int
    cell: int
    probability: float
    time_s: float
    worst_fit: float
    aside_mm: float
    shares: Floats


@dataclass
class LineFilter:
    """The filter of one direction. evidence : logarithm of that of all charges so far."""

    table: LineTable
    sensor: Sensor
    step_s: float
    hypotheses: Beam
    evidence: float = 0.0
    fit: float = 1.0
    losses: int = 0
    emitted: int = 0
    passed: int = 0
    touching: bool = True
    is_lost: bool = False
    _now_s: float = 0.0
    _patience_s: float = 0.0
    _times: deque[float] = field(default_factory=deque)
    _safe_log_speed: float = 0.0
    _fits: dict[int, float] = field(default_factory=dict)
    _asides: dict[int, float] = field(default_factory=dict)
    _width: float = 0.0
    _used_width: float = 0.0
    _width_known: float = 1.0 / WIDTH_SPREAD**2

    def __post_init__(self) -> None:
        """Make room for children."""
        self._settings = settings(self.step_s, self.table.is_mirrored)
        self._early = early_settings(self.step_s, self.table.is_mirrored)
        self._steps, self._is_early = 0, True
        self._room = (
            np.empty((MOST_CHILDREN, 4)), np.empty((MOST_CHILDREN, 6), dtype=np.int64),
            np.empty(MOST_CHILDREN, dtype=np.int64), np.empty(MOST_CHILDREN, dtype=np.int64),
        )  # fmt: skip
        self._best = 0
        first, second = self._settings.height, self._settings.height_spread + self._settings.height**2
        self._prior_heights = HEIGHTS_PRIOR * np.array([1.0, first, second])
        self._heights = self._prior_heights.copy()
        self._safe_channels = self.hypotheses.memory[0, LEVEL:]
        self._safe_log_speed = float(self.hypotheses.state[:, LOG_SPEED].mean())

    @property
    def best(self) -> Beam:
        """The most likely hypothesis alone."""
        one, all_ = self._best, self.hypotheses
        return Beam(all_.state[one : one + 1], all_.choice[one : one + 1], all_.memory[one : one + 1])

    @property
    def place_mm(self) -> float:
        """Place of the array's middle from the first column of the first cell."""
        best, known = self._best, self.hypotheses
        return float(known.state[best, PLACE]) + self.table.cell_pitch_mm * int(known.choice[best, AHEAD])

    @property
    def columns_seen(self) -> int:
        """Number of columns that the most likely hypothesis has seen."""
        best = self.hypotheses.choice[self._best]
        return int(best[SEEN] + 2 * best[AHEAD])

    @property
    def speed_mm_per_s(self) -> float:
        """Speed of the most likely hypothesis; negative on a way back."""
        way = int(self.hypotheses.choice[self._best, WAY])
        return 0.0 if way == STILL else way * float(np.exp(self.hypotheses.state[self._best, LOG_SPEED]))

    @property
    def offset_mm(self) -> float:
        """Distance of the array's middle from the middle row."""
        memory = self.hypotheses.memory[self._best]
        return float(memory[LATERAL + LINE_A] + memory[LATERAL + WANDER])

    @property
    def width(self) -> float:
        """Width of the sensor's response over that of the kernel, as this line tells it."""
        return 1.0 + self._width

    @property
    def yaw_deg(self) -> float:
        """Turn of the array against the line."""
        return float(YAWS_DEG[self.hypotheses.choice[self._best, YAW]])

    def step(self, charge_pC: Floats, temper: float, time_s: float) -> None:
        """Take the charges (n,) of the next step."""
        if self._steps == 0:
            first = self.hypotheses
            self._best = 0
            self.hypotheses = Beam(
                *weighed(first.state, first.choice, first.memory, charge_pC, self.sensor, self._early)
            )
        known, seen = self.hypotheses, self.columns_seen
        largest = np.abs(charge_pC - self._level(known.memory[self._best])).max()
        state, choice, memory, evidence = advance(
            known.state, known.choice, known.memory, charge_pC, temper,
            bool(largest > TOUCH_SHARE * self.table.largest_pC), self._steps % RARE_STEPS, self._told, self.sensor,
            self._early if self._is_early else self._settings, self._room,
        )  # fmt: skip
        self._steps += 1
        self._is_early = self._is_early and self._steps < EARLY_STEPS and largest < EARLY_SHARE * self.table.largest_pC
        self.hypotheses = Beam(state, choice, memory)
        self.evidence += evidence
        self._best = int(np.argmax(state[:, LOG_WEIGHT]))
        self.touching = bool(choice[self._best, TOUCH])
        self._learn_heights(seen)
        self._learn(charge_pC, temper)
        self._note_time(time_s)
        self._look_for_the_track(charge_pC)

    @property
    def _told(self) -> tuple[int, int]:
        """Mask of the columns that are not given out yet, and of those in the window; number of the cell here."""
        count = min(max(self.columns_seen - 2 * self.emitted, LAG_COLUMNS), KEPT_COLUMNS - 1)
        return (1 << 4 * count) - 1, int(self.place_mm // self.table.cell_pitch_mm)

    @property
    def gain(self) -> Floats:
        """Gain (n,) of each channel of the most likely hypothesis over that of the first seconds."""
        count = self.table.lone.shape[-1]
        return self.hypotheses.memory[self._best, LEVEL + 2 * count : LEVEL + 3 * count]

    def _level(self, memory: Floats) -> Floats:
        """The drift (n,) of each channel in a memory."""
        return memory[LEVEL : LEVEL + self.table.lone.shape[-1]]

    def _learn_heights(self, seen: int) -> None:
        """Follow mean and spread of the heights of this line's dots, by the column that left the window."""
        if self.columns_seen <= max(seen, 2) or self.fit > FOUND_FIT:
            return
        number = int(self.best.choice[0, SEEN]) - 3
        pattern = int(_column(self.best.choice[:, COLUMNS], self.best.choice[:, SEEN], number)[0])
        rows = [row for row in range(ROWS) if 0 < pattern < UNSEEN and pattern >> row & 1]
        for slot in (ROWS * (number % KEPT_HEIGHTS) + row for row in rows):
            height, spread = self.best.memory[0, [HEIGHT + slot, SPREAD + slot]]
            if spread < KNOWN_SPREAD:
                own = np.array([1.0, height, height**2 + spread])
                self._heights += own - (self._heights - self._prior_heights) / HEIGHTS_MEMORY
        count, first, second = self._heights
        spread = float(np.clip(second / count - (first / count) ** 2, *HEIGHT_SPREADS))
        self._settings = self._settings._replace(height=float(first / count), height_spread=spread)

    def _learn(self, charge_pC: Floats, temper: float) -> None:
        """Follow the fit of the best hypothesis, and keep drift, gains and speed of where it is good."""
        known, alive = self.best, self.sensor.alive
        parts = predicted_charges(known.state, known.choice, known.memory, self.sensor, self.table.wider)
        predicted = parts[0] + parts[1]
        residual = charge_pC - self._level(known.memory[0]) - predicted
        variance = self.sensor.floor_pC2 + (self._settings.rough * predicted) ** 2
        share = min(self.step_s / FIT_S, 1.0)
        square = float(np.mean(np.minimum(residual[alive] ** 2 / variance[alive], 50.0)))
        self.fit += share * (square - self.fit)
        if self.fit < FOUND_FIT and self.speed_mm_per_s != 0.0 and self.touching:
            self._safe_channels = self._safe_channels + share * (known.memory[0, LEVEL:] - self._safe_channels)
            self._safe_log_speed += share * (float(known.state[0, LOG_SPEED]) - self._safe_log_speed)
            self._learn_width(parts[2][alive], residual[alive], temper / variance[alive])

    def _learn_width(self, change_pC: Floats, residual_pC: Floats, weight: Floats) -> None:
        """Follow the width of the sensor by residuals (n,), of which it explains what is like its change (n,).

        Least squares with a memory; the charges of single dots are made anew where the width has moved.
        """
        fade = min(self.step_s * abs(self.speed_mm_per_s) / WIDTH_MEMORY_MM, 1.0)
        known = 1.0 / WIDTH_SPREAD**2
        own = float(weight @ change_pC**2)
        pull = fade * known * (0.0 - self._width)
        self._width_known += own - fade * (self._width_known - known)
        self._width += (float(weight @ (change_pC * residual_pC)) + pull) / self._width_known
        self._width = float(np.clip(self._width, -MOST_WIDER, MOST_WIDER))
        if abs(self._width - self._used_width) > WIDTH_STEP:
            self._used_width = self._width
            lone = self.table.lone + np.float32(self._width) * self.table.wider
            self.sensor = self.sensor._replace(lone=lone)

    def _note_time(self, time_s: float) -> None:
        """Note the time at which the best hypothesis first passes a cell, and the fit around it."""
        self._now_s = time_s
        pitch, middle = self.table.cell_pitch_mm, 0.5 * self.table.dot_pitch_mm
        while self.place_mm >= self.passed * pitch + middle:
            self._times.append(time_s)
            self.passed += 1
        rear = int(np.floor((self.place_mm - middle - NEAR_MM) / pitch)) + 1
        for number in range(max(rear, self.emitted), rear + 2):
            if abs(self.place_mm - middle - number * pitch) <= NEAR_MM:
                self._fits[number] = max(self._fits.get(number, 0.0), self.fit)
                self._asides[number] = max(self._asides.get(number, 0.0), abs(self.offset_mm))

    def _look_for_the_track(self, charge_pC: Floats) -> None:
        """Start anew where the fit is bad, beside the hypotheses so far."""
        self._patience_s -= self.step_s
        if self.is_lost and self.fit < FOUND_FIT:
            self.is_lost = False
        if self.fit <= LOST_FIT or self._patience_s > 0.0:
            return
        self.is_lost, self._patience_s = True, PATIENCE_S
        self.losses += 1
        best = replace(
            self.best, memory=np.concatenate([self.best.memory[:, :LEVEL], self._safe_channels[None]], axis=1)
        )
        fresh = around(self.table, best, self._safe_log_speed + np.linspace(-1.0, 1.0, 7))
        state, choice, memory = weighed(fresh.state, fresh.choice, fresh.memory, charge_pC, self.sensor, self._settings)
        known = self.hypotheses
        state[:, LOG_WEIGHT] += known.state[self._best, LOG_WEIGHT] - state[:, LOG_WEIGHT].max()
        self.hypotheses = Beam(
            np.concatenate([known.state, state]),
            np.concatenate([known.choice, choice]),
            np.concatenate([known.memory, memory]),
        )

    def ready_cells(self, at_end: bool = False) -> list[PassedCell]:
        """The cells that are far enough behind, or at the end all that were passed or seen."""
        found = []
        while self._is_ready(at_end):
            found.append(self._cell(self.emitted))
            self.emitted += 1
        return found

    def _is_ready(self, at_end: bool) -> bool:
        passed = 2 * self.emitted + 2
        return self.columns_seen >= (passed if at_end else max(passed + LAG_COLUMNS, FIRST_COLUMNS))

    def _cell(self, number: int) -> PassedCell:
        """The marginal of a cell over all hypotheses."""
        weight = np.exp(self.hypotheses.state[:, LOG_WEIGHT] - self.hypotheses.state[:, LOG_WEIGHT].max())
        weight /= weight.sum()
        choice = self.hypotheses.choice
        columns, seen = choice[:, COLUMNS], choice[:, SEEN] + 2 * choice[:, AHEAD]
        first, second = (_column(columns, seen, 2 * number + k) for k in (0, 1))
        known = (first < UNSEEN) & (second < UNSEEN) & (first >= 0) & (second >= 0)
        share = np.bincount(np.where(known, (first & 7) | (second & 7) << 3, 64), weight, 1 << DOTS | 1)
        cell = int(np.argmax(share[:64]))
        fit = self._fits.pop(number, self.fit)
        aside = self._asides.pop(number, 0.0)
        time = self._times.popleft() if self._times else self._now_s
        if share[64] >= 0.5:
            return PassedCell(number, -1, 0.0, time, fit, aside, np.full(64, 1.0 / 64.0))
        shares = share[:64] + share[64] / 64.0
        return PassedCell(number, cell, float(share[cell]), time, fit, aside, shares)


def _column(columns: np.ndarray, seen: np.ndarray, number: int) -> np.ndarray:
    """Patterns (h,) of a column; -1 where a hypothesis has not seen it."""
    back = seen - 1 - number
    there = (back >= 0) & (back < KEPT_COLUMNS)
    return np.where(there, (columns >> (4 * np.clip(back, 0, KEPT_COLUMNS - 1))) & 15, -1)
