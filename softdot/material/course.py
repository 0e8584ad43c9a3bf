"""The course of a test: where it is loaded, held and let go, thinned to what a fit needs."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import uniform_filter1d

from foundation.arrays import Bools, Floats, Ints
from softdot.material.specimen_file import SpecimenTest

LOADING, HOLD, UNLOADING = range(3)
TURN_SHARE = 0.1  # of the range of strain: smaller turns are none
SLOW_RATE_SHARE = 0.1  # of the rate by which half of the path is covered
SHORTEST_HOLD_SHARE = 0.2  # of the time that the whole range takes at that rate
SMOOTHING_SAMPLES = 5
BINS_OF_RANGE, BINS_OF_HOLD = 100, 40


@dataclass(frozen=True)
class SpecimenCourse:
    """A test in s samples: time_s, strain and stress_MPa (s,), and of each its phase and the number of its cycle.

    virgin (s,) : loading to strains that were not reached before, and before anything was held. has_time : whether the
    file has times; else time_s counts samples.
    """

    test: SpecimenTest
    has_time: bool
    time_s: Floats
    strain: Floats
    stress_MPa: Floats
    phase: Ints
    cycle: Ints
    virgin: Bools

    @property
    def holds_s(self) -> list[float]:
        """Duration of each hold in s."""
        return [float(np.ptp(self.time_s[one])) for one in self._holds]

    def holds_in(self, strain_range: float) -> bool:
        """Whether anything is held within a range of strain."""
        return any(float(self.strain[one].mean()) <= 1.02 * strain_range for one in self._holds)

    @property
    def _holds(self) -> list[slice]:
        """Samples of each hold."""
        edges = np.flatnonzero(np.diff(np.concatenate([[0], self.phase == HOLD, [0]]).astype(np.int64)))
        return [slice(a, b) for a, b in edges.reshape(-1, 2)]

    @property
    def cycles(self) -> int:
        """Number of loadings that were let go again."""
        return len({int(one) for one in self.cycle[self.phase == UNLOADING]})

    @property
    def peaks_MPa(self) -> list[float]:
        """Largest stress of each cycle."""
        return [float(self.stress_MPa[self.cycle == n].max()) for n in range(int(self.cycle.max()) + 1)]


def course_of(test: SpecimenTest, strain_range: float) -> SpecimenCourse:
    """Cut a test into loading, holds and unloading, and average samples that lie close together.

    strain_range : of the fit, which is divided into bins.
    """
    time = np.arange(len(test.strain), dtype=np.float64) if test.time_s is None else test.time_s - test.time_s[0]
    held = np.zeros(len(time), dtype=bool) if test.time_s is None else _held(time, test.strain)
    phase, cycle = np.zeros(len(time), dtype=np.int64), np.zeros(len(time), dtype=np.int64)
    number = -1
    for start, end in pairwise([*_turns(test.strain), len(time)]):
        rises = test.strain[end - 1] > test.strain[start]
        number += int(rises or number < 0)
        phase[start:end], cycle[start:end] = (LOADING if rises else UNLOADING), number
    phase[held] = HOLD
    starts = _bins(time, test.strain / strain_range, phase, cycle)
    sizes = np.diff([*starts, len(time)])
    time, strain, stress = (np.add.reduceat(one, starts) / sizes for one in (time, test.strain, test.stress_MPa))
    virgin = _virgin(strain, phase[starts])
    return SpecimenCourse(test, test.time_s is not None, time, strain, stress, phase[starts], cycle[starts], virgin)


def _turns(strain: Floats) -> Iterator[int]:
    """The first sample, and each at which the strain turns by more than a share of its range."""
    yield 0
    least, up, extreme = TURN_SHARE * float(np.ptp(strain)), True, 0
    for n, value in enumerate(strain):
        ahead = value - strain[extreme] if up else strain[extreme] - value
        if ahead >= 0.0:
            extreme = n
        elif -ahead > least:
            if extreme > 0:
                yield extreme + 1
            up, extreme = not up, n


def _held(time: Floats, strain: Floats) -> Bools:
    """Whether the strain rests at each sample (t,), for a good part of the time that a loading takes."""
    rate = np.abs(np.gradient(uniform_filter1d(strain, SMOOTHING_SAMPLES), time))
    path = np.abs(np.diff(strain, prepend=strain[0]))
    order = np.argsort(rate)
    usual = float(rate[order][np.searchsorted(np.cumsum(path[order]), 0.5 * path.sum())])
    slow = rate < SLOW_RATE_SHARE * usual
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow, [0]]).astype(np.int64))).reshape(-1, 2)
    rests = np.zeros(len(time), dtype=bool)
    for a, b in edges:
        long = time[b - 1] - time[a] > SHORTEST_HOLD_SHARE * float(np.ptp(strain)) / usual
        rests[a:b] = long and b - a > 4 and strain[a] > TURN_SHARE * strain.max()
    return rests


def _bins(time: Floats, part: Floats, phase: Ints, cycle: Ints) -> Ints:
    """First sample of each bin: even in the part (t,) of the range while it moves, in log time while it rests."""
    level = BINS_OF_RANGE * np.clip(part, None, 2.0)
    changes = (np.diff(phase, prepend=-1) != 0) | (np.diff(cycle, prepend=-1) != 0)
    for a, b in pairwise([*np.flatnonzero(changes), len(time)]):
        if phase[a] == HOLD:
            since = 1.0 + np.arange(b - a) if b - a < 3 else (time[a:b] - time[a]) / (time[a + 1] - time[a])
            key = BINS_OF_HOLD * np.log1p(since) / np.log1p(since[-1])
        else:
            key = np.maximum.accumulate(level[a:b] if phase[a] == LOADING else -level[a:b])
        changes[a:b] |= np.diff(np.floor(key), prepend=-np.inf) > 0.0
    return np.flatnonzero(changes)


def _virgin(strain: Floats, phase: Ints) -> Bools:
    """Whether each sample (s,) loads beyond all before, with nothing held before."""
    before = np.maximum.accumulate(np.concatenate([[-np.inf], strain[:-1]]))
    rested = np.maximum.accumulate(phase == HOLD)
    return np.asarray((phase == LOADING) & (strain > before) & ~rested)
