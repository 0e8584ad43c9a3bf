"""The reduced model of a standard linear solid under a point contact, against closed forms.

One spring k whose stress relaxes, S = k (s - M): pressed to u it answers F = k (u - M), it is free at u = M, where the
dot first touches, and its elastic amplitude is s = max(u, M). Closed forms of the standard linear solid: Findley, Lai
and Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, 1976, ch. 5.
"""

import numpy as np
import pytest

from solve.materials.prony import Prony
from solve.model import Readout
from solve.physics import Physics
from solve.readout.heat_and_touch import ContactCharge, Pyroelectric
from solve.reduced import cache
from solve.reduced.fit import CELLS, ResponseTable
from solve.reduced.model import ReducedModel, structure_key
from solve.reduced.response import Accuracy
from solve.terms.friction import DotFriction
from solve.terms.guide import GuideFriction
from solve.terms.inertia import MovingMass
from solve.terms.rig import RigSpring
from tests.cases import for_each

STIFFNESS, FULL, SHARE, TAU = 2.0, 0.5, 0.3, 0.2
SOLID = Physics(inelastic={"medium2": (Prony((SHARE,), (TAU,)),)})


def solid(share=0.6) -> ReducedModel:
    """Outputs force, contact area, charge (of the amplitude s, in nC) and s, over (1, M, M^2)."""
    w = np.linspace(0.0, FULL, CELLS + 1)
    table = np.zeros((CELLS + 1, 3, 4))
    table[:, 0] = np.column_stack([STIFFNESS * w, w > 0.0, 1e-9 * w, w])
    rise = 1.0 - w / FULL  # of u = M + w (1 - M / full) with M
    table[:, 1] = np.column_stack([STIFFNESS * (rise - 1.0), 0.0 * w, 1e-9 * rise, rise])
    fit = ResponseTable(table, np.array([0.0, 1.0, 0.0]), np.array([0, 1]), np.array([[0, 0]]), 0.0)
    film, accuracy = np.array([[1e-9, 1e-4]]), Accuracy(0.01, 0.02, 0.03)
    return ReducedModel(fit, FULL, {"medium2": share}, film, 30.0, structure_key(Physics()), accuracy)


def test_a_ramp_relaxes_while_it_rises():
    """F = k r [(1 - g) t + g tau (1 - exp(-t / tau))]."""
    time = np.linspace(0.0, 1.0, 1001)
    force = solid().respond(time, 0.4 * time, SOLID).force_N
    expected = 0.4 * STIFFNESS * ((1 - SHARE) * time + SHARE * TAU * -np.expm1(-time / TAU))
    np.testing.assert_allclose(force, expected, atol=1e-7)


def test_a_step_relaxes_by_its_share_with_its_time():
    time = np.linspace(0.0, 2.0, 2001)
    force = solid().respond(time, np.full(2001, 0.3), SOLID).force_N
    np.testing.assert_allclose(force, 0.3 * STIFFNESS * (1 - SHARE * -np.expm1(-time / TAU)), atol=1e-7)


def test_cyclic_loss_is_that_of_the_loss_modulus():
    """About a mean depth, so that contact is kept: work per cycle = pi k'' a^2, k'' = k g w tau / (1 + (w tau)^2)."""
    w, amplitude = 2 * np.pi * 2.0, 0.1
    time = np.linspace(0.0, 8.0, 160_001)
    depth = 0.35 + amplitude * np.sin(w * time)
    force = solid().respond(time, depth, SOLID).force_N
    last = time >= 7.5 - 1e-9
    work = np.trapezoid(force[last], depth[last])
    assert work == pytest.approx(np.pi * amplitude**2 * STIFFNESS * SHARE * w * TAU / (1 + (w * TAU) ** 2), rel=1e-4)


def test_contact_is_lost_while_the_solid_is_still_deformed_and_then_recovers():
    """Released at once after a long hold the solid is left with M = g u; s = M decays with tau / (1 - g)."""
    time = np.concatenate([np.linspace(0.0, 5.0, 501), 5.0 + 1e-9 + np.linspace(0.0, 1.0, 1001)])
    depth = np.where(time > 5.0, 0.0, 0.4)
    answer = solid().respond(time, depth, SOLID)
    after = time > 5.0
    assert (answer.force_N[after] == 0.0).all()
    expected = 0.4 * SHARE * np.exp(-(time[after] - 5.0) * (1 - SHARE) / TAU)
    np.testing.assert_allclose(1e9 * answer.charge_C[after], expected, atol=1e-6)


def test_a_constant_force_creeps():
    """u = F / k [1 + g / (1 - g) (1 - exp(-(1 - g) t / tau))]."""
    time = np.linspace(0.0, 1.0, 4001)
    path = solid().respond(time, None, SOLID, force_N=np.full(4001, 0.5)).dot_path_mm
    growth = SHARE / (1 - SHARE) * -np.expm1(-(1 - SHARE) * time / TAU)
    np.testing.assert_allclose(path, 0.5 / STIFFNESS * (1 + growth), atol=1e-6)


def test_two_branches_add():
    """Two branches of one time are one branch."""
    time = np.linspace(0.0, 1.0, 501)
    split = Physics(inelastic={"medium2": (Prony((0.1, 0.2), (TAU, TAU)),)})
    one, two = (solid().respond(time, 0.4 * np.sin(3 * time), p).force_N for p in (SOLID, split))
    np.testing.assert_allclose(one, two, atol=1e-8)


def test_the_rig_is_a_spring_in_series():
    time = np.linspace(0.0, 1.0, 101)
    answer = solid().respond(time, 0.4 * time, Physics(terms=(RigSpring(0.25),)))
    np.testing.assert_allclose(answer.force_N, 0.4 * time * STIFFNESS / (1 + 0.25 * STIFFNESS), atol=1e-9)


def test_a_gap_shifts_the_touch():
    time = np.linspace(0.0, 1.0, 101)
    answer = solid().respond(time, 0.4 * time, gap_mm=0.1)
    np.testing.assert_allclose(answer.force_N, STIFFNESS * np.maximum(0.4 * time - 0.1, 0.0), atol=1e-9)
    soft = solid().respond(time, 0.4 * time, Physics(terms=(RigSpring(0.25),)), gap_mm=0.1)
    np.testing.assert_allclose(soft.force_N, answer.force_N / (1 + 0.25 * STIFFNESS), atol=1e-9)
    np.testing.assert_allclose(soft.dot_path_mm, 0.4 * time - 0.25 * soft.force_N, atol=1e-9)


def test_a_mass_rings_at_its_natural_frequency():
    """Pushed by a constant force from rest: u = F / k (1 - cos w t), w = sqrt(k / m)."""
    mass_g = 20.0
    w = np.sqrt(1e3 * STIFFNESS / (1e-3 * mass_g))
    time = np.append(-1e-9, np.linspace(0.0, 2 * np.pi / w, 401))
    force = np.where(time < 0.0, 0.0, 0.3)
    path = solid().respond(time, None, Physics(terms=(MovingMass(mass_g),)), force_N=force).dot_path_mm
    np.testing.assert_allclose(path, 0.15 * (1 - np.cos(w * time)), atol=0.01 * 0.3)


def test_a_prescribed_path_adds_the_force_of_the_mass():
    """m a'' of u = a (1 - cos w t): m a w^2 cos w t."""
    time, w = np.linspace(0.0, 1.0, 4001), 2 * np.pi
    depth = 0.1 * (1 - np.cos(w * time))
    with_mass, without = (solid().respond(time, depth, Physics(terms=(MovingMass(m),))).force_N for m in (50.0, 0.0))
    expected = 0.05 * 1e-4 * w**2 * np.cos(w * time)
    np.testing.assert_allclose((with_mass - without)[1:-1], expected[1:-1], atol=1e-4 * np.abs(expected).max())


@for_each("compliance", [0.0, 0.25])
def test_a_guide_rubs_where_the_rig_travels_and_the_dot_feels_nothing(compliance):
    """0.3 N more on the way in and less on the way out, once it has slipped after 0.02 mm."""
    depth = 0.2 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 401)))
    rubs = GuideFriction((0.3,), (0.02,))
    rigs = (Physics(terms=(RigSpring(compliance),), added=added) for added in ((rubs,), ()))
    rubbing, plain = (solid().respond(np.linspace(0.0, 2.0, 401), depth, rig) for rig in rigs)
    extra = rubbing.force_N - plain.force_N
    np.testing.assert_allclose(extra[21:201], 0.3, rtol=1e-9)
    np.testing.assert_allclose(extra[241:], -0.3, rtol=1e-9)
    np.testing.assert_array_equal(rubbing.charge_C, plain.charge_C)


def test_heat_and_touch_add_their_charge():
    """p A dT (1 - exp(-t / tau)) and the touch's charge."""
    time = np.linspace(0.0, 1.0, 101)
    answer = solid().respond(time, 0.4 * time, Physics(added=(Pyroelectric(0.05, 0.4), ContactCharge(5.0))))
    expected = 0.4e-9 * time + 30e-6 * 1e-4 * 0.05 * -np.expm1(-time / 0.4) + 5e-12 * (time > 0.0)
    np.testing.assert_allclose(answer.charge_C[2:], expected[2:], rtol=1e-9)


def test_heat_begins_with_the_touch_and_not_with_the_first_sample():
    """The film cannot know that it will be touched: time zero is the first touch, as in the solver."""
    time = np.linspace(-1.0, 1.0, 201)
    heat = Physics(added=(Pyroelectric(0.05, 0.4),))
    depth = 0.4 * time  # clear of the segment before
    added = solid().respond(time, depth, heat).charge_C - solid().respond(time, depth, Physics()).charge_C
    assert (added[time <= 0.0] == 0.0).all()
    later = time > 0.0
    np.testing.assert_allclose(added[later], 30e-6 * 1e-4 * 0.05 * -np.expm1(-time[later] / 0.4), rtol=1e-6)


TIME = np.linspace(0.0, 1.0, 11)


def relaxing(layer, share):
    return Physics(inelastic={layer: (Prony((share,), (1.0,)),)})


@for_each(
    ("asked", "reason"),
    [
        ({"depth_mm": 0.6 * TIME}, "depth 0.6 mm: the reduced model knows up to 0.5 mm"),
        ({"force_N": 1.2 * TIME}, "deeper than 0.5 mm"),
        ({"depth_mm": TIME[:5]}, "same length"),
        ({"depth_mm": np.full(11, np.nan)}, "finite"),
        ({}, "either depth_mm or force_N"),
        ({"depth_mm": 0 * TIME, "physics": Physics(terms=(DotFriction(0.3),))}, "friction"),
        ({"depth_mm": 0 * TIME, "physics": Physics(prestretch=(0.01, 0.0))}, "prestretch"),
        (
            {"depth_mm": 0 * TIME, "physics": relaxing("film", 0.1)},
            "film relaxes by 0.1",
        ),
        ({"depth_mm": 0 * TIME, "physics": relaxing("medium2", 0.7)}, "up to 0.6"),
    ],
)
def test_what_the_samples_do_not_cover_is_refused(asked, reason):
    with pytest.raises(ValueError, match=reason):
        solid().respond(TIME, **asked)


def test_the_voltage_bound_of_a_leaky_input_follows_from_that_of_the_charge():
    """Twice the charge's error over C, or R times the error of its rate, whichever is less; open circuit: once."""
    time = np.linspace(0.0, 1.0, 101)
    opened = solid().respond(time, 0.5 * time).error_bound
    assert opened.charge_C == pytest.approx(2.0 * 0.02 * 0.5e-9, rel=1e-6)
    assert opened.voltage_V == pytest.approx(opened.charge_C / 1e-9, rel=1e-6)
    leaky = solid().respond(time, 0.5 * time, readout=Readout(input_resistance_MOhm=1.0)).error_bound
    assert leaky.voltage_V == pytest.approx(1e6 * 2.0 * 0.03 * 0.5e-9, rel=1e-6)
    slow = solid().respond(time, 0.5 * time, readout=Readout(input_resistance_MOhm=1e6)).error_bound
    assert slow.voltage_V == pytest.approx(2 * opened.voltage_V, rel=1e-6)


def test_a_kept_model_is_the_model_and_a_damaged_file_is_none(tmp_path):
    path = tmp_path / "kept.npz"
    cache.write_model(path, solid())
    found = cache.read_model(path)
    before, after = (m.respond(TIME, 0.4 * TIME, SOLID) for m in (solid(), found))
    np.testing.assert_array_equal(before.force_N, after.force_N)
    assert before.error_bound == after.error_bound
    path.write_bytes(path.read_bytes()[:200])
    assert cache.read_model(path) is None
