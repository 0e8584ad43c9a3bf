"""How every candidate would change the recording, near its off value and at a finite size."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.fit.observed_model import SLOPE_STEP_SHARE, ObservedModel
from diagnose.forward import Candidate, Coordinate, Setting
from foundation.arrays import Bools, Floats

FLAT = 0.05  # of the secant: a slope below it is none


@dataclass(frozen=True)
class Sensitivity:
    """columns : (n, q) change per unit of each coordinate, a secant where there is no slope at 0.

    non_negative : (q,) whether 0 is the lower end. sign : (q,) -1 where 0 is the upper end; columns have it already.
    finite : (n, s) change at starts, and coordinates (s, q) there.
    """

    candidate: Candidate
    columns: Floats
    non_negative: Bools
    sign: Floats
    finite: Floats
    places: Floats


def sensitivity(
    model: ObservedModel, values: Floats, candidate: Candidate, others: Sequence[Setting] = ()
) -> Sensitivity:
    """Sensitivity of the signals to one candidate beside others that are on, at nuisances (p,)."""
    without = model.vector(values, others)
    count = len(candidate.coordinates)

    def change(number: int, value: float) -> Floats | None:
        """(n,); None where the model has no answer."""
        at = np.zeros(count)
        at[number] = value
        try:
            return np.asarray(model.vector(values, [*others, Setting(candidate, tuple(at.tolist()))]) - without)
        except ValueError:
            return None

    columns, finite, places = [], [], []
    for number, coordinate in enumerate(candidate.coordinates):
        made = {start: change(number, start) for start in coordinate.starts}
        found = {start: column for start, column in made.items() if column is not None}
        finite += list(found.values())
        places += [np.eye(count)[number] * start for start in found]
        step = SLOPE_STEP_SHARE * min(coordinate.starts, key=abs)
        first = change(number, step)
        slope = first / step if first is not None else np.zeros(len(without))
        secants = [column / start for start, column in found.items()]
        largest = max(secants, key=lambda secant: float(np.linalg.norm(secant)), default=slope)
        flat = np.linalg.norm(slope) < FLAT * np.linalg.norm(largest)
        columns.append(largest if flat else slope)
    sign = np.array([-1.0 if c.high <= 0.0 else 1.0 for c in candidate.coordinates])
    return Sensitivity(
        candidate,
        np.column_stack(columns) * sign,
        np.array([one_sided(c) for c in candidate.coordinates]),
        sign,
        np.column_stack(finite) if finite else np.zeros((len(without), 0)),
        np.array(places).reshape(-1, count),
    )


def one_sided(coordinate: Coordinate) -> bool:
    """Whether 0 is an end of its range."""
    return coordinate.low >= 0.0 or coordinate.high <= 0.0
