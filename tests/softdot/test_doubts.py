"""A press that converged beyond what a medium can bear says so wherever its numbers are shown."""

import warnings

import pytest

from softdot import Case, ResultWarning
from softdot.outcome import solve_outcome

TABLES = {
    "segment": {
        "section": "plane-strain", "length_mm": 3.0, "width_mm": 3.0, "boundary": "free",
        "medium1": {"thickness_mm": 1.0, "material": "foam"}, "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 1.0, "material": "foam"},
    },
    "materials": {"foam": {"model": "hyperfoam", "mu_MPa": [0.05], "alpha": [2.0], "poisson_ratio": [0.1]}},
    "dot": {"shape": "ridge", "radius_mm": 1.0},
    "mesh": {"mesher": "layered", "element_size_mm": 2.0, "film_element_size_mm": 2.0, "contact_element_size_mm": 0.6},
}  # fmt: skip


def deep(indentation_mm):
    return Case(**TABLES, press={"indentation_mm": indentation_mm, "load_steps": 4})


def test_two_millimetres_of_foam_pressed_to_their_solid_are_told_in_python():
    case, said = deep(1.92), "of medium1 is crushed to "
    with pytest.warns(ResultWarning) as told:
        pressed = case.press()
    assert pressed.converged
    assert any(said in str(warning.message) for warning in told)
    assert any(said in sentence for sentence in pressed.warnings)


def test_an_element_inside_out_stands_beside_the_numbers_of_a_summary():
    assert any(
        "of medium1 is turned inside out" in sentence for sentence in solve_outcome(deep(1.96).config)["warnings"]
    )


def test_half_the_depth_is_no_doubt():
    with warnings.catch_warnings():
        warnings.simplefilter("error", ResultWarning)
        assert deep(1.0).press().doubts == []
