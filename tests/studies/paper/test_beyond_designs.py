"""Designs that can be made, and their presses."""

from dataclasses import astuple

import numpy as np
import pytest

from softdot.outcome import outcome
from softdot.studies.paper.beyond.designs import (
    FILMS_UM,
    HIGH,
    LOW,
    PAPERS,
    coordinates,
    design_config,
    papers_variables,
    sample,
)
from softdot.studies.paper.beyond.elastic_sides import elastic
from softdot.studies.paper.segment import segment_config
from tests.cases import for_each

COARSE = {"element_size_mm": 0.6, "contact_element_size_mm": 0.3, "mesher": "layered"}


def test_samples_keep_the_limits_and_use_films_that_are_sold():
    for design in sample(6, 0):
        assert np.all(np.array(astuple(design)) >= 0.99 * np.array(astuple(LOW)))
        assert np.all(np.array(astuple(design)) <= 1.01 * np.array(astuple(HIGH)))
        assert design.film_um in FILMS_UM


def test_every_film_is_tried_equally_often():
    films = [design.film_um for design in sample(6, 0)]
    assert {um: films.count(um) for um in FILMS_UM} == dict.fromkeys(FILMS_UM, 16)


def test_the_paper_s_variables_alone_vary():
    others = {(design.effector_height_mm, design.effector_MPa, design.film_um) for design in papers_variables(4, 0)}
    assert others == {(1.0, 1.0, 28.0)}


def test_coordinates_span_the_unit_cube():
    assert coordinates([LOW, HIGH]) == pytest.approx(np.array([np.zeros(7), np.ones(7)]))


@for_each("reading", ["plane-strain", "solid"])
def test_the_paper_s_design_is_the_one_of_the_other_parts(reading):
    theirs = segment_config("free", 0.5, 1.0, reading, load_steps=3, mesh=COARSE)
    assert design_config(PAPERS, "free", reading, COARSE) == theirs


@pytest.mark.press
def test_springs_join_the_free_and_the_clamped_press():
    """Springs that are nearly nothing press like free sides, nearly rigid ones like clamped sides."""
    free, clamped = (design_config(PAPERS, side, "plane-strain", COARSE) for side in ("free", "clamped"))
    pairs = [(free, elastic(clamped, 1e-4)), (clamped, elastic(clamped, 1e7))]
    for end, spring in pairs:
        exact, near = outcome(end), outcome(spring)
        assert near["reaction_force_N"][-1] == pytest.approx(exact["reaction_force_N"][-1], rel=2e-3)
        assert near["open_circuit_voltage_V"][-1] == pytest.approx(exact["open_circuit_voltage_V"][-1], rel=5e-3)
