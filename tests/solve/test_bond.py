"""Compliant bonds: springs in series, blind to rigid motion, consistent, and viscous as a Prony series says."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mesh.interfaces import split_interface
from mesh.types import TetMesh
from solve.materials.laws import InvariantLaw
from solve.materials.prony import Prony
from solve.terms.bond import bond, layer_stiffness
from solve.terms.contact import SHAPES, facet_area
from tests.cases import for_each
from tests.solve.term_body import TermBody, layers, tangent_error

G, K = 1.0, 20.0
E = 9.0 * K * G / (3.0 * K + G)
RUBBER = InvariantLaw(0.5 * G, 0.0, 0.0, 0.0, K)
LAWS = {"medium2": RUBBER, "film": RUBBER}
UNIT = np.linspace(0.0, 1.0, 3)


def two_blocks(**changes) -> TetMesh:
    """Two layers of 0.6 and 0.4 that make a unit cube."""
    return layers(UNIT, UNIT, [np.linspace(0.0, 0.6, 3), np.linspace(0.6, 1.0, 2)], **changes)


def bonded(tet_mesh: TetMesh, normal: float, shear: float, name: str = "bond-film-medium2") -> TermBody:
    split, lower, upper = split_interface(tet_mesh, name)
    body = TermBody(split, LAWS)
    body.terms.append(bond(body.points, lower, upper, body.dofs, normal, shear))
    return body


def top_traction(body: TermBody, tet_mesh: TetMesh, traction) -> np.ndarray:
    """Nodal forces of a dead traction on the top."""
    facets, force = tet_mesh.facets["top"], np.zeros_like(body.points)
    np.add.at(force, facets, np.einsum("kq,qn,i->kni", facet_area(body.points, facets), SHAPES, traction))
    return force


def sliding_planes(points: np.ndarray) -> np.ndarray:
    """Symmetry at x = 0, y = 0 and z = 0."""
    return points == 0.0


def test_tension_adds_the_compliance_of_the_bond_to_that_of_the_blocks():
    """h / E + 1 / kn for blocks that are free to contract, at a strain small enough to be linear."""
    tet_mesh, load, normal = two_blocks(jitter=0.1), 1e-7, 3.0
    body = bonded(tet_mesh, normal, 0.7)
    state = body.solve(sliding_planes(body.points), load=top_traction(body, tet_mesh, [0.0, 0.0, load]))
    expected = load * (1.0 / E + 1.0 / normal)
    np.testing.assert_allclose(state.displacement[tet_mesh.facets["top"], 2], expected, rtol=1e-6)


@for_each("name", ["bond-film-medium2", "bond-base"])
def test_confined_tension_adds_the_compliance_of_the_bond_to_that_of_the_blocks(name):
    """h / M + 1 / kn when nothing moves but along z; the bond at the base opens between block and ground."""
    tet_mesh, load, normal = two_blocks(jitter=0.1), 1e-7, 3.0
    body = bonded(tet_mesh, normal, 0.7, name)
    fixed = np.ones(body.points.shape, bool)
    fixed[:, 2] = False if name == "bond-base" else body.points[:, 2] == 0.0
    state = body.solve(fixed, load=top_traction(body, tet_mesh, [0.0, 0.0, load]))
    expected = load * (1.0 / (K + 4.0 * G / 3.0) + 1.0 / normal)
    np.testing.assert_allclose(state.displacement[tet_mesh.facets["top"], 2], expected, rtol=1e-6)


@for_each("name", ["bond-film-medium2", "bond-base"])
def test_shear_adds_the_compliance_of_the_bond_to_that_of_the_blocks(name):
    """h / G + 1 / ks when nothing moves but along x."""
    tet_mesh, load, shear = two_blocks(jitter=0.1), 1e-7, 0.7
    body = bonded(tet_mesh, 3.0, shear, name)
    fixed = np.ones(body.points.shape, bool)
    fixed[:, 0] = False if name == "bond-base" else body.points[:, 2] == 0.0
    state = body.solve(fixed, load=top_traction(body, tet_mesh, [load, 0.0, 0.0]))
    expected = load * (1.0 / G + 1.0 / shear)
    np.testing.assert_allclose(state.displacement[tet_mesh.facets["top"], 0], expected, rtol=1e-6)


def test_a_stiff_bond_is_a_perfect_one_but_for_its_own_compliance():
    """At 10 % strain the two differ by 1 / k: a bond ten times stiffer errs ten times less."""
    tet_mesh = two_blocks()

    def pulled(body):
        clamped = (body.points[:, 2] == 0.0) | (body.points[:, 2] == 1.0)
        fixed = np.repeat(clamped[:, None], 3, axis=1)
        return body.force(body.solve(fixed, 0.1 * body.points * [0.0, 0.0, 1.0]), body.points[:, 2] == 1.0)[2]

    perfect = pulled(TermBody(tet_mesh, LAWS))
    error = [abs(pulled(bonded(tet_mesh, k, k)) / perfect - 1.0) for k in (1e5, 1e6)]
    assert error[1] < 2.0 * E / 1e6
    assert error[0] / error[1] == pytest.approx(10.0, rel=1e-3)


def moved_by(body: TermBody, rotation: Rotation, state: np.ndarray) -> np.ndarray:
    """Displacements of nodes deformed by state (n, 3) and then turned."""
    x = np.zeros(body.count)
    x[body.dofs] = rotation.apply(body.points + state) - body.points
    return x


def forces(body: TermBody, x: np.ndarray) -> np.ndarray:
    """Nodal forces (n, 3) of the bond alone."""
    total = np.zeros(body.count)
    term = body.terms[-1]
    for _, part, _, re in term.elements(body.trial(x), term.start()):
        np.add.at(total, term.groups[0][part], re)
    return total[body.dofs]


def test_a_rigid_rotation_of_both_blocks_meets_no_force():
    body = bonded(two_blocks(jitter=0.1), 3.0, 0.7)
    x = moved_by(body, Rotation.from_rotvec([0.9, -1.4, 0.5]), np.zeros_like(body.points))
    assert np.abs(forces(body, x)).max() < 1e-10


def test_the_forces_of_an_open_bond_turn_with_the_body():
    body = bonded(two_blocks(jitter=0.1), 3.0, 0.7)
    opened = 0.1 * np.random.default_rng(2).standard_normal(body.points.shape)
    turn = Rotation.from_rotvec([0.9, -1.4, 0.5])
    still = forces(body, moved_by(body, Rotation.identity(), opened))
    np.testing.assert_allclose(forces(body, moved_by(body, turn, opened)), turn.apply(still), atol=1e-12)


def test_neither_face_is_the_master():
    """With lower and upper exchanged the normal and the jump turn round together: the same forces."""
    split, lower, upper = split_interface(two_blocks(), "bond-film-medium2")
    body = TermBody(split, {})
    x = 0.1 * np.random.default_rng(7).standard_normal(body.count)
    total = []
    for one, other in ((lower, upper), (upper, lower)):
        body.terms = [bond(body.points, one, other, body.dofs, 3.0, 0.7)]
        total.append(forces(body, x))
    np.testing.assert_allclose(total[0], total[1], atol=1e-13)


@for_each("laws", [(), (Prony((0.3, 0.2), (0.5, 2.0)),)], ids=["elastic", "viscous"])
@for_each("name", ["bond-film-medium2", "bond-base"])
def test_tangent_is_the_derivative_of_the_residual_at_a_large_rotation(name, laws):
    ends = np.array([0.0, 1.0])
    tet_mesh = layers(ends, ends, [[0.0, 0.6], [0.6, 1.0]])
    split, lower, upper = split_interface(tet_mesh, name)
    body = TermBody(split, {})
    turn = Rotation.from_rotvec([0.4, -1.0, 0.3])
    x = moved_by(body, turn, 0.1 * np.random.default_rng(4).standard_normal(body.points.shape))
    term = bond(body.points, lower, upper, body.dofs, 3.0, 0.7, laws)
    assert tangent_error(term, lambda at: body.trial(at, time_step=0.3), x) < 1e-6


def test_forces_are_the_derivative_of_the_stored_energy():
    """psi = ks |d|^2 / 2 + (kn - ks) (d . n)^2 / 2, integrated over the interface."""
    body = bonded(two_blocks(), 3.0, 0.7)
    facets = body.terms[-1].facets
    rng = np.random.default_rng(5)
    state, direction = 0.1 * rng.standard_normal((2, *body.points.shape))

    def energy(u):
        jump = facets.jump(u)
        density = 0.35 * (jump.d**2).sum(axis=-1) + 1.15 * jump.opening**2
        return np.vdot(facets.area, density)

    slope = (energy(state + 1e-5 * direction) - energy(state - 1e-5 * direction)) / 2e-5
    x = moved_by(body, Rotation.identity(), state)
    assert np.vdot(forces(body, x), direction) == pytest.approx(slope, rel=1e-8)


def test_a_held_jump_relaxes_along_the_prony_series():
    """After a ramp of time T, traction k d [1 - sum g + sum g (tau / T) (e^(T/tau) - 1) e^(-t/tau)], exactly."""
    prony, rise, step, opened = Prony((0.3, 0.2), (0.5, 2.0)), 0.4, 0.25, np.array([2e-3, 1e-3, 3e-3])
    split, lower, upper = split_interface(two_blocks(), "bond-film-medium2")
    body = TermBody(split, {})
    term = bond(body.points, lower, upper, body.dofs, 3.0, 0.7, (prony,))
    x = np.zeros(body.count)
    x[body.dofs[np.unique(upper)]] = opened
    history, time = term.advance(body.trial(x, np.zeros(body.count), rise), term.start()), rise
    for _ in range(6):
        trial = body.trial(x, x, step)
        total = np.zeros(body.count)
        (block,) = term.elements(trial, history)
        np.add.at(total, term.groups[0], block.residuals)
        force, time, history = total[body.dofs[np.unique(upper)]].sum(axis=0), time + step, term.advance(trial, history)
        g, tau = np.array(prony.relative_moduli), np.array(prony.relaxation_times)
        share = 1.0 - g.sum() + np.sum(g * tau / rise * np.expm1(rise / tau) * np.exp(-time / tau))
        np.testing.assert_allclose(force, share * opened * [0.7, 0.7, 3.0], rtol=1e-10)


def test_a_viscous_bond_without_branches_is_the_elastic_one():
    split, lower, upper = split_interface(two_blocks(), "bond-film-medium2")
    body = TermBody(split, {})
    x = 0.1 * np.random.default_rng(6).standard_normal(body.count)
    terms = [bond(body.points, lower, upper, body.dofs, 3.0, 0.7, laws) for laws in ((), (Prony((), ()),))]
    (elastic,), (viscous,) = (list(term.elements(body.trial(x), term.start())) for term in terms)
    np.testing.assert_array_equal(elastic.residuals, viscous.residuals)
    np.testing.assert_array_equal(elastic.matrices, viscous.matrices)


def test_stiffness_of_a_layer_is_its_confined_and_its_shear_modulus_over_its_thickness():
    """E 1 MPa, nu 0.25, 50 um: M = 1.2 MPa and G = 0.4 MPa over 0.05 mm."""
    assert layer_stiffness(50.0, 1.0, 0.25) == pytest.approx((24.0, 8.0))
