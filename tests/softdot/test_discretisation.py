"""The stated error of a mesh against presses on much finer meshes, and sizes that are chosen for an accuracy."""

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.case import Case
from softdot.config.loading import config_from
from softdot.summary import press_part
from softdot.tolerances.discretisation import (
    CONVERGENCE_ORDER,
    LEAST_PERCENT,
    Answers,
    answers_from_summary,
    discretisation_error,
)
from tests.softdot.test_uncertainty import RELAXING

SEGMENT = {
    "section": "plane-strain", "effector": {"height_mm": 0.5, "material": "rubber"},
    "medium1": {"thickness_mm": 0.5, "material": "dragon-skin-30"}, "film": {"thickness_um": 52.0},
    "medium2": {"thickness_mm": 1.0, "material": "vnr-soft"},
}  # fmt: skip
SLICE = {
    "segment": SEGMENT,
    "dot": {"shape": "ridge", "radius_mm": 1.0},
    "press": {"indentation_mm": 0.15, "load_steps": 2},
    "mesh": {"mesher": "layered"},
}


def answers(**of_size):
    """Force and voltages as functions of the element size, at sizes 1, 2 and 3."""
    each = [[np.array([of(size)]) for of in of_size.values()] for size in (1.0, 2.0, 3.0)]
    fine, double, triple = (Answers(force, voltage, voltage[:, None]) for force, voltage in each)
    return fine, {2.0: double, 3.0: triple}


def test_an_error_that_falls_with_the_size_is_found_by_both_larger_meshes():
    """Force = F (1 + c h^p): each mesh finds c h^p."""
    error = discretisation_error(
        *answers(force=lambda h: 2.0 + 0.02 * h**CONVERGENCE_ORDER, voltage=lambda h: 5.0 + 0.0 * h)
    )
    assert error.force_percent == pytest.approx(np.hypot(2**0.5 * 100 * 0.02 / 2.02, LEAST_PERCENT))
    assert error.voltage_percent == LEAST_PERCENT


def test_a_difference_that_vanishes_by_chance_is_made_up_for_by_the_other_one():
    """Answers of meshes of sizes 1 and 2 agree, that of size 3 is 4 % off."""
    error = discretisation_error(
        *answers(force=lambda h: 1.0 + 0.02 * (h - 1) * (h - 2), voltage=lambda h: 1.0 + 0.0 * h)
    )
    assert error.force_percent == pytest.approx(np.hypot(4.0 / (3.0**CONVERGENCE_ORDER - 1.0), LEAST_PERCENT))


def test_errors_along_a_path_are_relative_to_the_largest_value():
    """A press that ends unloaded has an error too."""
    force = np.array([1.0, 2.0, 0.0])
    fine, larger = (Answers(scale * force, force, force[:, None]) for scale in (1.0, 1.1))
    found = discretisation_error(fine, {2.0: larger}).force_percent
    assert found == pytest.approx(np.hypot(10.0 / (2.0**CONVERGENCE_ORDER - 1.0), LEAST_PERCENT))


def pressed(tables, factor=1.0):
    config = config_from({**tables, "mesh": {**tables["mesh"], "element_size_mm": 0.3 * factor,
                                             "contact_element_size_mm": 0.1 * factor}})  # fmt: skip
    case = Case(config)
    summary = press_part(case.model, case.press().result, case.press().course)
    return summary, case.uncertainty(summary)


CHANGES = (
    {},
    {"segment": {**SEGMENT, "boundary": "free"}},
    {"mechanisms": [RELAXING], "press": {"indentation_mm": 0.15, "load_steps": 3}},
)


@pytest.mark.evidence
def test_the_stated_error_covers_the_true_one_and_is_of_its_size():
    """The true one is that against elements a quarter as large; a bar is a rate and not a bound."""
    ratios = []
    for change in CHANGES:
        tables = {**SLICE, **change}
        summary, found = pressed(tables)
        fine, exact = answers_from_summary(summary), answers_from_summary(pressed(tables, 0.25)[0])
        for name, ours, reference in zip(("force_percent", "voltage_percent"), fine[:2], exact[:2], strict=True):
            true = 100.0 * np.abs(ours - reference).max() / np.abs(reference).max()
            ratios.append(found["discretisation_error"][name] / true)
    assert np.mean(np.array(ratios) >= 1.0) >= 0.8
    assert min(ratios) > 0.7
    assert np.median(ratios) < 3.0


@pytest.mark.press
def test_each_electrode_has_an_error_of_its_own():
    electrodes = [{"name": name, "center_mm": [x, 0.0], "size_mm": [1.1, 2.5]} for name, x in (("a", -0.6), ("b", 0.6))]
    film = {"thickness_um": 52.0, "electrodes": electrodes}
    found = pressed({**SLICE, "segment": {**SEGMENT, "film": film}, "dot": {**SLICE["dot"], "offset_mm": [0.1, 0.0]}})
    each = found[1]["discretisation_error"]["electrodes"]
    assert [one["name"] for one in each] == ["a", "b"]
    assert all(one["voltage_percent"] > 0.0 for one in each)
    assert each[0]["voltage_percent"] != each[1]["voltage_percent"]


def sized(accuracy_percent, **change):
    options = {"mesher": "layered", "accuracy_percent": accuracy_percent}
    return Case(config_from({**SLICE, **change, "mesh": options}))


@pytest.mark.press
def test_sizes_are_chosen_so_that_the_stated_error_is_as_small_as_asked():
    coarse, fine = sized(5.0), sized(0.5)
    for case, asked in ((coarse, 5.0), (fine, 0.5)):
        found = case.uncertainty(press_part(case.model, case.press().result, case.press().course))[
            "discretisation_error"
        ]
        assert max(found["force_percent"], found["voltage_percent"]) <= asked
    assert fine.sized_config.mesh.element_size_mm < 0.8 * coarse.sized_config.mesh.element_size_mm
    ratios = [
        case.sized_config.mesh.contact_element_size_mm / case.sized_config.mesh.element_size_mm
        for case in (coarse, fine)
    ]
    assert ratios == pytest.approx([1.0 / 3.0, 1.0 / 3.0])
    assert fine.mesh_quality["element_size_mm"] == fine.sized_config.mesh.element_size_mm


def test_sizes_of_a_press_whose_path_matters_are_those_of_its_elastic_baseline():
    assert sized(2.0, mechanisms=[RELAXING]).sized_config.mesh == sized(2.0).sized_config.mesh


def test_stated_sizes_stay():
    config = config_from(SLICE)
    assert Case(config).sized_config is config


def test_an_accuracy_that_needs_too_many_elements_is_refused_by_its_own_name(monkeypatch):
    monkeypatch.setattr("softdot.checks.MOST_ELEMENTS", 100)
    with pytest.raises(InputError, match=r"mesh\.accuracy_percent = 0\.4: mesh\.contact_element_size_mm = .* elements"):
        _ = Case(config_from({**SLICE, "mesh": {"accuracy_percent": 0.4}})).sized_config


def test_a_mesh_of_a_file_has_the_accuracy_that_it_has():
    with pytest.raises(InputError, match=r"accuracy_percent = 1: acts only without file"):
        config_from({**SLICE, "mesh": {"accuracy_percent": 1.0, "file": "mine.msh"}})
