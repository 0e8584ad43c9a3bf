"""Fits recover known constants, correlations know order, and the section stands on any study."""

import numpy as np
import pytest

from softdot.studies.paper.beyond.claims import claims
from softdot.studies.paper.beyond.comparison import MESHERS, beats
from softdot.studies.paper.beyond.elastic_sides import STIFFNESS_N_PER_MM3
from softdot.studies.paper.beyond.ranking import (
    CORRECTED,
    FOUR,
    WITHOUT_FILM,
    correlations,
    fit,
    interval,
    scatter,
    spearman,
)
from softdot.studies.paper.beyond.section import section_of
from softdot.studies.paper.section import PaperTable
from tests.studies.paper import stand_in_beyond as stand_in


@pytest.fixture(scope="module")
def study():
    return stand_in.study()


def test_a_fit_recovers_the_constants_behind_the_voltages():
    trials = [trial for halves in stand_in.ranking().samples.values() for trial in halves.fitted]
    assert fit(trials, 1.0) == pytest.approx(stand_in.CONSTANTS, rel=1e-4)


def test_rank_correlation_knows_order_alone():
    values = np.array([0.1, 2.0, 3.0, 50.0])
    assert spearman(values, np.exp(values)) == pytest.approx(1.0)
    assert spearman(values, -(values**3)) == pytest.approx(-1.0)


def test_an_interval_of_perfect_order_is_perfect():
    values = np.arange(20.0)
    assert interval(values, values) == pytest.approx([1.0, 1.0])


def test_a_perfect_parameter_orders_held_out_designs_perfectly(study):
    for side in ("free", "clamped"):
        assert correlations(study.ranking, FOUR, side)[CORRECTED] == pytest.approx(1.0)
        assert scatter(study.ranking.samples[FOUR].held_out, side, study.ranking) == pytest.approx(1.0, rel=1e-3)


def test_without_the_film_the_level_is_wrong_where_the_film_rules(study):
    held_out = study.ranking.samples[FOUR].held_out
    assert scatter(held_out, "clamped", study.ranking, 0.0) > 1.05
    assert WITHOUT_FILM in correlations(study.ranking, FOUR, "clamped")


def test_halves_share_no_design(study):
    for halves in study.ranking.samples.values():
        assert not {each.design for each in halves.fitted} & {each.design for each in halves.held_out}


def test_half_way_lies_in_the_middle_of_an_even_rise():
    curve = stand_in.curve(10.0, 100.0)
    middle = STIFFNESS_N_PER_MM3[len(STIFFNESS_N_PER_MM3) // 2]
    assert curve.half_way_N_per_mm3() == pytest.approx(middle)
    assert curve.voltage_at_V(middle) == pytest.approx(55.0)


@pytest.mark.press
def test_the_section_shows_every_figure_and_no_empty_number(study, tmp_path):
    section = section_of(study, tmp_path)
    assert len(section.figures) == 5
    assert all(figure.path.is_file() for figure in section.figures)
    words = [*section.findings, *(block for block in section.blocks if isinstance(block, str))]
    assert not any("nan" in text.split() or "None" in text for text in words)
    for table in (block for block in section.blocks if isinstance(block, PaperTable)):
        assert all(len(row) == len(table.headers) for row in table.rows)


def test_claims_follow_the_numbers(study):
    found = {(claim.text, claim.reading): claim.holds for claim in claims(study)}
    assert found["The bending softness S₁b governs the clamped output", ""] is False
    for mesher in MESHERS:
        papers, best, *_ = study.compared[mesher]
        found_better = [holds for (text, reading), holds in found.items() if mesher in reading]
        assert found_better == [beats(best, papers)]
