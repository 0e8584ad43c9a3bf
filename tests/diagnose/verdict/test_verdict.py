"""verdict.json keeps its contract, whatever was found."""

import json

import numpy as np
import pytest

from diagnose.findings import Remainder
from diagnose.forward import Setting
from diagnose.next_press.choose import next_presses
from diagnose.verdict.content import verdict
from diagnose.verdict.resimulation import resimulate
from softdot.json_files import json_text
from tests.diagnose.verdict.toy import LEAK, RELAXING, ToyEngine, fitted, found, toy_recording

NUMBER, MAYBE = (int, float), (int, float, type(None))
FIT = {"nrmse_before": NUMBER, "nrmse_after": NUMBER, "log_score_gain_per_press": NUMBER, "noise_floor_nrmse": NUMBER}
NAMED = {"mechanism": str, "component": str}
SHAPE = {
    "format": str,
    "grade": str,
    "main_part": [{**NAMED, "parameters": dict, "probability": NUMBER}],
    "mismatch": bool,
    "detection": {"statistic": NUMBER, "p_value_family_wise": NUMBER, "noise_model": dict},
    "where": [
        {"run": str, "channel": str, "phase": str, "band_hz": [NUMBER], "share_of_excess": NUMBER, "component": str}
    ],
    "missing_physics": [{**NAMED, "parameters": dict, "probability": NUMBER}],
    "alternatives": [{**NAMED, "probability": NUMBER}],
    "ambiguous_with": [[NAMED]],
    "unexplained": bool,
    "fit": {"train": dict, "held_out": FIT, "engine": str, "engine_error_percent": dict},
    "next_experiment": {"text": str, "changes": dict, "separates": list, "expected_separation_sigma": MAYBE},
}
QUIET = {**SHAPE, "fit": {"train": type(None), "held_out": type(None), "engine": str}}
LEAKS, RELAXES = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.09)


def require(value, shape, where="verdict"):
    """Every key is there and of its type; a list is checked item by item."""
    if isinstance(shape, dict):
        assert isinstance(value, dict), where
        assert shape.keys() <= value.keys(), where
        for key, inner in shape.items():
            require(value[key], inner, f"{where}.{key}")
    elif isinstance(shape, list):
        assert isinstance(value, list), where
        for number, item in enumerate(value):
            require(item, shape[0], f"{where}[{number}]")
    else:
        assert isinstance(value, shape), where


@pytest.fixture(scope="module")
def recording():
    return toy_recording([Setting(LEAK, (0.5,))])


def content(recording, findings, resimulated=(), warnings=()):
    """As a file has it."""
    following = next_presses(recording, ToyEngine(recording), findings)
    text = json_text(verdict(findings, ["A sentence."], following, resimulated, warnings))
    return json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))


def test_a_named_mechanism(recording):
    found_it = content(recording, found(recording, (LEAKS, RELAXES), LEAKS, ((0,), (1,))))
    require(found_it, SHAPE)
    (missing,) = found_it["missing_physics"]
    assert (missing["mechanism"], missing["component"]) == ("charge-leakage", "readout")
    resistance = missing["parameters"]["resistance_MOhm"]
    assert (resistance["value"], resistance["unit"]) == (pytest.approx(2000.0), "MOhm")
    assert resistance["low"] < resistance["value"] < resistance["high"]
    assert [each["mechanism"] for each in found_it["alternatives"]] == ["viscoelasticity"]
    assert found_it["ambiguous_with"] == []
    assert found_it["where"][0]["phase"] == "hold"


def test_a_group_that_cannot_be_told_apart(recording):
    said = content(recording, found(recording, (LEAKS, RELAXES), LEAKS, ((0, 1),)))
    require(said, SHAPE)
    assert said["ambiguous_with"] == [
        [
            {"mechanism": "charge-leakage", "component": "readout"},
            {"mechanism": "viscoelasticity", "component": "medium2"},
        ]
    ]
    assert said["next_experiment"]["separates"] == said["ambiguous_with"][0]
    assert said["next_experiment"]["expected_separation_sigma"] > 0.0


def test_a_pair_of_mechanisms_is_two_entries_with_one_probability(recording):
    pair = type(LEAKS)(
        (*LEAKS.settings, *RELAXES.settings), (*LEAKS.parameters, *RELAXES.parameters), 9.0, 5.0, 0.9, 0.5
    )
    said = content(recording, found(recording, (pair, LEAKS), pair, ((0,), (1,))))
    require(said, SHAPE)
    assert [one["mechanism"] for one in said["missing_physics"]] == ["charge-leakage", "viscoelasticity"]
    assert [one["probability"] for one in said["missing_physics"]] == [0.9, 0.9]


def test_no_mismatch_names_nothing_and_places_nothing(recording):
    said = content(recording, found(recording, mismatch=False))
    require(said, QUIET)
    assert (said["mismatch"], said["unexplained"]) == (False, False)
    assert said["missing_physics"] == said["where"] == said["alternatives"] == []
    assert said["next_experiment"]["expected_separation_sigma"] is None


def test_a_main_part_names_nothing_for_those_who_only_know_what_is_missing(recording):
    left = Remainder(0.97, {"loading": 0.7, "hold": 0.3})
    said = content(recording, found(recording, (LEAKS,), LEAKS, ((0,),), unexplained=True, remainder=left))
    require(said, SHAPE)
    assert (said["grade"], said["unexplained"], said["missing_physics"]) == ("main part", True, [])
    assert [one["mechanism"] for one in said["main_part"]] == ["charge-leakage"]
    assert said["remainder"] == {"share_explained_held_out": 0.97, "share_left_by_phase": {"loading": 0.7, "hold": 0.3}}


def test_every_grade_has_its_word(recording):
    of = {"identified": {}, "unexplained": {"best": None, "unexplained": True}, "agreement": {"mismatch": False}}
    for word, parts in of.items():
        assert content(recording, found(recording, **{"models": (LEAKS,), "best": LEAKS, **parts}))["grade"] == word
    kind = found(recording, (LEAKS, RELAXES), None, ((0, 1),), unexplained=True, kind="something leaks")
    assert (content(recording, kind)["grade"], content(recording, kind)["kind"]) == ("kind only", "something leaks")


def test_the_unexplained_names_nothing_but_keeps_what_was_tried(recording):
    reasons = ("Its residual is still larger than noise makes it (p = 0.0001).",)
    said = content(recording, found(recording, (LEAKS, RELAXES), None, ((0,), (1,)), unexplained=True, reasons=reasons))
    require(said, SHAPE)
    assert said["unexplained"]
    assert said["missing_physics"] == []
    assert [one["mechanism"] for one in said["alternatives"]] == ["charge-leakage", "viscoelasticity"]
    assert said["reasons"] == list(reasons)


def test_what_is_infinite_or_unknown_is_null(recording):
    findings = found(recording, (LEAKS,), LEAKS, ((0,),), black_box_gain=np.nan, nuisances={"scale": (1.0, np.inf)})
    said = content(recording, findings)
    assert said["black_box_gain_over_best_per_press"] is None
    assert said["nuisances"]["scale"] == {"value": 1.0, "one_sigma": None}


def test_a_probability_is_never_shared_out_twice(recording):
    said = content(recording, found(recording, (LEAKS, RELAXES), LEAKS, ((0,), (1,))))
    total = said["missing_physics"][0]["probability"] + sum(one["probability"] for one in said["alternatives"])
    assert total <= 1.0


def test_presses_by_the_full_model_are_told_with_their_roles(recording):
    findings = found(recording, (LEAKS,), LEAKS, ((0,),))
    pressed = list(resimulate(recording, ToyEngine(recording), findings, lambda *_: None, 60.0))
    said = content(recording, findings, pressed)["fit"]["resimulated"]
    assert {one["run"] for one in said} == {"slow", "quick"}
    assert all(one["role"] == "training and held-out" for one in said)
    for one in said:
        assert one["nrmse_after"]["voltage_V"] < 0.1 < one["nrmse_before"]["voltage_V"]
