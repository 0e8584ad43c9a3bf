"""Patch test and observed order of convergence of the mixed quadratic element at finite strain."""

import numpy as np

from solve.fem.mixed_solid import mixed_solid
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear, physical_gradients, quadratic
from solve.materials.laws import InvariantLaw, LinearLaw
from solve.tensors import from_voigt
from tests.cases import for_each
from tests.solve.box import box, mixed_body

NEARLY_INCOMPRESSIBLE = InvariantLaw(0.4, 0.1, 0.02, 0.0, 1000.0)  # K / G = 1000: nu = 0.4995


@for_each("law", [NEARLY_INCOMPRESSIBLE, LinearLaw(1.0, 2.0)], ids=["nu 0.4995", "nu 0.29"])
def test_patch(law):
    """An affine boundary displacement is reproduced inside a distorted mesh, with the pressure K (J - 1)."""
    points, tets = box(2, jitter=0.2)
    f = np.array([[1.2, 0.1, 0.0], [0.05, 0.9, 0.1], [0.0, -0.1, 0.95]])
    affine = points @ (f - np.eye(3)).T
    displacement, pressure = mixed_body(points, tets, law).solve(affine)
    np.testing.assert_allclose(displacement, affine, atol=1e-10)
    expected = law.bulk_modulus * (np.linalg.det(f) - 1.0)
    np.testing.assert_allclose(pressure[tets[:, :4]], expected, atol=1e-8 * law.bulk_modulus)


def manufactured(x):
    """A smooth displacement (n, 3) and its gradient (n, 3, 3): three shears of 30 %, then a dilation of 0.2 %."""
    position, f = x.copy(), np.tile(np.eye(3), (len(x), 1, 1))
    for moved, along, amplitude in ((0, 1, 0.2), (1, 2, 0.2), (2, 0, 0.2), (0, 0, 0.001)):
        slope = np.tile(np.eye(3), (len(x), 1, 1))
        slope[:, moved, along] += amplitude * np.pi / 2 * np.cos(np.pi / 2 * position[:, along])
        position[:, moved] += amplitude * np.sin(np.pi / 2 * position[:, along])
        f = slope @ f
    return position - x, f - np.eye(3)


def errors(cells: int, law: InvariantLaw) -> np.ndarray:
    """L2 and H1 error of the displacement and L2 error of the pressure on a distorted box."""
    points, tets = box(cells, jitter=0.1)
    reference, weights = tetrahedron(5)
    shape, slope = quadratic(reference)
    gradient, weight = physical_gradients(points[tets], slope, weights)
    x = np.einsum("qn,mni->mqi", shape, points[tets])
    u, h = (v.reshape(*x.shape[:2], *v.shape[1:]) for v in manufactured(x.reshape(-1, 3)))
    f = h + np.eye(3)
    cauchy_green = f.swapaxes(-1, -2) @ f
    jacobian = np.linalg.det(f)
    pressure = law.bulk_modulus * (jacobian - 1.0)
    s = from_voigt(law.stress(cauchy_green.reshape(-1, 3, 3))[0]).reshape(f.shape)
    p = f @ (s + (pressure * jacobian)[..., None, None] * np.linalg.inv(cauchy_green))
    # the exact first Piola-Kirchhoff stress loads the body: int P : grad v instead of the body force -Div P
    load = np.zeros_like(points)
    np.add.at(load, tets, np.einsum("mq,mqij,mqnj->mni", weight, p, gradient))
    displacement, nodal = mixed_body(points, tets, law).solve(manufactured(points)[0], load)
    du = np.einsum("qn,mni->mqi", shape, displacement[tets]) - u
    dh = np.einsum("mni,mqnj->mqij", displacement[tets], gradient) - h
    dp = np.einsum("qa,ma->mq", linear(reference), nodal[tets[:, :4]]) - pressure
    return np.sqrt([np.vdot(weight, (e.reshape(*weight.shape, -1) ** 2).sum(-1)) for e in (du, dh, dp)])


def test_observed_order_of_convergence():
    """Quadratic displacement with linear pressure: third order in L2, second in H1 and in the pressure."""
    coarse, fine = errors(2, NEARLY_INCOMPRESSIBLE), errors(4, NEARLY_INCOMPRESSIBLE)
    order = np.log2(coarse / fine)
    assert order[0] > 2.7
    assert order[1] > 1.8
    assert order[2] > 1.8


def test_element_tangent_is_the_derivative_of_its_residual():
    rng = np.random.default_rng(3)
    points, tets = box(1)
    tet, law = tets[:1], NEARLY_INCOMPRESSIBLE
    reference, weights = tetrahedron()
    gradient, weight = physical_gradients(points[tet], quadratic(reference)[1], weights)

    def evaluate(x):
        f = np.einsum("ni,mqnj->mqij", x[:30].reshape(10, 3), gradient) + np.eye(3)
        s, cc = law.stress((f.swapaxes(-1, -2) @ f).reshape(-1, 3, 3))
        ke, re = np.empty((1, 34, 34)), np.empty((1, 34))
        q = len(reference)
        mixed_solid(
            gradient,
            weight,
            linear(reference),
            f,
            x[None, 30:],
            law.bulk_modulus,
            s.reshape(1, q, 6),
            cc.reshape(1, q, 6, 6),
            ke,
            re,
        )
        return np.triu(ke[0]) + np.triu(ke[0], 1).T, re[0]

    x = 0.05 * rng.standard_normal(34)
    tangent = evaluate(x)[0]
    for k, step in enumerate(1e-6 * np.eye(34)):
        np.testing.assert_allclose(tangent[:, k], (evaluate(x + step)[1] - evaluate(x - step)[1]) / 2e-6, atol=1e-7)
