"""Relaxation as a spectrum: one Prony branch a decade of time, as far as the recording can show it.

The coordinates are the branches' moduli over the long-term one, E_i / E_inf = t_i, so that g_i = t_i / (1 + sum t):
any values that are not negative make a valid series. Half a decade off its time, a branch differs from its neighbours'
sum by about a percent of what relaxes, so that the times need not be fitted.
"""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np

from diagnose.forward import Candidate, Coordinate
from diagnose.recording import Recording
from diagnose.vocabulary.memory import relaxed_fraction

MOST_OF_COUPON = 20.0  # of E_i / E_inf: a tape or a gel may relax by 95 % within a decade


def relaxation_times(recording: Recording) -> tuple[float, ...]:
    """Times in s, a decade apart, between a third of the quickest loading and the longest run."""
    longest = max(float(run.time_s[-1] - run.time_s[0]) for run in recording.runs)
    shortest = max(min(_quickest(recording)) / 3.0, min(2.0 * run.step_s for run in recording.runs))
    count = max(1, ceil(np.log10(longest / shortest)))
    slack = np.log10(longest / shortest) - (count - 1)
    return tuple(float(shortest * 10.0 ** (0.5 * slack + n)) for n in range(count))


def _quickest(recording: Recording) -> list[float]:
    """Time of every loading, s."""
    found = [
        float(run.time_s[max(press.held - 1, press.touch)] - run.time_s[press.touch])
        for run, phases in zip(recording.runs, recording.phases, strict=True)
        for press in phases.presses
    ]
    return [time for time in found if time > 0.0] or [float(recording.runs[0].step_s)]


def viscoelasticity(make: type[Candidate], component: str, times_s: Sequence[float], most: float) -> Candidate:
    """The candidate at a component, one coordinate a branch; most : of each E_i / E_inf."""

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        moduli, times = _series(values, times_s)
        return {"relative_moduli": moduli, "relaxation_times_s": times}

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"relaxed_fraction": relaxed_fraction(*_series(values, times_s))}

    coordinates = tuple(Coordinate(f"modulus_at_{time:.3g}_s", 0.0, most, (0.1, 0.5)) for time in times_s)
    units = {"relative_moduli": "", "relaxation_times_s": "s", "relaxed_fraction": ""}
    return make("viscoelasticity", component, coordinates, parameters, derived, units)


def _series(values: Sequence[float], times_s: Sequence[float]) -> tuple[list[float], list[float]]:
    """g_i and times of the branches that relax at all, of the values E_i / E_inf."""
    whole = 1.0 + sum(values)
    kept = [(value / whole, time) for value, time in zip(values, times_s, strict=True) if value > 0.0]
    return [g for g, _ in kept], [time for _, time in kept]
