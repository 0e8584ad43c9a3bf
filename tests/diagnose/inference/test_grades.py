"""Which evidence gives which grade, and what no evidence may give."""

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from diagnose.inference.grades import (
    RULES,
    THRESHOLDS,
    Agreement,
    Evidence,
    Identified,
    KindOnly,
    MainPart,
    Unexplained,
    judged,
)
from tests.cases import for_each

CLEAR = Evidence(
    p_mismatch=1e-4,
    best="charge-leakage (readout)",
    nothing=0.0,
    share=0.995,
    share_of_else=0.9,
    error=0.004,
    error_before=0.2,
    group=1,
    kind="the film or its input loses charge",
    confirmed=0.99,
)
PART = replace(CLEAR, share=0.93, error=0.05)

EVIDENCE = st.builds(
    Evidence,
    p_mismatch=st.floats(0.0, 1.0),
    best=st.sampled_from(["", "friction (dot)"]),
    nothing=st.floats(0.0, 1.0),
    something_else=st.floats(0.0, 1.0),
    share=st.floats(-1.0, 1.0),
    share_of_else=st.floats(-1.0, 1.0),
    error=st.floats(0.0, 1.0),
    error_before=st.floats(0.0, 1.0),
    group=st.integers(1, 6),
    kind=st.sampled_from(["", "a kind"]),
    confirmed=st.none() | st.floats(-1.0, 1.0),
    ordinary=st.booleans(),
    implausible=st.sampled_from([(), ("leak = 20",)]),
    several=st.booleans(),
    untold_memory=st.booleans(),
)


@for_each(
    ("evidence", "grade"),
    [
        (CLEAR, Identified),
        (replace(CLEAR, confirmed=None), Identified),  # one press: nothing could be held out
        (replace(CLEAR, p_mismatch=0.5), Agreement),
        (replace(CLEAR, best=""), Unexplained),
        (replace(CLEAR, nothing=0.2, error_before=0.009), Unexplained),
        (replace(CLEAR, nothing=0.2), Identified),  # what it takes away is visible, whatever is likelier in details
        (replace(CLEAR, ordinary=True), Unexplained),
        (replace(CLEAR, untold_memory=True), Unexplained),  # one loading has one history
        (replace(CLEAR, group=3), Identified),
        (replace(CLEAR, group=4), KindOnly),
        (replace(CLEAR, group=4, kind=""), Unexplained),
        (replace(CLEAR, implausible=("leak = 20",)), MainPart),
        (replace(CLEAR, implausible=("leak = 20",), several=True), KindOnly),
        (replace(CLEAR, error=0.2), MainPart),
        (replace(CLEAR, confirmed=0.5), Unexplained),
        (PART, MainPart),
        (replace(PART, error=0.008), Identified),  # no more than the flaws of an ordinary rig
        (replace(PART, share=0.85), Unexplained),
        (replace(CLEAR, share=0.96, error=0.03, something_else=0.99, share_of_else=0.999), MainPart),
        (replace(CLEAR, share=0.96, error=0.03, something_else=0.99, share_of_else=0.999, several=True), KindOnly),
        (replace(CLEAR, something_else=0.99, share_of_else=0.999), Identified),  # what is left is no more than flaws
    ],
)
def test_the_grade_of_clear_cases(evidence, grade):
    assert isinstance(judged(evidence), grade)


@settings(max_examples=300, deadline=None)
@given(EVIDENCE)
def test_every_evidence_has_one_verdict_with_a_reason(evidence):
    verdict = judged(evidence)
    assert verdict.reasons
    assert all(sentence.endswith(".") for sentence in verdict.reasons)
    assert sum(rule(evidence) is not None for rule in RULES) >= 1


@settings(max_examples=300, deadline=None)
@given(EVIDENCE)
def test_a_name_leaves_little_and_is_one_of_few(evidence):
    verdict = judged(evidence)
    if isinstance(verdict, Identified | MainPart):
        assert evidence.p_mismatch <= THRESHOLDS.level
        assert evidence.share >= THRESHOLDS.confirmed
        assert evidence.group <= THRESHOLDS.largest_group
        assert evidence.nothing <= THRESHOLDS.nothing or evidence.error_before > THRESHOLDS.visible
        assert not evidence.ordinary
        assert not evidence.untold_memory
    if isinstance(verdict, Identified):
        assert evidence.error <= THRESHOLDS.visible or evidence.share >= THRESHOLDS.nearly_all
        assert evidence.error <= THRESHOLDS.left


@settings(max_examples=200, deadline=None)
@given(EVIDENCE, st.floats(0.0, 1.0))
def test_more_of_the_excess_never_loses_a_name(evidence, more):
    better = replace(evidence, share=max(evidence.share, more))
    if isinstance(judged(evidence), Identified):
        assert isinstance(judged(better), Identified)
