"""A quarter or a half, mirrored, has the results of the whole on the same nodes.

Both are solved to a relative residual of 1e-10. A residual next to it can be left anywhere, hence the wider bound for
what the rotation of a whole can still move; presses that are linear in their last step agree to round-off.
"""

import numpy as np
import pytest

from mesh.symmetry import mirrored_mesh
from softdot.case import Case
from solve.press import press_segment
from tests.cases import for_each

COARSE = {"mesher": "layered", "element_size_mm": 0.7, "contact_element_size_mm": 0.35}
PRESS = {"indentation_mm": 0.2, "load_steps": 2}
SIDES = [{"name": name, "center_mm": [x, 0.0], "size_mm": [0.5, 2.0]} for name, x in (("left", -0.8), ("right", 0.8))]
CORNERS = [
    {"name": f"{x} {y}", "center_mm": [0.6 * x, 0.6 * y], "size_mm": [0.9, 0.9]} for x in (-1, 1) for y in (-1, 1)
]
MIDDLE = {"name": "middle", "center_mm": [0.0, 0.0], "size_mm": [0.5, 2.0]}
SLICE = {"segment": {"section": "plane-strain"}, "dot": {"shape": "ridge", "radius_mm": 1.15}}


NO_GAP_M = 1e-6


def on(name, component, **parameters):
    return {"name": name, "component": component, "parameters": parameters}


def film(*electrodes, **more):
    return {"thickness_um": 28.0, "electrodes": list(electrodes), **more}


QUICK = {
    "the default design": ((0, 1), {}),
    "a slice": ((0,), SLICE),
    "a slice with two electrodes": ((0,), {**SLICE, "segment": {"section": "plane-strain", "film": film(*SIDES)}}),
    "a dot moved along x": ((1,), {"dot": {"offset_mm": [0.3, 0.0]}}),
    "a dot moved along y": ((0,), {"dot": {"offset_mm": [0.0, 0.3]}}),
    "electrodes in the corners": ((0, 1), {"segment": {"film": film(*CORNERS)}}),
    "electrodes that the planes cut": ((0, 1), {"segment": {"film": film(MIDDLE, *SIDES, draw_angle_deg=90.0)}}),
    "electrodes on one side": ((1,), {"segment": {"film": film(SIDES[0])}}),
}
SLOW = {
    "a pushed dot": ((0, 1), {"press": {"force_N": 1.0, "load_steps": 2}}),
    "a plate beside the planes": (
        (0, 1),
        {
            "dot": {"shape": "plate", "offset_mm": [0.3, 0.2]},
            "segment": {"boundary": "free"},
            "press": {"indentation_mm": 0.05},
        },
    ),
    "the middle dot of a column": ((0, 1), {"dot": {"cell": "⠇", "cell_dot": 2}}),
    "a slide along x with friction": (
        (1,),
        {
            "press": {**PRESS, "path_xy_mm": [[0.1, 0.0]]},
            "mechanisms": [on("friction", "dot", coefficient=0.5)],
        },
    ),
    "friction without a slide": ((0, 1), {"mechanisms": [on("friction", "dot", coefficient=0.5)]}),
    "a soft rig with mass": (
        (0, 1),
        {
            "mechanisms": [
                on("rig-compliance", "rig", compliance_mm_per_N=0.05),
                on("inertia", "rig", moving_mass_g=10.0),
            ]
        },
    ),
    "a delaminated middle": ((0, 1), {"mechanisms": [on("delamination", "bond-film-medium2", diameter_mm=1.0)]}),
    "two delaminated sides": (
        (0, 1),
        {
            "mechanisms": [
                on("delamination", "bond-film-medium2", center_mm=[x, 0.0], diameter_mm=0.8) for x in (-0.5, 0.5)
            ]
        },
    ),
    "elastic sides and a soft bond": (
        (0, 1),
        {
            "segment": {"boundary": "elastic"},
            "mechanisms": [
                on(
                    "adhesive-compliance",
                    "bond-medium1-film",
                    normal_stiffness_N_per_mm3=50.0,
                    shear_stiffness_N_per_mm3=20.0,
                )
            ],
        },
    ),
    "a relaxing medium": (
        (0, 1),
        {
            "press": {**PRESS, "waveform": {"shape": "ramp", "rise_s": 0.1}},
            "mechanisms": [on("viscoelasticity", "medium2", relative_moduli=[0.3], relaxation_times_s=[0.3])],
        },
    ),
    "a softening medium": (
        (0, 1),
        {"mechanisms": [on("stress-softening", "medium1", loss_ratio=0.5, energy_MPa=0.1, beta=0.1)]},
    ),
    "a stretched film": ((0, 1), {"mechanisms": [on("film-prestretch", "film", strain_x=0.003)]}),
    "a yielding film": ((0, 1), {"mechanisms": [on("film-yield", "film", yield_stress_MPa=20.0)]}),
    "a charge of the touch": ((0, 1), {"mechanisms": [on("contact-electrification", "film", charge_pC=5.0)]}),
    "two open electrodes that act back": (
        (0, 1),
        {"materials": {"pvdf": {"coupling": "two-way"}}, "segment": {"film": film(*SIDES)}},
    ),
    "two electrodes on one resistor": (
        (0, 1),
        {
            "materials": {"pvdf": {"coupling": "two-way"}},
            "segment": {"film": film(*SIDES)},
            "press": {**PRESS, "waveform": {"shape": "ramp", "rise_s": 0.1}},
            "readout": {"mode": "voltage", "input_resistance_MOhm": 10.0, "input_capacitance_pF": 20.0},
        },
    ),
}
ALL = [pytest.param(*case, id=name) for name, case in QUICK.items()]
ALL += [pytest.param(*case, id=name, marks=pytest.mark.evidence) for name, case in SLOW.items()]


@pytest.mark.press
@pytest.mark.parametrize(("planes", "tables"), ALL)
def test_part_and_whole_agree(planes, tables):
    case = Case(**{"mesh": COARSE, "press": PRESS, **tables})
    assert case.planes == planes
    part, whole = press_segment(case.model, case.solved_mesh), press_segment(case.model, case.mesh)
    assert (part.planes, whole.planes) == (planes, ())
    assert part.converged
    assert whole.converged
    np.testing.assert_allclose(part.capacitance_F, whole.capacitance_F, rtol=1e-12)
    for name, one, other in compared(part, whole):
        scale = max(np.abs(other).max(), NO_GAP_M if name == "gap_m" else 0.0)  # where all touches, round-off is left
        assert np.abs(one - other).max() <= 1e-9 * scale, f"{name}: {np.abs(one - other).max() / scale:.1e}"


def compared(part, whole):
    """Force, charge and every field of the last step; at the nodes of the elements, as the parts' nodes differ in
    number where interfaces are open.
    """
    ours, theirs = part.steps[-1], whole.steps[-1]
    yield "force", np.array([ours.reaction_force_N]), np.array([theirs.reaction_force_N])
    yield "force on the dot", ours.dot_force_N, theirs.dot_force_N
    yield "charge", ours.film_charge_C, theirs.film_charge_C
    yield "area of contact", part.trace.contact_area_m2[1:], whole.trace.contact_area_m2[1:]  # at rest it is chance
    for name in vars(ours.fields):
        if name in ("film_tets", "contact_nodes"):
            continue
        yield name, *(at_elements(result, getattr(result.steps[-1].fields, name)) for result in (part, whole))


def at_elements(result, values):
    found, tet_mesh = result.steps[-1].fields, result.tet_mesh
    if len(values) == len(tet_mesh.points_mm):
        return values[tet_mesh.tets]
    if len(values) != len(found.contact_nodes):
        return values
    everywhere = np.zeros((len(tet_mesh.points_mm), *values.shape[1:]))
    everywhere[found.contact_nodes] = values
    return everywhere[tet_mesh.facets["contact"]]


REFUSED = {
    "an electrode beside both planes": ((), {"segment": {"film": film({**SIDES[0], "center_mm": [-0.3, 0.1]})}}),
    "a film drawn at 30 degrees": ((), {"segment": {"film": film(draw_angle_deg=30.0)}}),
    "a slide across": ((), {"press": {**PRESS, "path_xy_mm": [[0.1, 0.1]]}}),
    "a slide along y": ((0,), {"press": {**PRESS, "path_xy_mm": [[0.0, 0.1]]}}),
    "a dot beside both planes": ((), {"dot": {"offset_mm": [0.05, 0.05]}}),
    "a plate that is tilted about y": (
        (1,),
        {"dot": {"shape": "plate", "tilt_deg": [0.0, 2.0]}, "segment": {"boundary": "free"}},
    ),
    "the left of two dots": ((1,), {"dot": {"cell": "⠒", "cell_dot": 2}}),
    "a delaminated patch on one side": (
        (1,),
        {"mechanisms": [on("delamination", "bond-film-medium2", center_mm=[0.4, 0.0], diameter_mm=0.8)]},
    ),
    "no symmetry wanted": ((), {"mesh": {**COARSE, "symmetry": "none"}}),
}


@for_each(("planes", "tables"), REFUSED.values(), ids=REFUSED)
def test_a_plane_is_refused_where_something_is_not_its_own_image(planes, tables):
    assert Case(**{"mesh": COARSE, "press": PRESS, **tables}).planes == planes


MIRRORED = {
    "the dot": ({"dot": {"offset_mm": [0.3, 0.2]}}, {"dot": {"offset_mm": [-0.3, 0.2]}}),
    "the draw direction": (
        {"segment": {"film": film(*SIDES, draw_angle_deg=30.0)}},
        {"segment": {"film": film(*SIDES[::-1], draw_angle_deg=-30.0)}},
    ),
    "an electrode": (
        {"segment": {"film": film({**SIDES[0], "center_mm": [-0.5, 0.2]})}},
        {"segment": {"film": film({**SIDES[0], "center_mm": [0.5, 0.2]})}},
    ),
    "a slide": (
        {"press": {**PRESS, "path_xy_mm": [[0.1, 0.1]]}},
        {"press": {**PRESS, "path_xy_mm": [[-0.1, 0.1]]}},
    ),
}


@pytest.mark.evidence
@for_each(("tables", "mirrored"), MIRRORED.values(), ids=MIRRORED)
def test_a_mirrored_configuration_gives_the_mirrored_results(tables, mirrored):
    """About x = 0, on a mesh that is its own image: forces along x change sign and nothing else does."""
    tet_mesh = Case(mesh=COARSE).mesh
    ours, theirs = (press_segment(Case(**{"press": PRESS, **each}).model, tet_mesh) for each in (tables, mirrored))
    assert ours.converged
    assert theirs.converged
    force, image = ours.trace.contact_force_N, theirs.trace.contact_force_N * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(force, image, rtol=0.0, atol=1e-9 * np.abs(force).max())
    np.testing.assert_allclose(ours.steps[-1].film_charge_C, theirs.steps[-1].film_charge_C, rtol=1e-9)


@pytest.mark.press
def test_a_press_refuses_nothing_and_unfolds_what_is_too_little():
    """A quarter given to a press that lacks a plane is mirrored first."""
    quarter = Case(mesh=COARSE, press=PRESS).solved_mesh
    moved = Case(mesh=COARSE, press=PRESS, dot={"offset_mm": [0.05, 0.0]})
    assert quarter.planes == (0, 1)
    ours, whole = press_segment(moved.model, quarter), press_segment(moved.model, mirrored_mesh(quarter).tet_mesh)
    assert ours.planes == (1,)
    np.testing.assert_allclose(ours.trace.reaction_force_N, whole.trace.reaction_force_N, rtol=1e-9)
