"""Von Karman's plate equations for a clamped disc, integrated as a boundary-value problem: nu = 0.3, axisymmetric."""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_bvp

from foundation.arrays import Floats

POISSON = 0.3
START = 1e-4  # radius at which the regular solution begins


def centre_deflection(load: float, patch: float) -> float:
    """Deflection over thickness at the centre under a pressure on r < patch; load = F a^2 / (E t^4), F the force.

    With w in t, r in a, u in t^2 / a (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, 1959, eq. 231):
        u'' + u'/r - u/r^2 = -(1 - nu) w'^2 / (2 r) - w' w''
        w''' + w''/r - w'/r^2 = 12 w' (u' + nu u/r + w'^2 / 2) + 12 (1 - nu^2) Q,   2 pi r Q = the load inside r
    """
    radius, state = np.linspace(START, 1.0, 400), np.zeros((5, 400))
    for fraction in (0.1, 0.3, 0.6, 1.0):
        solution = solve_bvp(_equations(fraction * load, patch), _edges, radius, state, tol=1e-6, max_nodes=20000)
        assert solution.status == 0, solution.message
        radius, state = solution.x, solution.y
    return float(state[0, 0])


def _equations(load: float, patch: float) -> Callable[[Floats, Floats], Floats]:
    """The right-hand side of the equations: derivatives of (w, w', w'', u, u') by the radius."""

    def derivatives(r: Floats, y: Floats) -> Floats:
        _, slope, curvature, u, stretch = y
        shear = load / (2.0 * np.pi * r) * np.minimum(r / patch, 1.0) ** 2
        membrane = stretch + POISSON * u / r + slope**2 / 2.0
        third = -curvature / r + slope / r**2 + 12.0 * slope * membrane + 12.0 * (1.0 - POISSON**2) * shear
        second = -stretch / r + u / r**2 - (1.0 - POISSON) / (2.0 * r) * slope**2 - slope * curvature
        return np.array([slope, curvature, third, stretch, second])

    return derivatives


def _edges(centre: Floats, edge: Floats) -> Floats:
    """Residuals of the boundary conditions: smooth at the centre (w' and u linear in r), clamped at the edge."""
    return np.array([centre[1] - START * centre[2], centre[3] - START * centre[4], edge[0], edge[1], edge[3]])
