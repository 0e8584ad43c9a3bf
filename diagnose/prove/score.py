"""What a verdict is worth against the truth: one case.

All scores as rates with Wilson's intervals.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from diagnose.prove.world.cases import AMBIGUOUS, LEFT_OUT, NONE, OUTSIDE, PAIR, SINGLE
from diagnose.statistics.proportions import wilson_interval

Name = tuple[str, str]
LARGEST_GROUP = 3
CLOSE_SIGMA = 1.0
ALIKE = {("charge-leakage", "film"): ("charge-leakage", "readout")}
"""Both mean a resistance parallel to the electrodes."""
Separation = Callable[[Name], float | None]
"""Of a rival from the truth in the generator's own model, in sigma; None where it has no such effect."""


@dataclass(frozen=True)
class Score:
    """One case. size : whitened root mean square per sample of the effect, nuisances removed; flaws : of the rig's.

    exact : just the true mechanisms at their components. grouped : exact, or a fair group that holds the truth.
    component, mechanism : as far as something is named. group : members of the group that holds the truth, else 1.
    main_part : named as most of what is missing; main_right : exactly the truth, or in a fair group with it.
    overlap : of the localised excess with that of the generator, 0 to 1. held_out : error over noise floor.
    covered : value -> whether its interval holds it. next_sigma : what the next press is said to separate.
    equals : explanations that are as good as the truth, itself among them, named or not.
    resolved : whether that press, once made, leaves the truth alone; smaller : whether it leaves fewer equals, of which
    the truth is one. None where it was not made.
    """

    case: int
    kind: str
    bench: str
    truth: tuple[Name, ...]
    size: float
    detected: bool
    named: tuple[Name, ...]
    abstained: bool
    exact: bool
    grouped: bool
    mechanism: bool
    component: bool
    group: int = 1
    overlap: float | None = None
    held_out: float | None = None
    gain: float | None = None
    covered: Mapping[str, bool] = field(default_factory=dict)
    next_sigma: float | None = None
    resolved: bool | None = None
    seconds: float = 0.0
    main_part: tuple[Name, ...] = ()
    main_right: bool = False
    equals: int = 1
    smaller: bool | None = None
    flaws: float = 0.0

    @property
    def right(self) -> bool:
        """Whether the name that is given, at either grade, is right."""
        return self.grouped or self.main_right

    @property
    def wrong(self) -> bool:
        """Whether a name is given, at either grade, that is not right."""
        return bool(self.named or self.main_part) and not self.right

    def plain(self) -> dict[str, Any]:
        """As JSON has it."""
        return {**asdict(self), "truth": list(map(list, self.truth)), "named": list(map(list, self.named)),
                "main_part": list(map(list, self.main_part))}  # fmt: skip


def scored(truth: Mapping[str, Any], verdict: Mapping[str, Any], separation: Separation, seconds: float = 0.0) -> Score:
    """Compare verdict.json with the revealed truth."""
    true = _names(truth["mechanisms"])
    named = () if verdict["unexplained"] else _names(verdict["missing_physics"])
    main = _names(verdict.get("main_part") or [])
    exact = bool(named) and named == true
    groups = verdict.get("ambiguous_with") or []
    group = _group_with(true, named or main, groups)
    fair = 1 < len(group) <= LARGEST_GROUP and _inseparable(group, true, separation)
    held_out = (verdict.get("fit") or {}).get("held_out") or {}
    floor = held_out.get("noise_floor_nrmse")
    return Score(
        truth["number"],
        truth["kind"],
        truth["bench"],
        true,
        truth["whitened_rms"],
        bool(verdict["mismatch"]),
        named,
        bool(verdict["unexplained"]),
        exact,
        exact or (bool(named) and fair),
        bool(named) and {m for m, _ in named} == {m for m, _ in true},
        bool(named) and {c for _, c in named} == {c for _, c in true},
        len(group),
        _overlap(truth["per_run"], verdict.get("where") or []),
        held_out["nrmse_after"] / floor if named and floor and held_out.get("nrmse_after") is not None else None,
        held_out.get("log_score_gain_per_press"),
        _covered(truth["mechanisms"], verdict["missing_physics"]) if exact else {},
        (verdict.get("next_experiment") or {}).get("expected_separation_sigma"),
        seconds=seconds,
        main_part=main,
        main_right=bool(main) and (main == true or fair),
        equals=len(_group_with(true, true, groups)),
        flaws=truth.get("flaws_rms", 0.0),
    )


def _names(mechanisms: Sequence[Mapping[str, Any]]) -> tuple[Name, ...]:
    found = {(one["mechanism"], one["component"]) for one in mechanisms}
    return tuple(sorted(ALIKE.get(name, name) for name in found))


def _group_with(true: tuple[Name, ...], named: tuple[Name, ...], groups: Sequence[Any]) -> list[tuple[Name, ...]]:
    """The group that holds both what is true and what is named; just the truth where there is none."""
    for group in groups:
        members = sorted({_member(member) for member in group})
        if true in members and named in members:
            return members
    return [true]


def _member(member: Mapping[str, str]) -> tuple[Name, ...]:
    """A pair is written with a plus."""
    pairs = zip(member["mechanism"].split(" + "), member["component"].split(" + "), strict=True)
    return tuple(sorted(ALIKE.get(name, name) for name in set(pairs)))


def _inseparable(group: Sequence[tuple[Name, ...]], true: tuple[Name, ...], separation: Separation) -> bool:
    """Whether the generator's own model cannot tell the truth from any other member either."""
    for member in group:
        if member == true:
            continue
        distances = [separation(name) for name in member]
        if any(distance is None or distance >= CLOSE_SIGMA for distance in distances):
            return False
    return True


def _overlap(true: Mapping[str, float], where: Sequence[Mapping[str, Any]]) -> float | None:
    """Common part of both distributions of the excess over runs and channels; None where either has none."""
    told: dict[str, float] = {}
    for place in where:
        key = f"{place['run']} | {place['channel']}"
        told[key] = told.get(key, 0.0) + float(place["share_of_excess"])
    total = sum(told.values())
    if not total or not sum(true.values()):
        return None
    return sum(min(share, told.get(key, 0.0) / total) for key, share in true.items())


def _covered(true: Sequence[Mapping[str, Any]], named: Sequence[Mapping[str, Any]]) -> dict[str, bool]:
    """Values whose truth is known in the same terms."""
    found = {}
    for one in true:
        parameters: Mapping[str, Any] = next((n["parameters"] for n in named if n["mechanism"] == one["mechanism"]), {})
        for name, value in one["values"].items():
            interval = parameters.get(name)
            if interval is not None and interval["low"] is not None and interval["high"] is not None:
                found[f"{one['mechanism']}.{name}"] = interval["low"] <= value <= interval["high"]
    return found


CLEAR = 5.0
"""Size from which an effect has to be named."""
ABOVE_FLAWS = 2.0
"""Times the flaws of its rig from which an effect is the larger part of a mismatch by far: four fifths of its power."""
EDGES = (0.0, 0.35, 0.75, 1.5, 3.5, 7.5, 15.0, np.inf)
ON_FLOOR = 1.2
Item = TypeVar("Item")


def rate(items: Iterable[Item], holds: Callable[[Item], bool]) -> dict[str, Any]:
    """Of how many it holds, with the 95 % interval."""
    found = [bool(holds(item)) for item in items]
    return share(sum(found), len(found))


def share(count: int, of: int) -> dict[str, Any]:
    """Count, total and Wilson interval of a share."""
    if of == 0:
        return {"count": 0, "of": 0, "rate": None, "low": None, "high": None}
    low, high = wilson_interval(count, of)
    return {"count": count, "of": of, "rate": count / of, "low": low, "high": high}


def tally(scores: Sequence[Score]) -> dict[str, Any]:
    """Every rate of the proof."""
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
    """Of clear effects and of all, by mechanism and component."""
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
