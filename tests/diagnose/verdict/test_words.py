"""The first lines that a bench engineer reads."""

import re
from dataclasses import replace

import numpy as np
import pytest

from diagnose.figures import figure
from diagnose.findings import Fit, Interval, LocatedExcess, Remainder
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.next_press.choose import next_presses
from diagnose.verdict.content import verdict
from diagnose.verdict.names import (
    COMPONENT_WORDS,
    common_words,
    component_words,
    interval_words,
    join_words,
    mechanism_words,
    setting_words,
)
from diagnose.verdict.where_it_fails import where_words
from diagnose.verdict.words import sentences
from diagnose.vocabulary.base import vocabulary
from diagnose.vocabulary.layers.property_error import property_error
from solve.mechanisms import MECHANISMS
from tests.cases import for_each
from tests.diagnose.verdict.toy import LEAK, RELAXING, ToyEngine, fitted, found, toy_recording

LEAKS, RELAXES = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.09)


@pytest.fixture(scope="module")
def recording():
    return toy_recording([Setting(LEAK, (0.5,))])


def told(recording, findings, following=()):
    return [str(sentence) for sentence in sentences(recording, findings, following, ())]


def place(run="slow", phase="hold", band=(0.0, 2.0), share=0.9, channel="voltage_V"):
    return LocatedExcess(run, channel, phase, 0, band, 12.0, 1e-4, share, "")


def test_from_what_is_off_to_what_to_do(recording):
    findings = found(recording, (LEAKS, RELAXES), LEAKS, ((0, 1),))
    lines = told(recording, findings, next_presses(recording, ToyEngine(recording), findings))
    assert lines[0] == "Your simulation of the voltage is too high in the hold, below 2 Hz, in “slow”."
    assert lines[1] == "Left out: charge leaks through the amplifier; resistance 2000 MΩ (90 % interval 1600 to 2400)."
    assert lines[2] == (
        "With it: on presses that took no part in the fit, the error falls from 84 % to 3 % of the recorded signal "
        "(the estimated noise makes 2.6 %)."
    )
    assert lines[3] == (
        "Not excluded: medium 2 relaxes (viscoelasticity). These recordings cannot tell the explanations apart."
    )
    assert re.fullmatch(
        r"Next: Press as in “.*\. The explanations are expected to differ by [\d.]+ standard deviations in it\.",
        lines[4],
    )


def test_agreement_is_good_news(recording):
    lines = told(recording, found(recording, mismatch=False))
    assert lines[0] == "Your simulation and the recordings agree: the difference is no larger than noise makes it."
    assert "nothing stands out in 2 presses of 2 runs (p = 0.4, taking all cells together" in lines[1]


def test_rivals_that_no_press_parts_are_to_be_measured_by_themselves(recording):
    lines = told(recording, found(recording, (LEAKS, RELAXES), LEAKS, ((0, 1),)))
    assert lines[-1].startswith("Next: None of the presses that were tried tells them apart")
    assert not any(line.startswith("Next") for line in told(recording, found(recording, (LEAKS,), LEAKS, ((0,),))))


def test_the_unexplained_is_said_with_its_reasons(recording):
    reason = "Its residual is still larger than noise makes it (p = 0.0001)."
    findings = found(recording, (LEAKS,), None, ((0,),), unexplained=True, reasons=(reason,))
    lines = told(recording, findings)
    assert lines[1] == "Left out: something that none of the known mechanisms explains, so nothing is named."
    assert lines[2] == f"Why nothing is named: {reason}"


def test_what_flaws_of_a_rig_make_is_said_to_be_small(recording):
    """1.7 % where noise makes 1.6 % are 0.57 % above it, 1.9 % are 1.02 %."""
    faint, more = (Fit(("fast, press 1",), error, error, 0.016, 0.0) for error in (0.017, 0.019))
    quiet = {"models": (), "unexplained": True}
    lines = told(recording, found(recording, **quiet, train=faint, held_out=faint))
    assert lines[1].startswith("Left out: nothing large. What is off is 0.57 % of the recorded signal above the noise;")
    lines = told(recording, found(recording, **quiet, train=faint, held_out=more))
    assert lines[1] == "Left out: something that none of the known mechanisms explains, so nothing is named."


def test_the_main_part_is_told_with_what_has_no_name(recording):
    reason = "Its residual is still larger than noise makes it (p = 0.002)."
    left = Remainder(0.974, {"loading": 0.8, "hold": 0.2})
    findings = found(recording, (LEAKS,), LEAKS, ((0,),), unexplained=True, remainder=left, reasons=(reason,))
    lines = told(recording, findings)
    assert lines[1] == (
        "Most of what is left out: charge leaks through the amplifier; resistance 2000 MΩ (90 % interval 1600 to "
        "2400). It accounts for 97 % of the excess over noise in conditions that it was not fitted to."
    )
    assert lines[3] == f"The rest: what remains, mostly while loading, has no name. {reason}"
    even = replace(findings, remainder=replace(left, by_phase={"loading": 0.4, "hold": 0.3, "after": 0.3}))
    assert told(recording, even)[3].startswith("The rest: what remains has no name.")


def test_where_too_many_are_as_good_their_kind_is_told(recording):
    kind = found(recording, (LEAKS, RELAXES), None, ((0, 1),), unexplained=True, kind="something leaks")
    assert told(recording, kind)[1] == (
        "Left out: only its kind can be told: something leaks. Each of these explains most: charge leaks through the "
        "amplifier or medium 2 relaxes (viscoelasticity)."
    )


def test_where_too_many_of_no_one_kind_are_as_good_it_is_not_said_that_none_is(recording):
    several = found(recording, (LEAKS, RELAXES), None, ((0, 1),), unexplained=True, ambiguous=True)
    assert told(recording, several)[1] == (
        "Left out: one of several things that these recordings cannot tell apart, so nothing is named: charge leaks "
        "through the amplifier or medium 2 relaxes (viscoelasticity)."
    )


def test_what_every_rig_has_a_little_of_is_to_be_stated(recording):
    gap = replace(LEAKS, settings=(Setting(replace(LEAK, everyday={"gap_mm": 0.002}, stated_as="offset_mm"), (0.1,)),))
    lines = told(recording, found(recording, (gap,), None, ((0,),), unexplained=True))
    advice = "in [runs.nuisance], offset_mm = 0.002 for a careful set-up, and diagnose again"
    assert advice in next(line for line in lines if line.startswith("To be stated: every rig has a little of"))
    said = replace(recording, runs=tuple(replace(run, nuisance={"offset_mm": 0.002}) for run in recording.runs))
    for silent in (
        told(said, found(recording, (gap,), None, ((0,),), unexplained=True)),
        told(recording, found(recording, (replace(gap, gain_lower=-1.0),), None, ((0,),), unexplained=True)),
        told(recording, found(recording, (LEAKS,), None, ((0,),), unexplained=True)),
    ):
        assert not any(line.startswith("To be stated") for line in silent)


def test_of_one_explanation_that_leaves_too_much_the_kind_is_told_with_its_error(recording):
    left = Fit(("run, press 1",), 0.97, 0.29, 0.22, 5.0)
    kind = found(recording, (LEAKS,), None, ((0,),), unexplained=True, kind="something leaks", unnamed=left)
    assert told(recording, kind)[1:3] == [
        "Left out: only its kind can be told: something leaks. Of all that is known only this explains most, and it "
        "leaves too much for a name: charge leaks through the amplifier.",
        "The closest explanation: with charge-leakage (readout), the error on held-out presses would fall from 97 % to "
        "29 % of the recorded signal (the estimated noise makes 22 %).",
    ]


def test_a_unit_is_told_once():
    told = interval_words("normal_stiffness_N_per_mm3", Interval(65.0, 8.4, 66.0, "N/mm3"))
    assert told == "normal stiffness 65 N/mm³ (90 % interval 8.4 to 66)"


def off(mechanism, component):
    return Setting(Candidate(mechanism, component, (), dict), ())


def test_what_explanations_have_in_common():
    leaks = [(off("charge-leakage", where),) for where in ("readout", "film")]
    assert common_words(leaks) == "the film or its input loses charge"
    mixed = [(off(name, "medium2"),) for name in ("viscoelasticity", "property-error")]
    assert common_words(mixed) == "medium 2 behaves otherwise than stated"
    assert common_words([*leaks, *mixed]) == common_words(mixed[1:]) == ""


@for_each(("modulus", "thickness", "gives_way"), [(-0.3, 0.0, True), (0.1, 0.2, True), (0.3, 0.0, False)])
def test_a_softer_or_thicker_medium_gives_way_as_a_bond_does(modulus, thickness, gives_way):
    medium = Setting(property_error("medium2", ("modulus", "thickness")), (modulus, thickness))
    told = common_words([(off("adhesive-compliance", "bond-base"),), (medium,)])
    assert told == ("something in series with the film gives way" if gives_way else "")
    foam = off("foam-densification", "medium1")
    assert common_words([(foam,), (medium,)]) == "a layer is stiffer or softer than its stated law"


def test_explanations_by_two_have_the_one_in_common_that_is_in_all_of_them():
    slow = off("low-pass", "readout")
    soft = [off("adhesive-compliance", bond) for bond in ("bond-base", "bond-film-medium2")]
    stiff = off("property-error", "medium1")
    told = common_words([(slow, one) for one in soft])
    assert told == "the amplifier filters out fast changes and something in series with the film gives way"
    assert common_words([(slow, soft[0]), (stiff, slow)]) == "the amplifier filters out fast changes and something else"


def test_how_far_the_best_unnamed_model_would_come_is_said_and_written(recording):
    tried = Fit(("slow, press 2",), 0.99, 0.51, 0.2, 40.0)
    findings = found(recording, (LEAKS,), None, ((0,),), unexplained=True, reasons=("Why.",), unnamed=tried)
    expected = (
        "The closest explanation: with charge-leakage (readout), the error on held-out presses would fall from 99 % "
        "to 51 %"
    )
    assert told(recording, findings)[3].startswith(expected)
    worse = replace(findings, unnamed=replace(tried, nrmse_after=1.4))
    assert not any(line.startswith("The closest") for line in told(recording, worse))
    written = verdict(findings, (), (), (), ())["fit"]
    assert written["held_out_best_unnamed"]["nrmse_after"] == 0.51
    assert verdict(found(recording, (LEAKS,), LEAKS, ((0,),)), (), (), (), ())["fit"]["held_out_best_unnamed"] is None


@for_each(
    ("places", "expected"),
    [
        ([place(), place("quick")], "too high in the hold, below 2 Hz, in all runs."),
        ([place(band=(10.0, 50.0))], "above 10 Hz, in “slow”."),
        ([place(band=(5.0, 12.5))], "between 5 and 12 Hz, in “slow”."),
        ([place(band=(0.0, 50.0))], "too high in the hold, in “slow”."),
        ([place(), place(phase="loading", share=0.05)], "too high in the hold, below 2 Hz, in “slow”."),
        (
            [place(share=0.5), place(phase="after", share=0.4)],
            "in the hold and after the press, below 2 Hz, in “slow”.",
        ),
    ],
)
def test_where(recording, places, expected):
    findings = replace(found(recording, (LEAKS,), LEAKS, ((0,),)), places=tuple(places))
    assert where_words(recording, findings).endswith(expected)


@for_each(("factor", "side"), [(1.5, "too high"), (0.5, "too low"), (-1.5, "too high")])
def test_high_and_low_are_meant_along_the_signal(recording, factor, side):
    """A negative voltage that is simulated too negative is too high as well."""
    sign = np.sign(factor)
    runs = tuple(
        replace(r, channels={**r.channels, "voltage_V": sign * r.channels["voltage_V"]}) for r in recording.runs
    )
    turned = replace(recording, runs=runs)
    baseline = {r.label: {"voltage_V": abs(factor) * r.channels["voltage_V"]} for r in runs}
    findings = replace(found(recording, (LEAKS,), LEAKS, ((0,),)), baseline=baseline)
    assert f"is {side} in the hold" in where_words(turned, findings)


def test_every_mechanism_and_component_has_words():
    assert vocabulary().keys() == MECHANISMS.keys()
    components = {part for kind in MECHANISMS.values() for part in kind.components if not part.startswith("channel")}
    assert components <= COMPONENT_WORDS.keys()
    assert mechanism_words("crosstalk", "channel-2") == "other channels couple into channel 2"


def test_crosstalk_between_two_channels_names_both():
    said = mechanism_words("crosstalk", "channel-2-channel-3")
    assert said.startswith("channel 2 and channel 3 couple into each other")
    assert component_words("channel-2-channel-3") == "channel 2 and channel 3"
    assert mechanism_words("charge-leakage", "channel-12") == "charge leaks through channel 12"


@for_each(("ratio", "said"), [(2.0, "stiffens at large strain"), (0.5, "gives way, at large strain")])
def test_a_law_below_the_stated_one_is_not_called_stiffening(ratio, said):
    law = Candidate(
        "hyperelastic-stiffening",
        "specimen",
        (Coordinate("c20_MPa", -1.0, 2.0, (0.5,)),),
        lambda _: {},
        derived=lambda values: {"force_ratio": 1.0 + values[0]},
    )
    assert said in setting_words(Setting(law, (ratio - 1.0,)))


@for_each(
    ("value", "text"),
    [
        (0.026, "0.026"),
        (84.3, "84"),
        (1234.0, "1200"),
        (-0.5, "−0.5"),
        (3e-7, "3 × 10⁻⁷"),
        (2.5e6, "2.5 × 10⁶"),
        (0.0, "0"),
        (np.inf, "∞"),
    ],
)
def test_figures(value, text):
    assert figure(value) == text


def test_intervals_and_lists():
    assert interval_words("resistance_MOhm", Interval(0.9, 0.7, 1.2, "MOhm")) == (
        "resistance 0.9 MΩ (90 % interval 0.7 to 1.2)"
    )
    narrow = Interval(1993.3, 1963.5, 2023.4, "MOhm")
    assert interval_words("resistance_MOhm", narrow) == ("resistance 1990 MΩ (90 % interval 1960 to 2020)")
    assert interval_words("relaxed_fraction", Interval(0.3, 0.2, 0.4, "1")) == (
        "relaxed fraction 0.3 (90 % interval 0.2 to 0.4)"
    )
    assert interval_words("order", Interval(2.0, 2.0, 2.0, "", fixed=True)) == "order 2"
    assert interval_words("mu_MPa[1]", Interval(3.0, 3.0, 3.0, "MPa", fixed=True)) == "mu (term 2) 3 MPa"
    assert join_words(["a", "b", "c"], "or") == "a, b or c"
    assert join_words(["a"]) == "a"


def test_of_a_law_with_many_constants_only_what_they_come_to(recording):
    law = Candidate(
        "hyperelastic-stiffening",
        "medium1",
        (Coordinate("far", 0.0, 9.0, (1.0,)),),
        lambda values: {"c10_MPa": 1.0, "c20_MPa": values[0]},
        lambda values: {"force_ratio": 1.0 + values[0]},
    )
    model = fitted(law, 1.5)
    lines = told(recording, found(recording, (model,), model, ((0,),)))
    assert lines[1] == "Left out: medium 1 stiffens at large strain; force ratio 2.5 (90 % interval 2 to 3)."


def test_what_is_the_same_element_of_the_model_is_told_with_it():
    twin = replace(LEAK, identical_to=(("charge-leakage", "film"),))
    words = setting_words(Setting(twin, (1.0,)))
    assert words == (
        f"{mechanism_words('charge-leakage', 'readout')} or, which is the same here, "
        f"{mechanism_words('charge-leakage', 'film')}"
    )


def test_a_sign_that_symmetry_leaves_open_is_told_as_either_side(recording):
    aside = fitted(replace(LEAK, either_sign=("resistance_MOhm",)), 0.5)
    words = " ".join(told(recording, found(recording, (aside,), aside, ((0,),))))
    assert ") to either side" in words
