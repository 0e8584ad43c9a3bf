"""Presses of the study by name, and the two readings as configurations."""

import pytest

from foundation.errors import InputError
from foundation.executor import HERE
from softdot.progress import Logged
from softdot.studies.paper.presses import NotSolvedError, solve_named
from softdot.studies.paper.segment import segment_config
from softdot.studies.paper.segments.presses import press_of

SOLVED = {"status": "solved", "reason": None}


def solver(monkeypatch, *records):
    """Records in place of a cluster."""
    monkeypatch.setattr("softdot.sweeps.points.solve_points", lambda *_, **__: list(records))


def test_outcomes_come_back_by_name(monkeypatch):
    solver(monkeypatch, {**SOLVED, "reaction_force_N": [0, 1]}, {**SOLVED, "reaction_force_N": [0, 2]})
    config = segment_config("free", 0.8, 5.0)
    found = solve_named({("solid", "F1"): config, ("solid", "F2"): config}, Logged(), HERE)
    assert found["solid", "F2"]["reaction_force_N"] == [0, 2]


def test_a_press_without_result_is_named_in_one_sentence(monkeypatch):
    solver(monkeypatch, SOLVED, {"status": "not-converged", "reason": "contact at 0.2 mm"})
    config = segment_config("free", 0.8, 5.0)
    with pytest.raises(NotSolvedError, match=r"^solid, F2: not-converged, contact at 0\.2 mm$"):
        solve_named({("solid", "F1"): config, ("solid", "F2"): config}, Logged(), HERE)


def test_the_readings_differ_in_section_width_and_dot_alone():
    slab, solid = (segment_config("clamped", 0.5, 1.0, reading) for reading in ("plane-strain", "solid"))
    assert (slab.segment.width_mm, slab.dot.shape, slab.dot.radius_mm) == (16.0, "ridge", 1.15)
    assert (solid.segment.width_mm, solid.dot.shape, solid.dot.standard) == (2.5, "cap", "marburg-medium")
    same = {"section": "solid", "width_mm": 2.5}
    assert slab.segment.model_copy(update=same) == solid.segment
    assert slab.layer_materials() == solid.layer_materials()


def test_the_segment_is_that_of_table_2():
    materials = segment_config("free", 0.8, 0.05).layer_materials()
    assert {name: material.youngs_modulus_MPa for name, material in materials.items()} == {
        "medium2": 0.05, "film": 2000.0, "medium1": 5.0, "effector": 1.0,
    }  # fmt: skip


def test_a_segment_that_cannot_be_is_refused():
    with pytest.raises(InputError, match="thickness_mm"):
        segment_config("free", -1.0, 5.0)


def test_what_the_study_takes_from_an_outcome():
    press = press_of(
        {
            "indentation_mm": [0, 0.15, 0.3],
            "reaction_force_N": [0, 1, 3],
            "open_circuit_voltage_V": [0, 33.7, 134.8],
            "film": {"max_principal_strain": 0.01, "max_principal_stress_MPa": 20.0},
            "mesh": {"unknowns": 10},
        }
    )
    assert press.force_N == 3
    assert press.calibrated_mV == pytest.approx(400)  # over 337
    assert press.calibrated_V_per_mm == pytest.approx(0.4 / 0.3)
    assert press.exponent == pytest.approx(2.0)
