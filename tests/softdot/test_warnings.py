"""Good results that a user should still doubt."""

import dataclasses
from contextlib import nullcontext

import pytest

from foundation.errors import InputError
from geometry.dot_at_rest import resolve_dot
from softdot.checks import design_warnings, refuse_held_rim, result_warnings
from softdot.config.loading import config_from, load_config
from softdot.config.model import model_of
from tests.cases import for_each
from tests.softdot.stand_ins import cap_of_height, result_of, step_at

LAYERS = {"medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28}, "medium2": {"thickness_mm": 2}}


def warn(**segment):
    return design_warnings(model_of(config_from({"segment": {**LAYERS, **segment}})))


def test_holding_medium2_closes_a_cavity():
    every = ["medium1", "film", "medium2"]
    (warning,) = warn(boundary="clamped", held_layers=every)
    assert "enclose a nearly incompressible material" in warning
    assert "0.495" in warning
    assert warn(boundary="free") == []
    assert warn(boundary="clamped") == []
    assert warn(boundary="clamped", held_layers=every, medium2={"thickness_mm": 2, "material": "sponge"}) == []


def test_a_bond_that_a_mechanism_replaces_is_told():
    def warned(stiffness_N_per_mm3):
        stated = {"between": ["film", "medium2"], "normal_stiffness_N_per_mm3": 10.0, "shear_stiffness_N_per_mm3": 4.0}
        glue = {"normal_stiffness_N_per_mm3": stiffness_N_per_mm3, "shear_stiffness_N_per_mm3": 4.0}
        mechanism = {"name": "adhesive-compliance", "component": "bond-film-medium2", "parameters": glue}
        tables = {"segment": {**LAYERS, "bonds": [stated]}, "mechanisms": [mechanism]}
        return design_warnings(model_of(config_from(tables)))

    assert warned(10.0) == []
    (told,) = warned(20.0)
    assert "'bond-film-medium2' is not used" in told


def test_film_beyond_yield():
    model, dot = model_of(load_config()), cap_of_height(0.5)
    assert result_warnings(model, dot, result_of([0.0, 0.3], stress_MPa=49.0)) == []
    (warning,) = result_warnings(model, dot, result_of([0.0, 0.3], stress_MPa=58.0))
    assert "58 MPa exceeds its yield stress of 50 MPa" in warning


def test_strain_beyond_the_fitted_range():
    model = model_of(config_from({"segment": LAYERS, "materials": {"pvdf": {"max_fitted_strain": 0.02}}}))
    dot = cap_of_height(0.5)
    within = dataclasses.replace(result_of([0.0]), steps=(step_at(0.0), step_at(0.3, stretch=1.019)))
    beyond = dataclasses.replace(result_of([0.0]), steps=(step_at(0.0), step_at(0.3, stretch=1.029)))
    assert result_warnings(model, dot, within) == []
    assert result_warnings(model, dot, beyond) == [
        "the strain of 2.9 % in film is beyond the fitted range of its material (2 %)"
    ]


def test_a_force_can_press_deeper_than_the_dot():
    model = model_of(config_from({"segment": LAYERS, "press": {"force_N": 2.0}}))
    warnings = result_warnings(model, cap_of_height(0.2), result_of([0.0, 0.3]))
    assert any("exceeds the dot's height of 0.2 mm" in warning for warning in warnings)


@for_each(("length_mm", "reaches"), [(2.5, False), (6.0, True), (7.0, False)])
def test_neighbours_on_the_held_rim(length_mm, reaches):
    """Neighbours at 2.5 mm, radius 0.8125 mm: 0.5 mm from the rim of 6 mm the sphere is 0.172 mm higher."""
    tables = {**LAYERS, "effector": {}, "length_mm": length_mm, "width_mm": length_mm}
    config = config_from({"segment": tables, "dot": {"cell": "⠿", "cell_dot": 2}})
    dot = resolve_dot(config.dot, config.segment)
    refuse_held_rim(config.segment, dot, 0.17)
    with pytest.raises(InputError, match=r"held rim of the segment at 0\.172 mm") if reaches else nullcontext():
        refuse_held_rim(config.segment, dot, 0.3)


@for_each(
    ("dot", "section", "met_mm"),
    [
        ({"shape": "plate", "tilt_deg": [0.0, 3.0]}, "solid", 0.0),
        ({"shape": "ridge", "radius_mm": 1.0}, "solid", 0.0),
        ({"shape": "ridge", "radius_mm": 1.0, "offset_mm": [0.65, 0.0]}, "plane-strain", 0.2),
        ({"shape": "ridge", "radius_mm": 1.0, "offset_mm": [-0.65, 0.0]}, "plane-strain", 0.2),
        ({"shape": "ridge", "radius_mm": 1.0}, "plane-strain", None),
    ],
)
def test_a_dot_of_any_shape_on_the_held_rim(dot, section, met_mm):
    """The rim is at x = 1.25 mm: 0.6 mm beside the axis, a cylinder of 1 mm is 0.2 mm higher."""
    config = config_from({"segment": {**LAYERS, "section": section}, "dot": dot})
    refused = pytest.raises(InputError, match=f"held rim of the segment at {met_mm} mm") if met_mm else nullcontext()
    with pytest.raises(InputError, match="at 0 mm") if met_mm == 0.0 else refused:
        refuse_held_rim(config.segment, resolve_dot(config.dot, config.segment), 0.3)
