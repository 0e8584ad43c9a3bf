"""A linear elastic block against scikit-fem: the same spaces on the same distorted mesh, so the same matrix.

At rest our tangent of finite strain is the stiffness of linear elasticity. Both codes integrate it exactly on
straight-sided elements: nothing but round-off may lie between them.
"""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from geometry.electrode_outlines import EVERYWHERE
from softdot.verify.body import solid_body
from solve.fem.pattern import build_pattern
from solve.materials.film import FilmLaw
from solve.materials.laws import LinearLaw, bulk_modulus
from solve.terms.film import film_region
from tests.solve.box import box
from tests.solve.trial import trial

skfem = pytest.importorskip("skfem")
SHEAR, NU = 1.0, 0.3
BULK = bulk_modulus(SHEAR, NU)
ROUND_OFF = 1e-9


@pytest.fixture(scope="module")
def block():
    """Points (n, 3), tetrahedra (m, 10), scikit-fem's bases, and its number of every displacement (n, 3)."""
    points, tets = box(3, (1.0, 0.8, 0.5), jitter=0.2)
    count = int(tets[:, :4].max()) + 1
    theirs = skfem.MeshTet(points[:count].T, tets[:, :4].T)
    motion = skfem.Basis(theirs, skfem.ElementVector(skfem.ElementTetP2()), intorder=4)
    numbers = np.empty((len(points), 3), int)
    numbers[:count] = motion.nodal_dofs.T
    middle = points[theirs.edges.T].mean(axis=1)
    nearest = np.linalg.norm(points[count:, None] - middle, axis=2).argmin(axis=1)
    numbers[count:] = motion.edge_dofs.T[nearest]
    return points, tets, motion, motion.with_element(skfem.ElementTetP1()), numbers


def symmetric(upper):
    """Both triangles of a symmetric matrix."""
    return upper + upper.T - type(upper)(np.diag(upper.diagonal()))


def deviatoric_energy(u, v, _):
    """2 G dev(e(u)) : dev(e(v))."""
    from skfem.helpers import ddot, div, sym_grad

    return 2.0 * SHEAR * (ddot(sym_grad(u), sym_grad(v)) - div(u) * div(v) / 3.0)


def mixed_matrix(motion, pressure):
    """[[A, B^t], [B, -M / K]] of displacement and pressure."""
    from skfem.helpers import div

    a = skfem.BilinearForm(deviatoric_energy).assemble(motion)
    b = skfem.BilinearForm(lambda u, q, _: div(u) * q).assemble(motion, pressure)
    m = skfem.BilinearForm(lambda p, q, _: p * q / BULK).assemble(pressure)
    return skfem.bmat([[a, b.T], [b, -m]], "csr")


def our_mixed_matrix(points, tets):
    """Our tangent at rest, displacements first, then the pressures of the corners in order."""
    body = solid_body(points, LinearLaw(SHEAR, BULK), tets)
    pattern = build_pattern([g for term in body.terms for g in term.groups], body.count)
    upper = body.assemble(pattern, np.zeros(body.count))[1]
    return symmetric(upper)


def same_order(numbers, corners):
    """Their unknowns in our order."""
    return np.concatenate([numbers.ravel(), numbers.size + np.arange(corners)])


@pytest.mark.press
def test_mixed_stiffness_times_any_displacement_and_pressure(block):
    points, tets, motion, pressure, numbers = block
    order = same_order(numbers, pressure.N)
    theirs = mixed_matrix(motion, pressure)[order][:, order]
    x = np.random.default_rng(0).standard_normal(len(order))
    expected = theirs @ x
    np.testing.assert_allclose(our_mixed_matrix(points, tets) @ x, expected, atol=ROUND_OFF * np.abs(expected).max())


def test_a_block_that_hangs_from_its_end_under_its_weight(block):
    """The solution of both systems, not only the matrices."""
    points, tets, motion, pressure, numbers = block
    order = same_order(numbers, pressure.N)
    weight = skfem.LinearForm(lambda v, _: -v[2]).assemble(motion)
    load = np.concatenate([weight, np.zeros(pressure.N)])[order]
    free = np.ones(len(order), bool)
    free[: numbers.size] = np.repeat(points[:, 0] > 1e-12, 3)
    solved = [
        spsolve(matrix.tocsc()[free][:, free], load[free])
        for matrix in (our_mixed_matrix(points, tets), mixed_matrix(motion, pressure)[order][:, order])
    ]
    np.testing.assert_allclose(solved[0], solved[1], atol=ROUND_OFF * np.abs(solved[1]).max())


def test_film_stiffness_times_any_displacement(block):
    """The film's element, displacement only, without its piezoelectric coupling."""
    points, tets, motion, _, numbers = block
    shear = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0]) * SHEAR
    shear[:3, :3] += BULK - 2.0 * SHEAR / 3.0
    law = FilmLaw(shear, np.zeros(6), 1.0, np.eye(6))
    everywhere = [np.array(EVERYWHERE)]
    ours = np.arange(points.size).reshape(-1, 3)
    film = film_region(law, points, tets, ours, np.array([-1]), everywhere, 1.0)
    u = np.random.default_rng(1).standard_normal(points.size)
    product = np.zeros(points.size)
    rest = trial(np.zeros_like(points), np.zeros(points.size))
    for group, part, ke, _ in film.elements(rest, film.start()):
        full = np.triu(ke) + np.triu(ke, 1).swapaxes(1, 2)
        dofs = film.groups[group][part][:, :30]
        np.add.at(product, dofs, np.einsum("mij,mj->mi", full[:, :30, :30], u[dofs]))
    stiffness = skfem.BilinearForm(
        lambda u, v, w: deviatoric_energy(u, v, w) + BULK * skfem.helpers.div(u) * skfem.helpers.div(v)
    ).assemble(motion)
    order = numbers.ravel()
    expected = stiffness[order][:, order] @ u
    np.testing.assert_allclose(product, expected, atol=ROUND_OFF * np.abs(expected).max())
