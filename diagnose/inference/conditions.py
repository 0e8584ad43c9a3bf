"""Conditions of a recording that are held out in turn, and which of them go no farther than all others."""

from dataclasses import dataclass

import numpy as np

from diagnose.fit.samples import Samples
from diagnose.noise.repeats import repeat_groups
from foundation.arrays import Bools, Floats, Ints

FEWEST_CONDITIONS = 3
NEARLY_ALL = 0.95  # of the coefficients in one group: a sample or two of another phase are no condition
MOST_FOLDS = 12  # groups of conditions that are left out in turn
FARTHER = 0.05  # of the range of a drive: a condition that goes so much farther than all others is extrapolated to


@dataclass(frozen=True)
class Conditions:
    """fold : (n,) number of the group of conditions of each coefficient. judged : (f,) whether a group is predicted;
    what none of the others reaches would ask of a law what it was never fitted to.
    """

    fold: Ints
    judged: Bools

    @property
    def is_one(self) -> bool:
        """Whether nearly all coefficients belong to one group: a single loading, beside which nothing is predicted."""
        return bool(np.bincount(self.fold).max() >= NEARLY_ALL * len(self.fold))


def conditions_of(samples: Samples) -> Conditions:
    """All groups; all of them are judged where too few stay within the reach of the others."""
    fold = np.unique(condition_labels(samples), return_inverse=True)[1].ravel() % MOST_FOLDS
    within = within_reach(samples, fold)
    return Conditions(fold, within if within.sum() >= FEWEST_CONDITIONS else np.ones(len(within), dtype=bool))


def condition_labels(samples: Samples) -> Ints:
    """Labels (n,) of what is held out together: runs that repeat each other; of fewer than three such conditions their
    presses, and of fewer than three presses their phases, since one rate or depth alone fixes no law.
    """
    home = {number: number for number in range(len(samples.recording.runs))}
    for group in repeat_groups(samples.recording.runs, samples.recording.phases):
        home |= dict.fromkeys(group, group[0])
    conditions = np.array([home[number] for number in range(len(home))])[samples.run]
    phases = np.unique(np.column_stack([samples.press, samples.phase]), axis=0, return_inverse=True)[1].ravel()
    choices = (conditions, samples.press, phases)
    found = next((labels for labels in choices if len(np.unique(labels)) >= FEWEST_CONDITIONS), phases)
    return np.asarray(found, dtype=np.int64)


def within_reach(samples: Samples, fold: Ints) -> Bools:
    """Flags (f,) of the groups whose drive stays within what others of the same drive reach, or that have it alone."""
    count = int(fold.max()) + 1
    within = np.ones(count, dtype=bool)
    for drive in {run.drive for run in samples.recording.runs}:
        low, high = _reaches(samples, fold, drive, count)
        farther = FARTHER * (high.max() - low.min())
        for number in range(count):
            others = np.arange(count) != number
            lowest, highest = low[others].min(initial=np.inf), high[others].max(initial=-np.inf)
            if np.isfinite(lowest):
                within[number] &= low[number] >= lowest - farther and high[number] <= highest + farther
    return within


def _reaches(samples: Samples, fold: Ints, drive: str, count: int) -> tuple[Floats, Floats]:
    """Least and largest value (f,) of a drive in each group; inf and -inf where it has none."""
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    for block in samples.blocks:
        run = samples.recording.runs[block.run]
        if run.drive == drive:
            values = run.drive_values[block.observed_mask]
            np.minimum.at(low, fold[block.rows], values)
            np.maximum.at(high, fold[block.rows], values)
    return low, high
