"""How often rivals are right: false names, clear effects named, unknown ones left unnamed, held-out errors."""

from collections.abc import Mapping, Sequence
from typing import Any

from softdot.studies.proof.rates import CLEAR
from softdot.studies.proof.rates import rate as counted
from softdot.studies.proof.score import ALIKE
from softdot.studies.proof.world.cases import LEFT_OUT, NONE, OUTSIDE, SINGLE


def rival_rates(records: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Rates of every rival: false names without effect, clear effects named, unknown ones left unnamed,
    held-out error.
    """
    scored = [record for record in records if record["score"] is not None]
    names = sorted({name for record in scored for name in record["rivals"]})
    return {name: _of_rival(name, scored) for name in names}


def _of_rival(name: str, records: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    asked = [r for r in records if name in r["rivals"]]

    def rate(kinds: tuple[str, ...], least: float, holds: Any) -> dict[str, Any]:
        inside = [r for r in asked if r["truth"]["kind"] in kinds and r["truth"]["whitened_rms"] >= least]
        return counted(inside, lambda r: holds(r["rivals"][name], r))

    clear = [
        r["rivals"][name]["after"]
        for r in asked
        if r["truth"]["kind"] == SINGLE and r["truth"]["whitened_rms"] >= CLEAR
    ]
    return {
        "false_names_without_effect": rate((NONE,), 0.0, lambda o, _: o["named"] is not None),
        "clear_exact": rate((SINGLE,), CLEAR, lambda o, r: _is(o["named"], r)),
        "unknown_not_named": rate((LEFT_OUT, OUTSIDE), 0.0, lambda o, _: o["named"] is None),
        "held_out_over_noise": sorted(clear)[len(clear) // 2] if clear else None,
    }


def _is(named: Any, record: Mapping[str, Any]) -> bool:
    true = [(one["mechanism"], one["component"]) for one in record["truth"]["mechanisms"]]
    return named is not None and true == [ALIKE.get(tuple(named), tuple(named))]
