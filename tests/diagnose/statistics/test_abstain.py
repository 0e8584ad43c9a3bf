"""The decision: one reason against a model is enough to abstain."""

from dataclasses import replace

from diagnose.statistics.abstain import Evidence, decide
from diagnose.statistics.error_rates import Rates
from tests.cases import for_each

RATES = Rates(level=0.003, margin=0.5, largest_group=3)
CLEAR = Evidence(
    p_mismatch=0.001, p_left=0.4, p_strained=0.5, gain_lower=12.0, black_box_lower=-3.0, implausible=(), group=1
)


def test_a_clear_case_is_named():
    decision = decide(CLEAR, RATES)
    assert (decision.mismatch, decision.named, decision.unexplained) == (True, True, False)
    assert decision.reasons == ()


def test_noise_is_neither_named_nor_unexplained():
    decision = decide(replace(CLEAR, p_mismatch=0.2), RATES)
    assert (decision.mismatch, decision.named, decision.unexplained) == (False, False, False)


@for_each(
    ("change", "word"),
    [
        ({"p_left": 0.002}, "still larger"),
        ({"p_strained": 0.002}, "stated uncertainty"),
        ({"gain_lower": 0.0}, "no better"),
        ({"black_box_lower": 0.6}, "black box"),
        ({"implausible": ("thickness_factor",)}, "thickness_factor"),
        ({"group": 4}, "told apart"),
        ({"ordinary": True}, "every rig"),
    ],
)
def test_every_doubt_alone_makes_it_unexplained(change, word):
    decision = decide(replace(CLEAR, **change), RATES)
    assert (decision.mismatch, decision.named, decision.unexplained) == (True, False, True)
    assert len(decision.reasons) == 1
    assert word in decision.reasons[0]


def test_doubts_that_stay_within_the_rates_do_not_count():
    doubtful = replace(CLEAR, p_left=0.0031, gain_lower=1e-6, black_box_lower=0.5, group=3)
    assert decide(doubtful, RATES).named


def test_all_doubts_are_named():
    bad = Evidence(0.0, 0.0, 0.0, gain_lower=-1.0, black_box_lower=9.0, implausible=("gap_mm",), group=9)
    assert len(decide(bad, RATES).reasons) == 6
