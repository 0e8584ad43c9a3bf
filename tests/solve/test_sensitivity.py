"""Sensitivities of a whole press against differences of whole presses."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import solve.solution.march
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector
from mesh.build import build
from mesh.options import MeshOptions
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Press
from solve.setup import discretise, set_up
from solve.solution.linear import LinearSolveError
from solve.solution.sensitivity import Variation, VariedSystem, press_with_sensitivities
from solve.system import Load
from solve.terms.solid import InvertedElementError
from solve.waveform import Waveform
from tests.solve.segments import materials, segment

NOISE = 1e-5  # relative to the press: what a parameter must change at least, or this compares round-off
COARSE = MeshOptions(element_size_mm=2.0, contact_element_size_mm=1.5, mesher="layered")
FINER = MeshOptions(element_size_mm=1.2, contact_element_size_mm=0.8, mesher="layered")
PRESS = Press(
    indentation_mm=0.15, load_steps=2, waveform=Waveform(shape="trapezoid", rise_s=0.1, hold_s=0.2, fall_s=0.1)
)

DEEP = PRESS.model_copy(update={"indentation_mm": 0.3})  # so that some of the contact slips


def model(*mechanisms, press=PRESS, coupling="one-way", **sides):
    base = Model(segment(**sides), materials(coupling=coupling), Dot(), press)
    return with_mechanisms(base, [Mechanism(name=n, component=c, parameters=p) for n, c, p in mechanisms])


def with_modulus(base, layer, value):
    changed = base.materials[layer].model_copy(update={"youngs_modulus_MPa": value})
    return replace(base, materials={**base.materials, layer: changed})


def with_segment(base, **changes):
    return replace(base, segment=base.segment.model_copy(update=changes))


def thickness(base, layer, key, value):
    return with_segment(base, **{layer: getattr(base.segment, layer).model_copy(update={key: value})})


VISCOUS = ("viscoelasticity", "medium2", {"relative_moduli": [0.3], "relaxation_times_s": [0.1]})
CASES = {
    "modulus of an elastic layer": (1.0, lambda p: with_modulus(model(), "medium2", p)),
    "modulus of a viscous stack": (5.0, lambda p: with_modulus(model(VISCOUS), "medium1", p)),
    "relative modulus": (
        0.3,
        lambda p: model(("viscoelasticity", "medium2", {"relative_moduli": [p], "relaxation_times_s": [0.1]})),
    ),
    "relaxation time": (
        0.1,
        lambda p: model(("viscoelasticity", "medium2", {"relative_moduli": [0.3], "relaxation_times_s": [p]})),
    ),
    "thickness of a medium": (0.5, lambda p: thickness(model(), "medium1", "thickness_mm", p)),
    "thickness of the film": (28.0, lambda p: thickness(model(), "film", "thickness_um", p)),
    "length of a foot": (
        1.6,
        lambda p: with_segment(model(), effector=Effector(shape="block", length_mm=p, width_mm=1.6, height_mm=1.0)),
    ),
    "length of a segment under a dome": (
        2.2,
        lambda p: with_segment(model(), length_mm=p, effector=Effector(shape="dome", diameter_mm=1.6, height_mm=0.5)),
    ),
    "side stiffness": (5.0, lambda p: with_segment(model(), boundary="elastic", side_stiffness_N_per_mm3=p)),
    "bond stiffness": (
        10.0,
        lambda p: model(
            (
                "adhesive-compliance",
                "bond-film-medium2",
                {"normal_stiffness_N_per_mm3": 50.0, "shear_stiffness_N_per_mm3": p},
            )
        ),
    ),
    "friction": (0.3, lambda p: model(("friction", "dot", {"coefficient": p}), press=DEEP)),
    "softening": (0.3, lambda p: model(("stress-softening", "medium2", {"loss_ratio": p}))),
    "rig compliance": (0.1, lambda p: model(("rig-compliance", "rig", {"compliance_mm_per_N": p}))),
    "moving mass": (
        50.0,
        lambda p: model(
            ("inertia", "rig", {"moving_mass_g": p}), ("rig-compliance", "rig", {"compliance_mm_per_N": 0.1})
        ),
    ),
    "dot offset": (0.1, lambda p: model(("dot-offset", "dot", {"offset_mm": [p, 0.0]}))),
    "dot radius": (1.1, lambda p: model(("property-error", "dot", {"radius_factor": p}))),
    "prestretch": (0.004, lambda p: model(("film-prestretch", "film", {"strain_x": p}))),
    "depth": (0.15, lambda p: model(press=PRESS.model_copy(update={"indentation_mm": p}))),
    "force": (0.1, lambda p: model(press=PRESS.model_copy(update={"indentation_mm": None, "force_N": p}))),
}


MESHES = {
    "friction": FINER,  # half a minute
    "length of a segment under a dome": MeshOptions(element_size_mm=1.0, contact_element_size_mm=0.4),
}
SHARES = {"length of a segment under a dome": 1e-4}  # within more, contact comes to other nodes


@pytest.mark.press
@pytest.mark.parametrize("case", CASES)
def test_sensitivity_is_the_difference_of_two_presses(case, monkeypatch):
    monkeypatch.setattr(solve.solution.march, "TIME_TOLERANCE", np.inf)  # the same times for all presses
    value, at = CASES[case]
    # the difference of two presses, each exact to 1e-10, is then exact to 1e-7 of a press
    small = SHARES.get(case, 1e-3) * value
    base = at(value)
    tet_mesh = build(base.segment, resolve_dot(base.dot, base.segment), MESHES.get(case, COARSE))
    variation = Variation(at(value - small), at(value + small), 2.0 * small)
    _, slopes = press_with_sensitivities(base, {"p": variation}, tet_mesh)
    low, high = (whole_press(at(value + sign * small), base, tet_mesh) for sign in (-1.0, 1.0))
    for quantity in ("reaction_force_N", "film_charge_C"):
        difference = (getattr(high, quantity) - getattr(low, quantity)) / (2.0 * small)
        ours = getattr(slopes["p"].trace, quantity)
        scale = np.abs(difference).max()
        assert scale * value > NOISE * np.abs(getattr(high, quantity)).max()
        np.testing.assert_allclose(ours, difference, atol=2e-4 * scale)


def whole_press(changed, base, tet_mesh):
    """The trace of a press of its own at the same times, on the moved mesh."""
    from mesh.morphing import morphed_mesh

    moved = morphed_mesh(tet_mesh, base.segment, changed.segment)
    return press_with_sensitivities(changed, {}, moved)[0].trace


def test_numbers_stay_with_their_nodes_where_one_passes_another():
    """Nodes of equal x, up to round-off, are numbered by y; a shear of a millionth turns their order about."""
    base, ulp = model(), np.finfo(float).eps
    dot = resolve_dot(base.dot, base.segment)
    tet_mesh = build(base.segment, dot, COARSE)
    rounded = 1.0 + ulp * np.random.default_rng(1).integers(-1, 2, tet_mesh.points_mm.shape)
    uneven = tet_mesh.points_mm * (1.0 + 0.02 * np.sin(9.0 * tet_mesh.points_mm))
    first = discretise(base, replace(tet_mesh, points_mm=uneven * rounded), dot)
    points = first.tet_mesh.points_mm
    sheared = points - 1e-6 * points[:, [1, 0, 0]] * [1.0, 0.0, 0.0]

    def numbers(places, like):
        moved = replace(first.tet_mesh, points_mm=places)
        found = set_up(base, dot, moved, first.opened, like).system.unknowns
        return np.concatenate([found.displacement.ravel(), found.pressure.ravel(), found.contact])

    assert not np.array_equal(numbers(sheared, None), numbers(points, None))
    for places in (points, sheared):
        np.testing.assert_array_equal(numbers(places, first.system), numbers(points, None))


def test_an_element_that_turns_over_beside_the_state_is_no_slope():
    class Flat:
        def trial(self, *_):
            return None

        def evaluate(self, *_):
            raise InvertedElementError("medium2", np.array([0]))

    side = VariedSystem(SimpleNamespace(system=Flat()), 1.0)
    side.state = SimpleNamespace(histories=())
    base = SimpleNamespace(load=Load((0.0, 0.0), 1.0), time=0.0, is_damped=False)
    with pytest.raises(LinearSolveError, match="cannot be differentiated: an element of medium2 is turned inside out"):
        side.residual(np.zeros(3), base)
