"""Presses that start from the equilibria of a similar one."""

from dataclasses import replace

import numpy as np
import pytest

import solve.solution.similar_press
from geometry.parameters import Dot
from mesh.types import TetMesh
from solve.model import Model, Press
from solve.open_interfaces import open_interfaces
from solve.physics import BondLine, Physics
from solve.setup import Setup, set_up
from solve.solution.linear import LinearSolver
from solve.solution.march import rest_state
from solve.solution.schedule import Target
from solve.solution.similar_press import Course, Equilibria, Found, reach, weighted_sum
from solve.system import Load
from tests.solve.segments import cap, coarse_mesh, materials, ridge, segment

PLACES = 0.0, 0.2, 0.5, 1.0  # of the depth
GLUE = Physics(bonds={"bond-film-medium2": BondLine(5.0, 5.0)})


def press(dot=cap, near: Equilibria | None = None, physics=None, **moduli) -> tuple[Setup, Found]:
    """A segment pressed by 0.2 mm, and its unknowns at rest and at the other places."""
    stack, physics = segment(), physics or Physics()
    model = Model(stack, materials(**moduli), Dot(), Press(indentation_mm=0.2), None, physics)
    tet_mesh, opened = open_interfaces(coarse_mesh(stack, dot(stack)), physics.bonds, (), plane_strain=False)
    setup = set_up(model, dot(stack), tet_mesh, opened)
    linear = LinearSolver(setup.system.factorisation_shift)
    past = [rest_state(setup.system, linear, Target(0.0, Load((0.0, 0.0), 0.0), True))]
    beside = near.course(setup.system, tet_mesh) if near else None
    found = [(0.0, past[-1].x)]
    for place in PLACES[1:]:
        target = Target(past[-1].time + 1.0, Load((0.0, 0.0), place * setup.full_drive), True)
        guess = beside.guess(found, place) if beside else None
        assert reach(setup.system, linear, past, target, True, guess) is None
        found.append((place, past[-1].x))
    linear.close()
    return setup, found


def equilibria(pressed: tuple[Setup, Found]) -> Equilibria:
    setup, found = pressed
    return Equilibria.of(setup.system, setup.recorder.tet_mesh, found)


@pytest.fixture(scope="module")
def plain() -> Equilibria:
    return equilibria(press())


@pytest.mark.press
@pytest.mark.parametrize(
    "other",
    [{"e_medium2": 2.0}, {"e_medium1": 1.0}, {"e_effector": 9.0}, {"physics": GLUE}],
    ids=["twice the modulus", "a fifth", "another unit of stress", "nodes doubled along a glue"],
)
def test_the_way_to_an_equilibrium_does_not_matter(plain, other, monkeypatch):
    """From beside it at once, without a march, the same displacements and pressures."""
    marched = equilibria(press(**other))
    monkeypatch.setattr(solve.solution.similar_press, "march", lambda *_: pytest.fail("it marched"))
    near = equilibria(press(near=plain, **other))
    for name in ("displacement_m", "pressure_Pa", "contact_Pa"):
        wanted = getattr(marched, name)
        assert np.abs(wanted).max() > 0.0
        np.testing.assert_allclose(getattr(near, name), wanted, atol=1e-6 * np.abs(wanted).max())


def test_from_far_away_it_marches(plain):
    """Newton's method fails from nonsense, and the press ends where it should all the same."""
    rng = np.random.default_rng(0)
    nonsense = replace(plain, displacement_m=plain.displacement_m + 1e-3 * rng.random(plain.displacement_m.shape))
    found = equilibria(press(near=nonsense))
    np.testing.assert_allclose(found.displacement_m, plain.displacement_m, atol=1e-9)


def test_every_unknown_of_a_plain_press_is_read_back():
    setup, found = press()
    back = equilibria((setup, found)).course(setup.system, setup.recorder.tet_mesh)
    assert back is not None
    assert tuple(back.places) == PLACES
    np.testing.assert_allclose(back.unknowns, [x for _, x in found], rtol=1e-12)


@pytest.mark.press
def test_equilibria_of_other_elements_are_no_guide(plain):
    stack = segment()
    model = Model(stack, materials(), Dot(), Press(indentation_mm=0.2))
    setup = set_up(model, ridge(stack), *open_interfaces(coarse_mesh(stack, ridge(stack)), {}, (), plane_strain=False))
    other: TetMesh = setup.recorder.tet_mesh
    assert plain.course(setup.system, replace(other, tets=other.tets[:-1])) is None


def line(of) -> Course:
    return Course(np.array(PLACES), np.array([[of(place)] for place in PLACES]))


def test_a_difference_that_grows_linearly_is_guessed_exactly():
    near, wanted = line(lambda place: place**2), line(lambda place: place**2 + 0.3 * place)
    found = [(place, wanted.at(place)) for place in PLACES[:3]]
    assert near.guess(found[:2], PLACES[2]) == pytest.approx(wanted.at(PLACES[2]))
    assert near.guess(found, 0.75) == pytest.approx(wanted.at(0.75))  # between two places of the other press


def test_of_a_difference_that_is_known_once_no_more_is_asked():
    assert line(lambda place: place**2).guess([(0.0, np.array([0.1]))], 0.5) == pytest.approx(0.35)


def test_two_presses_add_up():
    both = weighted_sum((2.0, line(lambda place: place)), (-1.0, line(lambda place: place**2)))
    np.testing.assert_allclose(both.unknowns[:, 0], [2.0 * place - place**2 for place in PLACES])
