"""Two of the standard NAFEMS benchmarks, on quarters of elliptic membrane and plate."""

import numpy as np

from foundation.arrays import Floats
from softdot.verify.body import ElasticBody, solid_body
from softdot.verify.lattice import Grid, grid
from softdot.verify.loads import traction_force
from softdot.verify.problem import Problem
from solve.fem.kinematics import deformation_gradient
from solve.fem.shape_functions import physical_gradients, quadratic
from solve.materials.laws import LinearLaw, bulk_modulus

YOUNG_MPA, POISSON = 210e3, 0.3
SHEAR = YOUNG_MPA / (2.0 * (1.0 + POISSON))
STEEL = LinearLaw(SHEAR, bulk_modulus(SHEAR, POISSON))
INNER, OUTER = np.array([2.0, 1.0]), np.array([3.25, 2.75])
"""Semi-axes of the inner and outer ellipse in x and y, m."""
LOAD_SHARE = 1e-3  # of the load, for a linear answer


def elliptic_points(p: Floats) -> Floats:
    """Cartesian points from shares of the way between the two ellipses: (share, angle, z) (n, 3) -> (x, y, z)."""
    axes = INNER + p[:, :1] * (OUTER - INNER)
    return np.column_stack([axes * np.column_stack([np.cos(p[:, 1]), np.sin(p[:, 1])]), p[:, 2]])


def middle_on_ellipse(a: Floats, b: Floats) -> Floats:
    """Middles (n, 3) of edges on the ellipse half way between those of their ends."""
    return elliptic_points(0.5 * (_share_and_angle(a) + _share_and_angle(b)))


def _share_and_angle(p: Floats) -> Floats:
    """The inverse of elliptic_points, by Newton's method on x^2 / a^2 + y^2 / b^2 = 1."""
    share = np.zeros(len(p))  # from the inner ellipse on, Newton only climbs: the function is convex
    for _ in range(30):
        axes = INNER + share[:, None] * (OUTER - INNER)
        value = ((p[:, :2] / axes) ** 2).sum(axis=1) - 1.0
        slope = (-2.0 * (p[:, :2] / axes) ** 2 * (OUTER - INNER) / axes).sum(axis=1)
        share -= value / slope
    axes = INNER + share[:, None] * (OUTER - INNER)
    return np.column_stack([share, np.arctan2(p[:, 1] / axes[:, 1], p[:, 0] / axes[:, 0]), p[:, 2]])


def elliptic_mesh(n: int, heights: Floats) -> Grid:
    """The mesh of a quarter: n elements from ellipse to ellipse, finer at the inner one, twice as many around."""
    share = np.linspace(0.0, 1.0, n + 1) ** 1.5
    return grid((share, np.linspace(0.0, np.pi / 2, 2 * n + 1), heights), elliptic_points, middle_on_ellipse)


def stress_yy(body: ElasticBody, tets: np.ndarray, node: int) -> float:
    """Stress along y at a corner node for small strain: mean over its elements of deviatoric stress and pressure."""
    mine = np.flatnonzero((tets[:, :4] == node).any(axis=1))
    reference = np.vstack([np.zeros(3), np.eye(3)])
    gradient, _ = physical_gradients(body.points[tets[mine]], quadratic(reference)[1], np.ones(4))
    f = deformation_gradient(gradient, body.u[tets[mine]])
    corner = (tets[mine, :4] == node).argmax(axis=1)
    f = f[np.arange(len(mine)), corner]
    deviator = STEEL.stress(f.swapaxes(1, 2) @ f)[0][:, 1]
    pressure = body.x[body.pressure[0]][mine, corner]
    return float(np.mean(deviator + pressure))


def le1(n: int) -> float:
    """Stress along y at D, MPa, of a membrane 0.1 m thick whose other half is its mirror image."""
    shape = elliptic_mesh(n, np.array([0.0, 0.05]))
    body, prescribed = _on_planes_of_symmetry(shape)
    prescribed[shape.points[:, 2] == 0.0, 2] = 0.0
    facets = shape.facets(_on_outer_edge)
    body.solve(
        prescribed, traction_force(shape.points, facets, LOAD_SHARE * 10.0 * _normals(shape, facets)), tolerance=1e-8
    )
    return stress_yy(body, shape.tets, _node_at_d(shape, 0.0)) / LOAD_SHARE


def le10(n: int) -> float:
    """Stress along y at D, MPa, of a plate 0.6 m thick under 1 MPa on its upper face."""
    shape = elliptic_mesh(n, np.linspace(-0.3, 0.3, 2 * max(1, n // 3) + 1))
    body, prescribed = _on_planes_of_symmetry(shape)
    edge = _on_outer_edge(shape.points)
    prescribed[edge, :2] = 0.0
    prescribed[edge & (np.abs(shape.points[:, 2]) < 1e-9), 2] = 0.0
    top = shape.facets(lambda x: x[:, 2] == 0.3)
    body.solve(prescribed, traction_force(shape.points, top, [0.0, 0.0, -LOAD_SHARE]), tolerance=1e-8)
    return stress_yy(body, shape.tets, _node_at_d(shape, 0.3)) / LOAD_SHARE


def _on_planes_of_symmetry(shape: Grid) -> tuple[ElasticBody, Floats]:
    """A body of steel, and its displacements (n, 3) prescribed on the planes of symmetry."""
    body = solid_body(shape.points, STEEL, shape.tets)
    prescribed = body.free_displacements()
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    return body, prescribed


def _on_outer_edge(points: Floats) -> np.ndarray:
    """Whether each point lies on the outer ellipse."""
    return np.asarray(((points[:, :2] / OUTER) ** 2).sum(axis=1) > 1.0 - 1e-6)


def _normals(shape: Grid, facets: np.ndarray) -> Floats:
    """Outward normals (k, q, 3) of the outer ellipse at the quadrature points."""
    from solve.terms.contact import SHAPES

    at = np.einsum("qn,kni->kqi", SHAPES, shape.points[facets])
    normal = at / np.append(OUTER**2, np.inf)
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def _node_at_d(shape: Grid, height: float) -> int:
    """The corner node at D = (2, 0) at a height."""
    return int(np.linalg.norm(shape.points - [2.0, 0.0, height], axis=1).argmin())


PROBLEMS = (
    Problem(
        name="nafems-le1",
        title="NAFEMS LE1, elliptic membrane, stress along y at D",
        source="The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, LE1",
        unit="MPa",
        bound_percent=1.0,
        basis="a stress of second order: four times the elements from 6 to 12 along the radius must leave 1 %",
        reference=lambda: 92.7,
        solve=le1,
        meshes=(6, 12),
        limit=True,
    ),
    Problem(
        name="nafems-le10",
        title="NAFEMS LE10, thick elliptic plate, stress along y at D",
        source="The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, LE10",
        unit="MPa",
        bound_percent=2.0,
        basis="a stress of second order on 8 elements along the radius; the target itself has three digits",
        reference=lambda: -5.38,
        solve=le10,
        meshes=(4, 8),
        limit=True,
    ),
)
