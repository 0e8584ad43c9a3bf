"""The limit of each condition of reading.

At the limit, fewer characters than promised are read; it is bracketed by the values of the axis, beyond them by
doubling the distance, and then halved.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from softdot.reading.conditions import BOUNDS, ReadingConditions
from softdot.reading.study import ReadingStudy, repeats_of

HALVINGS, DOUBLINGS = 4, 3
"""Values that are read to narrow a limit, and to find one beyond the axis."""


@dataclass
class Readings:
    """The readings of a study so far: for each condition the number of right characters, and of all."""

    records: dict[ReadingConditions, dict[str, Any]] = field(default_factory=dict)

    def share(self, study: ReadingStudy, conditions: ReadingConditions) -> float | None:
        """The share of the characters that was read, over all repeats; None where a reading was refused."""
        found = [self.records[one] for one in repeats_of(study, conditions)]
        if any(one["status"] != "read" for one in found):
            return None
        return float(sum(one["right"] for one in found) / sum(one["of"] for one in found))


@dataclass(frozen=True)
class ConditionLimit:
    """The limit of one condition as far as it is known.

    good : the farthest value that is still read, None where the usual one is not. bad : the nearest value that is not.
    following : the value to be read next, None where the limit is as narrow as was asked.
    """

    good: float | None
    bad: float | None
    following: float | None


def limits_of(study: ReadingStudy, readings: Readings) -> Iterator[tuple[str, ConditionLimit]]:
    """The limit of each condition, as far as it is known, by name."""
    for name, values in study.axes.items():
        start = getattr(study.base, name)
        usual = values[0] if start is None else start
        rising = np.mean(values) >= usual
        ahead = sorted({*values, usual}, reverse=not rising)
        ahead = ahead[ahead.index(usual) :]
        yield name, _limit(study, readings, name, [float(one) for one in ahead])


def _limit(study: ReadingStudy, readings: Readings, name: str, ahead: list[float]) -> ConditionLimit:
    """The limit of one condition, from all readings at its usual value and on the way ahead."""
    start, sign = ahead[0], 1.0 if ahead[-1] >= ahead[0] else -1.0
    known: dict[float, bool] = {}
    for conditions in {replace(one, seed=study.base.seed) for one in readings.records}:
        value = getattr(conditions, name)
        value = start if value is None else value
        alone = replace(conditions, **{name: getattr(study.base, name)}) == study.base
        if alone and sign * (value - start) >= 0.0:
            share = readings.share(study, conditions)
            known[value] = share is not None and share >= study.accuracy
    order = sorted(known, key=lambda value: sign * value)
    bad = next((value for value in order if not known[value]), None)
    good = [value for value in order if known[value] and (bad is None or sign * (bad - value) > 0.0)]
    extra = len(set(known) - set(ahead))
    if not good:
        return ConditionLimit(None, bad, None)
    if bad is None:
        further = good[-1] + (good[-1] - start or sign)
        further = float(np.clip(further, *BOUNDS[name]))
        done = extra >= DOUBLINGS or further == good[-1]
        return ConditionLimit(good[-1], None, None if done else further)
    first = next((value for value in order if value not in ahead), None)
    halved = extra >= HALVINGS + (DOUBLINGS if first is not None and sign * (first - ahead[-1]) > 0.0 else 0)
    return ConditionLimit(good[-1], bad, None if halved else 0.5 * (good[-1] + bad))
