"""Quantities that are comparable between laws, read from the tables."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from diagnose.engines.segment.prepared import Prepared
from diagnose.forward import Candidate, Setting

COMPARED_DEPTH_SHARE = 0.5
"""Share of the largest depth at which the second cycle is compared with the first: near it both are the same."""
Derived = Callable[[Sequence[float]], dict[str, float]]


def with_derived(candidate: Candidate, prepared: Prepared) -> Candidate:
    """Candidate that derives force_ratio, with over without it at the deepest press, or the loss_ratio of the force.

    Both can be derived once the candidate is prepared.
    """
    if candidate.compared:
        return replace(candidate, derived=COMPARISONS[candidate.compared](candidate, prepared))
    return candidate


def _force_ratio(candidate: Candidate, prepared: Prepared) -> Derived:
    def force_ratio(values: Sequence[float]) -> dict[str, float]:
        change = prepared.table_change((0.0, 0.0), [Setting(candidate, tuple(values))])
        return {"force_ratio": 1.0 if change is None else float(np.exp(change[-1, 0]))}

    return force_ratio


def _loss_ratio(candidate: Candidate, prepared: Prepared) -> Derived:
    """Function that gives 1 - second / first cycle force at equal depth."""

    def loss_ratio(values: Sequence[float]) -> dict[str, float]:
        if not any(values):
            return {"loss_ratio": 0.0}
        (history,) = prepared.path_histories([Setting(candidate, tuple(values))])
        again = history.changes_along(np.array([1.0, COMPARED_DEPTH_SHARE]))[0][1, 0]
        return {"loss_ratio": -float(again)}

    return loss_ratio


COMPARISONS = {"force_ratio": _force_ratio, "loss_ratio": _loss_ratio}
