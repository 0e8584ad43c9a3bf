"""Compressible foam against closed forms, and its element without pressure."""

import numpy as np
import pytest
from scipy.optimize import brentq

from solve.fem.compressible_solid import compressible_solid
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import physical_gradients, quadratic
from solve.materials.hyperfoam import HyperfoamLaw
from solve.tensors import from_voigt
from tests.cases import for_each
from tests.solve.box import box

MU, ALPHA, BETA = np.array([0.025, 0.01]), np.array([12.0, -3.0]), np.array([0.05 / 0.9, 0.5])
FOAM = HyperfoamLaw(tuple(MU), tuple(ALPHA), tuple(BETA))
SPONGE = HyperfoamLaw((0.025,), (12.0,), (0.0,))  # MPa; nu = 0


def closed_form(stretch, volume):
    """Nominal stress along the stretch, 2/L sum mu/alpha (L^alpha - J^(-alpha beta))."""
    return float(np.sum(2.0 / stretch * MU / ALPHA * (stretch**ALPHA - volume ** (-ALPHA * BETA))))


def nominal(law, stretches):
    """Diagonal of P = F S."""
    return stretches * law.stress(np.diag(np.square(stretches))[None])[0][0, :3]


@for_each("x", [0.3, 0.6, 0.95, 1.0, 1.2])
def test_uniaxial_compression_and_tension(x):
    lateral = brentq(lambda y: closed_form(y, x * y * y), 0.5, 2.0, xtol=1e-15)
    p = nominal(FOAM, np.array([x, lateral, lateral]))
    assert p[0] == pytest.approx(closed_form(x, x * lateral**2), rel=1e-11, abs=1e-15)
    np.testing.assert_allclose(p[1:], 0.0, atol=1e-13)


@for_each("x", [0.3, 0.7, 1.2])
def test_confined_and_volumetric_deformation(x):
    """P along the side walls of a stiff box follows from stretch 1; equal stretches give equal stresses."""
    np.testing.assert_allclose(
        nominal(FOAM, np.array([x, 1.0, 1.0])), [closed_form(x, x)] + 2 * [closed_form(1.0, x)], rtol=1e-12
    )
    np.testing.assert_allclose(nominal(FOAM, np.full(3, x)), 3 * [closed_form(x, x**3)], rtol=1e-12)


@for_each("poisson_ratio", [-0.2, 0.0, 0.05, 0.3, 0.45])
def test_one_term_keeps_its_poisson_ratio_at_any_strain(poisson_ratio):
    """Zero lateral stress at the lateral stretch L^(-nu) (Storakers 1986)."""
    law = HyperfoamLaw((0.025,), (8.0,), (poisson_ratio / (1.0 - 2.0 * poisson_ratio),))
    p = nominal(law, np.array([0.5, 0.5**-poisson_ratio, 0.5**-poisson_ratio]))
    np.testing.assert_allclose(p[1:], 0.0, atol=1e-13)
    assert p[0] < 0.0


def test_a_sponge_buckles_softly_and_then_densifies():
    """Tangent modulus dP/dL at nu = 0: 2 mu at first, a plateau below a third of it, then more than 2 mu again."""

    def modulus(x):
        return (nominal(SPONGE, np.array([x + 1e-6, 1, 1])) - nominal(SPONGE, np.array([x - 1e-6, 1, 1])))[0] / 2e-6

    first = modulus(1.0)
    assert first == pytest.approx(0.05, rel=1e-6)
    assert modulus(0.6) < first / 3.0
    assert modulus(0.2) > 2.0 * first
    slopes = [modulus(x) for x in np.linspace(0.5, 0.1, 9)]
    assert np.all(np.diff(slopes) > 0.0)


def test_energy_without_poisson_ratio_is_the_limit_of_small_ones():
    c = np.diag([0.6, 1.1, 0.8])[None]
    nearly = HyperfoamLaw((0.025,), (12.0,), (1e-9,))
    np.testing.assert_allclose(SPONGE.energy(c), nearly.energy(c), rtol=1e-7)
    np.testing.assert_allclose(SPONGE.stress(c)[0], nearly.stress(c)[0], rtol=1e-7)


class FoamBody:
    """A distorted box of foam whose surface is prescribed; dense, for a few unknowns."""

    def __init__(self):
        self.points, self.tets = box(2, jitter=0.2)
        reference, weights = tetrahedron()
        self.gradient, self.weight = physical_gradients(self.points[self.tets], quadratic(reference)[1], weights)
        self.dofs = (3 * self.tets[:, :, None] + np.arange(3)).reshape(-1, 30)
        self.inner = np.repeat(((self.points > 0.0) & (self.points < 1.0)).all(axis=1), 3)

    def elements(self, u):
        """Symmetric element matrices (m, 30, 30) and residuals (m, 30) at u (n, 3)."""
        f = np.einsum("mni,mqnj->mqij", u[self.tets], self.gradient) + np.eye(3)
        s, cc = FOAM.stress((f.swapaxes(-1, -2) @ f).reshape(-1, 3, 3))
        ke, re = np.empty((len(f), 30, 30)), np.empty((len(f), 30))
        q = f.shape[:2]
        compressible_solid(self.gradient, self.weight, f, s.reshape(*q, 6), cc.reshape(*q, 6, 6), ke, re)
        return np.triu(ke) + np.triu(ke, 1).swapaxes(1, 2), re

    def assembled(self, u):
        ke, re = self.elements(u)
        tangent, residual = np.zeros(2 * (u.size,)), np.zeros(u.size)
        np.add.at(tangent, (self.dofs[:, :, None], self.dofs[:, None, :]), ke)
        np.add.at(residual, self.dofs, re)
        return tangent, residual


def test_patch_of_foam_elements():
    """An affine displacement of the surface, 30 % compression, is reproduced inside, with forces that balance P."""
    body = FoamBody()
    f = np.array([[0.7, 0.1, 0.0], [0.05, 0.9, 0.1], [0.0, -0.1, 1.1]])
    affine = body.points @ (f - np.eye(3)).T
    u = affine.ravel() * np.where(body.inner, 0.9, 1.0)
    for _ in range(8):
        tangent, residual = body.assembled(u.reshape(-1, 3))
        u[body.inner] -= np.linalg.solve(tangent[np.ix_(body.inner, body.inner)], residual[body.inner])
    np.testing.assert_allclose(u.reshape(-1, 3), affine, atol=1e-12)
    stress = f @ from_voigt(FOAM.stress((f.T @ f)[None])[0][0])
    force = body.assembled(affine)[1].reshape(-1, 3)
    np.testing.assert_allclose(force.T @ body.points, stress, atol=1e-14)  # int P dV = sum of force x place


def test_element_tangent_is_the_derivative_of_its_residual():
    body, rng = FoamBody(), np.random.default_rng(2)
    u = 0.03 * rng.standard_normal(body.points.shape)
    ke, tet = body.elements(u)[0], 7
    for k, dof in enumerate(body.dofs[tet]):
        step = np.zeros(u.size)
        step[dof] = 1e-6
        above, below = (body.elements(u + sign * step.reshape(u.shape))[1][tet] for sign in (1, -1))
        np.testing.assert_allclose(ke[tet, :, k], (above - below) / 2e-6, atol=1e-9)
