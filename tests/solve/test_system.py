"""The whole discrete problem: its tangent, its symmetries and its limits."""

import numpy as np
import pytest

import solve.solution.newton
from geometry.parameters import Dot, Film
from mesh.options import MeshOptions
from solve.model import Model, Press
from solve.physics import Physics
from solve.problem import build_system
from solve.setup import set_up
from solve.solution.linear import LinearSolver
from solve.solution.march import march
from solve.system import Load
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import cap, coarse_mesh, materials, ridge, segment

SHALLOW = Press(indentation_mm=0.2, load_steps=2)


def last(stack, stuff, dot, press=SHALLOW):
    result = press_segment(stack, stuff, dot, press, coarse_mesh(stack, dot))
    assert result.converged, result.failure
    return result.steps[-1]


@for_each("force_driven", [False, True])
def test_tangent_is_the_derivative_of_the_residual(force_driven):
    """Solid, film with two-way coupling, elastic sides, contact and dot together, in a random direction."""
    stack = segment(boundary="elastic", side_stiffness_N_per_mm3=3.0)
    dot = cap(stack)
    system = build_system(stack, materials(coupling="two-way"), dot, coarse_mesh(stack, dot), force_driven)
    rng = np.random.default_rng(0)
    load = Load((0.01, 0.0), drive=0.1 if force_driven else 0.05)
    x = 1e-4 * rng.standard_normal(system.count)
    x[system.contact.pressure_dofs] += 0.1  # well inside or outside contact: the active set stays
    if force_driven:
        x[system.unknowns.approach] = 0.05
    rest = system.at_rest(Load((0.0, 0.0), 0.0))

    def evaluate(x):
        return system.evaluate(system.trial(x, load, 1.0, rest), rest.histories)

    here = evaluate(x)
    assert 0 < here.status.sum() < len(here.status)
    direction = rng.standard_normal(len(x))
    step = 1e-6
    difference = (evaluate(x + step * direction).residual - evaluate(x - step * direction).residual) / (2 * step)
    assert np.linalg.norm(here.tangent @ direction - difference) < 1e-6 * np.linalg.norm(difference)


def test_switched_constraints_are_those_of_a_state_that_has_them():
    """Pressures move nodes in and out of contact; the gap does not know of them."""
    stack = segment()
    dot = cap(stack)
    system = build_system(stack, materials(), dot, coarse_mesh(stack, dot), force_driven=False)
    rest, load = system.at_rest(Load((0.0, 0.0), 0.0)), Load((0.0, 0.0), 0.05)
    trial = system.trial(1e-4 * np.random.default_rng(0).standard_normal(system.count), load, 1.0, rest)
    now = system.evaluate(trial, rest.histories)
    wanted = ~now.status
    wanted[::3] = now.status[::3]
    there = system.with_status(now, trial, rest.histories, wanted)
    back = system.with_status(there, trial, rest.histories, now.status)
    np.testing.assert_allclose(back.residual, now.residual, atol=1e-12)
    np.testing.assert_allclose(back.tangent.upper.data, now.tangent.upper.data, atol=1e-12)
    rows, pressure = system.contact.pressure_dofs, trial.x[system.contact.pressure_dofs]
    np.testing.assert_array_equal(there.tangent.diagonal[rows], np.where(wanted, 0.0, -1.0))
    np.testing.assert_allclose(there.residual[rows][~wanted], -pressure[~wanted], atol=1e-12)
    gap = system.contact.weighted_gap(trial.displacement, trial.move)
    np.testing.assert_allclose(there.residual[rows][wanted], -gap[wanted], atol=1e-12)


@pytest.mark.press
def test_a_force_of_what_the_depth_took_gives_the_depth():
    stack = segment()
    deep = last(stack, materials(), cap(stack))
    pushed = last(stack, materials(), cap(stack), Press(force_N=deep.reaction_force_N, load_steps=2))
    assert pushed.indentation_m == pytest.approx(2e-4, rel=1e-8)
    assert pushed.open_circuit_voltage_V == pytest.approx(deep.open_circuit_voltage_V, rel=1e-8)


@pytest.mark.press
def test_elastic_sides_lie_between_free_and_clamped():
    """Stiffness 0 is free; a very stiff case is clamped."""

    def force(**sides):
        stack = segment(**sides)
        return last(stack, materials(), cap(stack)).reaction_force_N

    free, clamped = force(boundary="free"), force(boundary="clamped")
    assert force(boundary="elastic", side_stiffness_N_per_mm3=0.0) == pytest.approx(free, rel=1e-9)
    assert force(boundary="elastic", side_stiffness_N_per_mm3=1e7) == pytest.approx(clamped, rel=1e-3)
    assert free < force(boundary="elastic", side_stiffness_N_per_mm3=5.0) < clamped


def test_a_square_segment_does_not_know_the_draw_direction():
    """Turning the film by a quarter turn leaves force and voltage under a centred dot."""
    along, across = (
        last(segment(film=Film(thickness_um=28.0, draw_angle_deg=angle)), materials(), cap(segment()))
        for angle in (0.0, 90.0)
    )
    assert across.reaction_force_N == pytest.approx(along.reaction_force_N, rel=1e-9)
    assert across.open_circuit_voltage_V == pytest.approx(along.open_circuit_voltage_V, rel=2e-2)


def test_two_way_coupling_stiffens_by_less_than_the_coupling_factor():
    """k31^2 = d31^2 Y / eps = 1.0 % for Y = 2 GPa: a strained film gives up to 1 / (1 - k^2) more volts."""
    one, two = (last(segment(), materials(coupling=way), cap(segment())) for way in ("one-way", "two-way"))
    assert 1.0 < two.reaction_force_N / one.reaction_force_N < 1.01
    assert 1.0 < float(two.open_circuit_voltage_V[0] / one.open_circuit_voltage_V[0]) < 1.02


def test_plane_strain_is_scaled_by_the_width():
    narrow, wide = (segment(section="plane-strain", width_mm=w) for w in (2.5, 16.0))
    a, b = (last(stack, materials(), ridge(stack)) for stack in (narrow, wide))
    assert b.reaction_force_N / a.reaction_force_N == pytest.approx(6.4, rel=1e-9)
    assert b.film_charge_C[0] / a.film_charge_C[0] == pytest.approx(6.4, rel=1e-9)
    assert b.open_circuit_voltage_V == pytest.approx(a.open_circuit_voltage_V, rel=1e-9)


def test_a_surface_too_coarse_for_the_dot_is_told():
    """Elements of 1.2 mm under a ridge of 0.3 mm radius, against 0.1 mm ones."""
    stack = segment(section="plane-strain")
    dot, press = ridge(stack, radius_mm=0.3), Press(indentation_mm=0.1, load_steps=1)

    def warnings(size):
        options = MeshOptions(mesher="layered", contact_element_size_mm=size, element_size_mm=size)
        return press_segment(stack, materials(), dot, press, coarse_mesh(stack, dot, options)).warnings

    assert warnings(0.1) == ()
    assert "overlaps the surface" in warnings(1.2)[0]


@pytest.mark.press
def test_the_contact_area_is_where_the_surface_lies_on_the_dot():
    """Nodes count where the gap around them is nil; open ones have a pressure too, of round-off."""
    stack = segment(boundary="free")  # a ridge would meet a held rim
    dot, mesh = ridge(stack), coarse_mesh(stack, ridge(stack))
    model = Model(stack, materials(), Dot(), SHALLOW, None, Physics())
    setup = set_up(model, dot, mesh, ())
    linear, rest = LinearSolver(setup.system.factorisation_shift), setup.system.at_rest(Load((0.0, 0.0), 0.0))
    setup.recorder.start(rest)
    past = [rest]
    for target in setup.targets(follows_time=False)[1:]:  # the first is rest
        assert march(setup.system, linear, past, target, True, setup.recorder.record) is None
    contact, state, record = setup.system.contact, past[-1], setup.recorder.records[-1]
    gap = contact.mean_gap(setup.system.displacement(state.x), setup.system.move(state.x, state.load))
    touching = np.abs(gap) < 1e-9 * setup.full_drive
    assert 0 < touching.sum() < len(gap)
    area = contact.nodal_area[touching].sum() * setup.system.units.length**2
    assert record.contact_area_m2 == pytest.approx(area, rel=1e-12)


def test_rubber_of_poisson_ratio_0_4995_converges():
    stack = segment()
    assert last(stack, materials(poisson_ratio=0.4995), cap(stack)).reaction_force_N > 0


@pytest.mark.press
def test_a_slide_keeps_its_depth_and_ends_where_it_was_sent():
    stack = segment(boundary="free")
    press = Press(indentation_mm=0.2, load_steps=2, path_xy_mm=((0.2, 0.1),))
    result = press_segment(stack, materials(), cap(stack), press, coarse_mesh(stack, cap(stack)))
    assert result.converged
    assert len(result.steps) == 5
    moved = result.steps[-1].dot_position_m - result.steps[0].dot_position_m
    np.testing.assert_allclose(moved, [2e-4, 1e-4, -2e-4], atol=1e-12)


def test_want_of_convergence_is_told_with_its_place_and_keeps_what_converged(monkeypatch):
    stack, calls = segment(), []
    whole = solve.solution.newton.equilibrate

    def fails_after_the_first(system, linear, x, load, time, previous, **options):
        calls.append(load)
        if load.drive * 2.5 > 0.11:
            monkeypatch.setattr(solve.solution.newton, "MAX_ITERATIONS", 1)
        return whole(system, linear, x, load, time, previous, **options)

    monkeypatch.setattr("solve.solution.march.equilibrate", fails_after_the_first)
    result = press_segment(stack, materials(), cap(stack), SHALLOW, coarse_mesh(stack, cap(stack)))
    assert not result.converged
    assert result.steps[1].indentation_m == pytest.approx(1e-4)
    assert "step 2 of 2 stopped at" in result.failure
    assert "no convergence" in result.failure
    assert "mm" in result.failure
