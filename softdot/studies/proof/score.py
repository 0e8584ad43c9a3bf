"""What a verdict is worth against the truth: one case."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

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
        """The score as JSON has it."""
        return {**asdict(self), "truth": list(map(list, self.truth)), "named": list(map(list, self.named)),
                "main_part": list(map(list, self.main_part))}  # fmt: skip


def score_verdict(
    truth: Mapping[str, Any], verdict: Mapping[str, Any], separation: Separation, seconds: float = 0.0
) -> Score:
    """Score verdict.json against the revealed truth."""
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
        _coverage(truth["mechanisms"], verdict["missing_physics"]) if exact else {},
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


def _coverage(true: Sequence[Mapping[str, Any]], named: Sequence[Mapping[str, Any]]) -> dict[str, bool]:
    """Whether the interval of each named value covers the true one, where that is known in the same terms."""
    found = {}
    for one in true:
        parameters: Mapping[str, Any] = next((n["parameters"] for n in named if n["mechanism"] == one["mechanism"]), {})
        for name, value in one["values"].items():
            interval = parameters.get(name)
            if interval is not None and interval["low"] is not None and interval["high"] is not None:
                found[f"{one['mechanism']}.{name}"] = interval["low"] <= value <= interval["high"]
    return found
