"""All scores as rates with Wilson's intervals."""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from diagnose.statistics.proportions import wilson_interval
from softdot.studies.proof.score import Score
from softdot.studies.proof.world.cases import AMBIGUOUS, LEFT_OUT, NONE, OUTSIDE, PAIR, SINGLE

CLEAR = 5.0
"""Size from which an effect has to be named."""
ABOVE_FLAWS = 2.0
"""Times the flaws of its rig from which an effect is the larger part of a mismatch by far: four fifths of its power."""
EDGES = (0.0, 0.35, 0.75, 1.5, 3.5, 7.5, 15.0, np.inf)
ON_FLOOR = 1.2
Item = TypeVar("Item")


def rate(items: Iterable[Item], holds: Callable[[Item], bool]) -> dict[str, Any]:
    """Share of the items for which a condition holds, with its 95 % interval."""
    found = [bool(holds(item)) for item in items]
    return share(sum(found), len(found))


def share(count: int, of: int) -> dict[str, Any]:
    """Count, total and Wilson interval of a share."""
    if of == 0:
        return {"count": 0, "of": 0, "rate": None, "low": None, "high": None}
    low, high = wilson_interval(count, of)
    return {"count": count, "of": of, "rate": count / of, "low": low, "high": high}


def tally(scores: Sequence[Score]) -> dict[str, Any]:
    """Rates of the proof."""
    of = {kind: [s for s in scores if s.kind == kind] for kind in (NONE, SINGLE, PAIR, LEFT_OUT, OUTSIDE, AMBIGUOUS)}
    clear = [s for s in of[SINGLE] if s.size >= CLEAR]
    flawed = [s for s in of[SINGLE] if s.flaws]
    above = [s for s in flawed if s.size >= ABOVE_FLAWS * s.flaws]
    below = [s for s in flawed if s.size < ABOVE_FLAWS * s.flaws]
    told = [s for s in scores if s.exact and s.held_out is not None]
    covered = [(name, holds) for s in scores for name, holds in s.covered.items()]
    return {
        "false_names_without_effect": rate(of[NONE], lambda s: bool(s.named)),
        "false_alarms_without_effect": rate(of[NONE], lambda s: s.detected),
        "abstention_left_out": rate(of[LEFT_OUT], lambda s: not s.named),
        "abstention_outside": rate(of[OUTSIDE], lambda s: not s.named),
        "abstention_unknown_clear": rate(
            [s for s in of[LEFT_OUT] + of[OUTSIDE] if s.size >= CLEAR], lambda s: s.abstained),
        "clear_named_or_grouped": rate(clear, lambda s: s.grouped),
        "clear_exact": rate(clear, lambda s: s.exact),
        "main_parts_without_effect": rate(of[NONE], lambda s: bool(s.main_part)),
        "main_parts_of_unknown": rate(of[LEFT_OUT] + of[OUTSIDE], lambda s: bool(s.main_part)),
        "names_right": rate([s for s in scores if s.named or s.main_part], lambda s: s.right),
        "clear_right": rate(clear, lambda s: s.exact or s.main_part == s.truth),
        "clear_right_or_grouped": rate(clear, lambda s: s.right),
        "clear_wrong": rate(clear, lambda s: s.wrong),
        "above_flaws_right": rate(above, lambda s: s.right),
        "above_flaws_wrong": rate(above, lambda s: s.wrong),
        "below_flaws_right": rate(below, lambda s: s.right),
        "below_flaws_wrong": rate(below, lambda s: s.wrong),
        "clear_component": rate(clear, lambda s: s.component),
        "pairs_exact": rate(of[PAIR], lambda s: s.exact),
        "ambiguous_told": rate(of[AMBIGUOUS], lambda s: s.group > 1 or not s.named),
        "next_press_narrows": rate([s for s in scores if s.smaller is not None], lambda s: bool(s.smaller)),
        "next_press_resolves": rate([s for s in scores if s.resolved is not None], lambda s: bool(s.resolved)),
        "held_out_on_floor": rate(told, lambda s: (s.held_out or 0.0) <= ON_FLOOR),
        "covered": rate(covered, lambda one: one[1]),
        "covered_by_value": {name: rate([h for n, h in covered if n == name], bool) for name in
                             sorted({n for n, _ in covered})},
        "mean_group": float(np.mean([s.group for s in clear if s.grouped])) if any(s.grouped for s in clear) else None,
        "mean_overlap": _mean([s.overlap for s in of[SINGLE] if s.overlap is not None]),
        "by_size": _by_size(of[SINGLE]),
        "by_mechanism": _by_mechanism(of[SINGLE]),
        "seconds_per_case": _mean([s.seconds for s in scores]),
    }  # fmt: skip


def _by_size(scores: Sequence[Score]) -> list[dict[str, Any]]:
    """Detection and naming against the size of the effect."""
    bins = []
    for low, high in pairwise(EDGES):
        inside = [s for s in scores if low <= s.size < high]
        if inside:
            bins.append({
                "from": low, "to": high if np.isfinite(high) else None,
                "median": float(np.median([s.size for s in inside])),
                "detected": rate(inside, lambda s: s.detected), "named": rate(inside, lambda s: s.grouped),
                "wrong": rate(inside, lambda s: bool(s.named) and not s.grouped),
            })  # fmt: skip
    return bins


def _by_mechanism(scores: Sequence[Score]) -> dict[str, Any]:
    """Rates of clear effects and of all, by mechanism and component."""
    names = sorted({s.truth for s in scores})
    return {
        " + ".join(f"{m} ({c})" for m, c in name): {
            "all": rate([s for s in scores if s.truth == name], lambda s: s.grouped),
            "clear": rate([s for s in scores if s.truth == name and s.size >= CLEAR], lambda s: s.grouped),
        }
        for name in names
    }


def _mean(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None
