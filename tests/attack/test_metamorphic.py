"""What must follow when a design is mirrored, turned, scaled, stiffened, cut in two or pressed in other steps.

Nobody knows the right force of these designs, but how the force of one follows from that of another is known. Where
the mesh stays the same, relations hold to round-off and the tolerance of Newton's method. A design that is mirrored,
turned or of another size gets another mesh (the refined zone under the dot has a fixed depth in mm): there they hold as
well as coarse meshes agree. On one and the same mesh, tests/verification/test_units.py scales to 1e-9.
"""

from copy import deepcopy

import numpy as np
import pytest

from tests.cases import for_each
from tests.softdot.press_checks import solved

pytestmark = pytest.mark.evidence
ANOTHER_MESH = 0.01
"""Of force and charge, between two coarse meshes of one design."""
SLICE = {
    "segment": {
        "section": "plane-strain", "length_mm": 3.0, "width_mm": 2.0, "boundary": "clamped", "held_layers": ["film"],
        "effector": {"shape": "block", "length_mm": 2.0, "height_mm": 0.6, "material": "top"},
        "medium1": {"thickness_mm": 0.6, "material": "top"},
        "film": {"thickness_um": 40.0, "material": "foil", "draw_angle_deg": 20.0},
        "medium2": {"thickness_mm": 1.2, "material": "bed"},
    },
    "materials": {
        "top": {"model": "yeoh", "c10_MPa": 0.3, "c20_MPa": 0.02, "c30_MPa": 0.002, "poisson_ratio": 0.49},
        "bed": {"model": "ogden", "mu_MPa": [0.1, 0.05], "alpha": [2.0, 4.0], "poisson_ratio": 0.48},
        "foil": {"model": "piezoelectric-film", "youngs_modulus_MPa": 1500.0, "youngs_modulus_2_MPa": 1200.0},
    },
    "dot": {"shape": "ridge", "radius_mm": 0.9, "offset_mm": [0.25, 0.0], "tilt_deg": [0.0, 1.5]},
    "press": {"indentation_mm": 0.25, "load_steps": 2},
    "mesh": {"element_size_mm": 0.3, "contact_element_size_mm": 0.15, "mesher": "layered"},
}  # fmt: skip
SOLID = {
    **SLICE,
    "segment": {
        **SLICE["segment"], "section": "solid", "length_mm": 2.0, "width_mm": 2.0, "boundary": "elastic",
        "side_stiffness_N_per_mm3": 2.0, "effector": {"shape": "layer", "height_mm": 0.5, "material": "top"},
        "bonds": [{"between": ["film", "medium2"], "normal_stiffness_N_per_mm3": 800.0,
                   "shear_stiffness_N_per_mm3": 200.0}],
    },
    "dot": {"shape": "cap", "radius_mm": 0.9, "height_mm": 0.5, "offset_mm": [0.2, 0.0]},
    "press": {"indentation_mm": 0.2, "load_steps": 1},
    "mesh": {"element_size_mm": 0.6, "contact_element_size_mm": 0.3, "mesher": "layered"},
}  # fmt: skip
DESIGNS = {"slice": SLICE, "solid": SOLID}


@pytest.fixture(scope="module")
def end():
    """Force in N, charges in C and voltages in V at the end of a press; of a design pressed before as then."""
    known = {}

    def get(tables):
        key = repr(tables)
        if key not in known:
            result = solved(tables).result
            assert result.converged, result.failure
            last = result.steps[-1]
            known[key] = (last.reaction_force_N, np.array(last.film_charge_C), np.array(last.open_circuit_voltage_V))
            assert last.reaction_force_N > 0.0
            assert np.abs(last.film_charge_C).min() > 0.0
        return known[key]

    return get


def changed(tables, **changes):
    """A copy with other values; keys of the changes are TABLE__KEY."""
    copy = deepcopy(tables)
    for path, value in changes.items():
        *tables_on_the_way, key = path.split("__")
        place = copy
        for name in tables_on_the_way:
            place = place[name]
        place[key] = value
    return copy


def same(one, other, force=1.0, charge=1.0, voltage=1.0, rel=1e-6):
    """The second end is the first times these factors."""
    for a, b, factor in zip(one, other, (force, charge, voltage), strict=True):
        np.testing.assert_allclose(b, factor * np.asarray(a), rtol=rel)


@for_each("name", DESIGNS)
def test_a_design_mirrored_in_x_gives_the_same(name, end):
    tables = DESIGNS[name]
    (x, y), (about_x, about_y) = tables["dot"]["offset_mm"], tables["dot"].get("tilt_deg", (0.0, 0.0))
    mirrored = changed(
        tables, segment__film__draw_angle_deg=-20.0, dot__offset_mm=[-x, y], dot__tilt_deg=[about_x, -about_y]
    )
    same(end(tables), end(mirrored), rel=1e-9 if name == "slice" else ANOTHER_MESH)  # a slice's mesh is symmetric


def test_a_square_segment_turned_by_a_quarter_gives_the_same(end):
    """With its film, its dot beside the middle and the tilt of the dot."""
    tables = changed(SOLID, dot__tilt_deg=[0.0, 2.0])
    turned = changed(tables, segment__film__draw_angle_deg=110.0, dot__offset_mm=[0.0, 0.2], dot__tilt_deg=[-2.0, 0.0])
    same(end(tables), end(turned), rel=ANOTHER_MESH)


@for_each("name", DESIGNS)
def test_a_draw_direction_has_no_head_and_no_tail(name, end):
    same(end(DESIGNS[name]), end(changed(DESIGNS[name], segment__film__draw_angle_deg=200.0)), rel=1e-9)


@for_each("name", DESIGNS)
@for_each("factor", [0.1, 4.0])
def test_a_design_of_another_size(name, factor, end):
    """All lengths times s: forces times s^2, charge times s^2, capacitance times s, so voltage times s."""
    same(end(DESIGNS[name]), end(sized(DESIGNS[name], factor)), factor**2, factor**2, factor, rel=ANOTHER_MESH)


def sized(table, factor):
    """Every length times a factor; a stiffness per area is a stress per length."""
    scaled = {}
    for key, value in table.items():
        if isinstance(value, dict):
            scaled[key] = sized(value, factor)
        elif key.endswith(("_mm", "_um")):
            scaled[key] = [factor * one for one in value] if isinstance(value, list) else factor * value
        elif key.endswith("_N_per_mm3"):
            scaled[key] = value / factor
        else:
            scaled[key] = [sized(one, factor) for one in value] if key == "bonds" else value
    return scaled


@for_each("name", DESIGNS)
def test_a_design_of_other_moduli(name, end):
    """All moduli, of film, media, glue and sides, times m: at the same depth force, stress and charge times m."""
    same(end(DESIGNS[name]), end(stiffened(DESIGNS[name], 2.5)), 2.5, 2.5, 2.5)


def stiffened(table, factor):
    """Every stress and every stiffness times a factor."""
    scaled = {}
    for key, value in table.items():
        if isinstance(value, dict):
            scaled[key] = stiffened(value, factor)
        elif key.endswith(("_MPa", "_N_per_mm3")):
            scaled[key] = [factor * one for one in value] if isinstance(value, list) else factor * value
        else:
            scaled[key] = [stiffened(one, factor) for one in value] if key == "bonds" else value
    return scaled


@for_each("name", ["slice"])
def test_other_piezoelectric_constants_give_other_charge_and_the_same_force(name, end):
    plain = changed(DESIGNS[name], materials__foil__d31_pC_per_N=20.0, materials__foil__d32_pC_per_N=3.0,
                    materials__foil__d33_pC_per_N=-30.0)  # fmt: skip
    twice = changed(DESIGNS[name], materials__foil__d31_pC_per_N=40.0, materials__foil__d32_pC_per_N=6.0,
                    materials__foil__d33_pC_per_N=-60.0)  # fmt: skip
    same(end(plain), end(twice), 1.0, 2.0, 2.0)


@for_each("name", DESIGNS)
def test_the_charges_of_two_halves_add_up_to_that_of_the_whole(name, end):
    length, width = DESIGNS[name]["segment"]["length_mm"], DESIGNS[name]["segment"]["width_mm"]
    halves = [
        {"name": f"at {side}", "center_mm": [side * length / 4, 0.0], "size_mm": [length / 2, width]}
        for side in (-1, 1)
    ]
    whole, cut = end(DESIGNS[name]), end(changed(DESIGNS[name], segment__film__electrodes=halves))
    assert cut[0] == pytest.approx(whole[0], rel=1e-9)
    assert cut[1].sum() == pytest.approx(whole[1].sum(), rel=1e-9)


@for_each("name", DESIGNS)
def test_the_end_does_not_hang_on_the_number_of_load_steps(name, end):
    same(end(DESIGNS[name]), end(changed(DESIGNS[name], press__load_steps=5)))


def test_a_force_presses_as_deep_as_the_depth_that_took_it(end):
    force = end(SLICE)[0]
    by_force = changed(SLICE, press={"force_N": float(force), "load_steps": 2})
    same(end(SLICE), end(by_force))
    assert solved(by_force).result.steps[-1].indentation_m == pytest.approx(0.25e-3, rel=1e-6)


def test_a_dot_that_starts_higher_and_goes_deeper_by_as_much_gives_the_same(end):
    same(end(SLICE), end(changed(SLICE, dot__gap_mm=0.1, press__indentation_mm=0.35)))
