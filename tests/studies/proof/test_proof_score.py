"""Scores of verdicts that were written by hand."""

import pytest

from diagnose.statistics.proportions import wilson_interval
from softdot.studies.proof.rates import rate, tally
from softdot.studies.proof.score import score_verdict
from softdot.studies.proof.world.cases import KINDS, NONE, OUTSIDE, PAIR, SINGLE, plan
from softdot.studies.proof.world.effects import fits
from softdot.studies.proof.world.rigs import BENCHES
from tests.cases import for_each

LEAK = {"mechanism": "charge-leakage", "component": "readout"}
CABLE = {"mechanism": "parasitic-capacitance", "component": "readout"}
RELAX = {"mechanism": "viscoelasticity", "component": "medium2"}


def truth(*mechanisms, kind=SINGLE, size=6.0, values=None):
    return {
        "number": 1, "kind": kind, "bench": "ridge-clamped", "whitened_rms": size,
        "mechanisms": [{**one, "values": values or {}} for one in mechanisms],
        "per_run": {"a | voltage_V": 0.75, "b | voltage_V": 0.25},
    }  # fmt: skip


def verdict(*named, groups=(), unexplained=False, where=(), low=1.0, high=2.0):
    parameters = {"resistance_MOhm": {"value": 1.5, "low": low, "high": high, "unit": "MOhm"}}
    return {
        "mismatch": bool(named) or unexplained, "unexplained": unexplained,
        "missing_physics": [{**one, "parameters": parameters} for one in named],
        "ambiguous_with": list(groups), "where": list(where),
        "fit": {"held_out": {"nrmse_after": 0.033, "noise_floor_nrmse": 0.03, "log_score_gain_per_press": 12.0}},
        "next_experiment": {"expected_separation_sigma": 4.0},
    }  # fmt: skip


def near(_):
    return 0.5


def far(_):
    return 7.0


def test_the_right_name_is_exact():
    score = score_verdict(truth(LEAK), verdict(LEAK), far)
    assert (score.exact, score.grouped, score.component) == (True, True, True)
    assert score.held_out == pytest.approx(1.1)


def test_a_leak_across_the_film_is_one_across_the_input():
    assert score_verdict(truth(LEAK), verdict({**LEAK, "component": "film"}), far).exact


def test_another_name_is_wrong_unless_a_fair_group_says_so():
    groups = [[LEAK, CABLE]]
    assert not score_verdict(truth(LEAK), verdict(CABLE), near).grouped
    fair = score_verdict(truth(LEAK), verdict(CABLE, groups=groups), near)
    assert (fair.exact, fair.grouped, fair.group) == (False, True, 2)
    assert not score_verdict(
        truth(LEAK), verdict(CABLE, groups=groups), far
    ).grouped  # the generator can tell them apart
    assert not score_verdict(truth(LEAK), verdict(CABLE, groups=groups), lambda _: None).grouped


def test_a_group_of_four_is_no_answer():
    members = [LEAK, CABLE, RELAX, {**RELAX, "component": "medium1"}]
    assert not score_verdict(truth(LEAK), verdict(CABLE, groups=[members]), near).grouped


def test_the_right_physics_in_the_wrong_part_is_not_exact():
    score = score_verdict(truth(RELAX), verdict({**RELAX, "component": "medium1"}), far)
    assert (score.mechanism, score.component, score.exact) == (True, False, False)


def test_both_of_a_pair_are_needed():
    assert not score_verdict(truth(LEAK, RELAX), verdict(LEAK), far).exact
    assert score_verdict(truth(LEAK, RELAX), verdict(RELAX, LEAK), far).exact


def test_a_pair_in_a_group_is_written_with_a_plus():
    both = {"mechanism": "charge-leakage + viscoelasticity", "component": "readout + medium2"}
    assert score_verdict(truth(LEAK, RELAX), verdict(CABLE, groups=[[CABLE, both]]), near).grouped


def test_a_name_without_effect_is_false_and_abstention_is_not():
    assert score_verdict(truth(kind=NONE, size=0.0), verdict(LEAK), far).named
    assert not score_verdict(truth(kind=NONE, size=0.0), verdict(), far).named
    foreign = truth({"mechanism": "", "component": "film"}, kind="outside")
    assert not score_verdict(foreign, verdict(unexplained=True), far).named


def test_the_common_part_of_two_distributions_is_the_overlap():
    where = [
        {"run": "a", "channel": "voltage_V", "share_of_excess": 0.25},
        {"run": "c", "channel": "force_N", "share_of_excess": 0.25},
    ]
    assert score_verdict(truth(LEAK), verdict(LEAK, where=where), far).overlap == pytest.approx(0.5)


def test_an_interval_covers_or_not():
    known = {"resistance_MOhm": 1.9}
    assert score_verdict(truth(LEAK, values=known), verdict(LEAK), far).covered == {
        "charge-leakage.resistance_MOhm": True
    }
    assert not any(score_verdict(truth(LEAK, values=known), verdict(LEAK, high=1.8), far).covered.values())


def test_a_main_part_is_right_by_its_name_and_no_name_of_everything():
    main = {**verdict(unexplained=True), "main_part": [LEAK]}
    score = score_verdict(truth(LEAK), main, far)
    assert (score.named, score.main_part, score.right, score.exact) == ((), score.truth, True, False)
    assert not score_verdict(truth(CABLE), main, far).right
    assert score_verdict(truth(CABLE), {**main, "ambiguous_with": [[LEAK, CABLE]]}, near).right
    rates = tally([score, score_verdict(truth(kind=NONE, size=0.0), main, far)])
    assert [rates[name]["count"] for name in ("clear_right", "clear_exact", "clear_wrong")] == [1, 0, 0]
    assert (rates["main_parts_without_effect"]["count"], rates["names_right"]["count"]) == (1, 1)


def test_on_a_rig_with_flaws_effects_are_counted_by_what_the_flaws_make():
    flawed = {"flaws_rms": 2.0}
    scores = [
        score_verdict({**truth(LEAK, size=4.0), **flawed}, verdict(LEAK), far),
        score_verdict({**truth(LEAK, size=6.0), **flawed}, verdict(CABLE), far),
        score_verdict({**truth(LEAK, size=3.9), **flawed}, verdict(unexplained=True), far),
        score_verdict(truth(LEAK, size=6.0), verdict(LEAK), far),  # a rig without flaws
    ]
    rates = tally(scores)
    counts = {name: (rates[name]["count"], rates[name]["of"]) for name in rates if "flaws" in name}
    assert counts == {
        "above_flaws_right": (1, 2), "above_flaws_wrong": (1, 2),
        "below_flaws_right": (0, 1), "below_flaws_wrong": (0, 1),
    }  # fmt: skip


def test_a_tally_counts():
    scores = [
        score_verdict(truth(LEAK), verdict(LEAK), far),
        score_verdict(truth(LEAK), verdict(CABLE), far),
        score_verdict(truth(LEAK, size=1.0), verdict(unexplained=True), far),
        score_verdict(truth(kind=NONE, size=0.0), verdict(), far),
    ]
    rates = tally(scores)
    assert (rates["clear_exact"]["count"], rates["clear_exact"]["of"]) == (1, 2)
    assert rates["false_names_without_effect"]["of"] == 1
    assert [(one["detected"]["count"], one["wrong"]["count"]) for one in rates["by_size"]] == [(1, 0), (2, 1)]
    low, high = wilson_interval(1, 2)
    assert (rates["clear_exact"]["low"], rates["clear_exact"]["high"]) == (low, high)
    assert rate([], bool)["rate"] is None


@for_each(("kind", "sizes"), [(SINGLE, 7), (PAIR, 2), (OUTSIDE, 2)])
def test_every_effect_meets_every_rig_that_can_have_it_at_every_size(kind, sizes):
    rigs = ("ridge-clamped", "ridge-free", "dot-clamped")
    met = {(c.effects, c.bench, c.size) for c in plan(400, 3, rigs, kinds=(kind,))}
    for effects in {effects for effects, _, _ in met}:
        able = [rig for rig in rigs if all(fits(name, BENCHES[rig]) for name in effects)]
        assert len([one for one in met if one[0] == effects]) == sizes * len(able)


def test_a_plan_is_the_same_for_the_same_seed_and_longer_plans_begin_alike():
    rigs = ("ridge-clamped", "ridge-free")
    assert plan(100, 3, rigs)[:40] == plan(40, 3, rigs)
    assert plan(10, 3, rigs, kinds=(SINGLE,)) == [c for c in plan(60, 3, rigs) if c.kind == SINGLE][:10]
    cases = plan(1000, 3, rigs)
    assert {case.kind for case in cases} == set(KINDS)
    assert sum(case.kind == NONE for case in cases) >= 400
    singles = [case.effects for case in cases if case.kind == SINGLE]
    assert min(singles.count(one) for one in set(singles)) >= 30
    assert all(case.without for case in cases if case.kind == "left-out")
    assert {case.name for case in cases} == {f"case-{n:04d}" for n in range(1, 1001)}
