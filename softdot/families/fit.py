"""From records of presses to the quantities of a family, and where its own error is largest."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from foundation.arrays import Floats
from softdot.families.quantity import FamilyQuantity
from softdot.sweeps.points import Record

FORCE, VOLTAGE = "reaction_force_N", "open_circuit_voltage_V"
JUDGED = (FORCE, VOLTAGE)
"""Quantities whose accuracy is asked for."""


def fit_quantities(
    places: Floats,
    records: Sequence[Record],
    start: Mapping[str, FamilyQuantity] | None = None,
    names: Sequence[str] = (),
) -> dict[str, FamilyQuantity]:
    """Quantity by name, from the records (n) of presses at places (n, d).

    start : an earlier fit, whose hyperparameters are the first guess. names : these quantities alone; none: all.
    """
    found = {}
    for name in names or records[0]["courses"]:
        values = np.array([record["courses"][name] for record in records])
        slopes = np.array([record["slopes"][name] for record in records])
        before = None if start is None or name not in start else start[name].process
        found[name] = FamilyQuantity(places, values, slopes, start=None if before is None else before.scales)
    return found


def expected_error(quantity: FamilyQuantity, places: Floats) -> float:
    """Relative error of the last step that 95 % of designs are expected to stay below: half the interval, its median
    over designs at places (q, d).
    """
    return quantity.factor * float(np.median(quantity.relative_deviation(places)))


def next_places(
    quantities: Mapping[str, FamilyQuantity], asked: Mapping[str, float], candidates: Floats, count: int
) -> Floats:
    """The candidates (count, d) at which the deviations over the asked accuracies are largest.

    After each the process takes its own prediction for a press there, so that the next one is elsewhere.
    """
    known = dict(quantities)
    chosen = []
    for _ in range(count):
        score = sum(known[name].relative_deviation(candidates) / accuracy for name, accuracy in asked.items())
        best = candidates[[int(np.argmax(score))]]
        chosen.append(best[0])
        known = {name: _with_guess(known[name], best) for name in asked}
    return np.array(chosen)


def _with_guess(quantity: FamilyQuantity, place: Floats) -> FamilyQuantity:
    """A quantity with its own prediction at a place (1, d) as a further press."""
    course = quantity.course(place)
    places, values = np.vstack([quantity.places, place]), np.vstack([quantity.values, course.value])
    slopes = None if quantity.slopes is None else np.concatenate([quantity.slopes, course.slopes])
    scales = None if quantity.process is None else quantity.process.scales
    return FamilyQuantity(places, values, slopes, scales)


def held_out_row(quantities: Mapping[str, FamilyQuantity], place: Floats, record: Record) -> dict[str, Any]:
    """Errors in percent of the last step of a press at a place (d,) that took no part, and whether its whole course is
    within the intervals.
    """
    row: dict[str, Any] = {}
    for name, quantity in quantities.items():
        if name in JUDGED:
            pressed = float(record["courses"][name][-1])
            course = quantity.course(np.asarray(place)[None])
            value = float(course.value[0, -1])
            is_within = (course.low[0] <= record["courses"][name]) & (record["courses"][name] <= course.high[0])
            row[name] = {
                "pressed": pressed,
                "family": value,
                "error_percent": 100.0 * abs(value - pressed) / abs(pressed) if pressed else 0.0,
                "within": bool(is_within.all()),
            }
    return row
