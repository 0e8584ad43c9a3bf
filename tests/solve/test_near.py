"""Presses that start from the equilibria of a similar one."""

from dataclasses import replace

import numpy as np
import pytest

import solve.near
from geometry.parameters import Dot
from mesh.types import TetMesh
from solve.interfaces import open_interfaces
from solve.linear import LinearSolver
from solve.march import rest_state
from solve.model import Model
from solve.near import Equilibria, guess, reach
from solve.parameters import Press
from solve.physics import BondLine, Physics
from solve.schedule import Target
from solve.setup import Setup, set_up
from solve.system import Load
from tests.solve.segments import cap, coarse_mesh, materials, ridge, segment

PLACES = 0.0, 0.2, 0.5, 1.0  # of the depth
GLUE = Physics(bonds={"bond-film-medium2": BondLine(5.0, 5.0)})


def press(dot=cap, near: Equilibria | None = None, physics=None, **moduli) -> tuple[Setup, list[np.ndarray]]:
    """A segment pressed by 0.2 mm, and its unknowns at rest and at the other places."""
    stack, physics = segment(), physics or Physics()
    model = Model(stack, materials(**moduli), Dot(), Press(indentation_mm=0.2), None, physics)
    tet_mesh, opened = open_interfaces(coarse_mesh(stack, dot(stack)), physics.bonds, (), plane_strain=False)
    setup = set_up(model, dot(stack), tet_mesh, opened)
    linear = LinearSolver(setup.system.factorisation_shift)
    past = [rest_state(setup.system, linear, Target(0.0, Load((0.0, 0.0), 0.0), True))]
    known = near.unknowns(setup.system, tet_mesh) if near else []
    found = [past[-1].x]
    for place in PLACES[1:]:
        target = Target(past[-1].time + 1.0, Load((0.0, 0.0), place * setup.full_drive), True)
        beside = guess(known, PLACES, found) if known else None
        assert reach(setup.system, linear, past, target, True, beside) is None
        found.append(past[-1].x)
    linear.close()
    return setup, found


def equilibria(pressed: tuple[Setup, list[np.ndarray]]) -> Equilibria:
    setup, found = pressed
    return Equilibria.of(setup.system, setup.recorder.tet_mesh, found)


@pytest.fixture(scope="module")
def plain() -> Equilibria:
    return equilibria(press())


@pytest.mark.parametrize(
    "other",
    [{"e_medium2": 2.0}, {"e_medium1": 1.0}, {"e_effector": 9.0}, {"physics": GLUE}],
    ids=["twice the modulus", "a fifth", "another unit of stress", "nodes doubled along a glue"],
)
def test_the_way_to_an_equilibrium_does_not_matter(plain, other, monkeypatch):
    """From beside it at once, without a march, the same displacements and pressures."""
    marched = equilibria(press(**other))
    monkeypatch.setattr(solve.near, "march", lambda *_: pytest.fail("it marched"))
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
    back = equilibria((setup, found)).unknowns(setup.system, setup.recorder.tet_mesh)
    np.testing.assert_allclose(back, found, rtol=1e-12)


def test_equilibria_of_other_elements_are_refused(plain):
    setup, _ = press(ridge)
    other: TetMesh = setup.recorder.tet_mesh
    with pytest.raises(ValueError, match="other elements"):
        plain.unknowns(setup.system, replace(other, tets=other.tets[:-1]))


def test_a_difference_that_grows_linearly_is_guessed_exactly():
    near = [np.array([place**2]) for place in PLACES]
    wanted = [x + 0.3 * place for x, place in zip(near, PLACES, strict=True)]
    assert guess(near, PLACES, wanted[:2]) == pytest.approx(wanted[2])
    assert guess(near, PLACES, wanted[:3]) == pytest.approx(wanted[3])
