"""Split beams of two arms, depth h each: the closed forms of the two standard delamination tests.

Plane strain, E' = E / (1 - nu^2), per unit width, small displacements.
"""

import numpy as np
import pytest

from mesh.interfaces import interface_facets, split_interface
from solve.materials.laws import InvariantLaw
from solve.terms.unilateral_interface import opening_nodes, unilateral_interface
from tests.solve.term_body import TermBody, layers

E, NU = 1.0, 0.3
G = E / (2.0 * (1.0 + NU))
PLANE = E / (1.0 - NU**2)
LAW = InvariantLaw(0.5 * G, 0.0, 0.0, 0.0, E / (3.0 * (1.0 - 2.0 * NU)))
H, WIDTH, LENGTH = 1.0, 0.5, 20.0
LOAD = 1e-6


def split_beam(crack: float):
    """A slice of two arms, z from 0 to 2 h, split for 0 <= x < crack; the crack's tip is a column of nodes."""
    tet_mesh = layers(
        np.linspace(0.0, LENGTH, 41), [0.0, WIDTH], [np.linspace(0.0, H, 3), np.linspace(H, 2.0 * H, 3)], is_slice=True
    )
    facets = interface_facets(tet_mesh, "bond-film-medium2")
    inside = tet_mesh.points_mm[facets, 0].max(axis=1) <= crack
    split, lower, upper = split_interface(tet_mesh, "bond-film-medium2", ~inside)
    body = TermBody(split, {"medium2": LAW, "film": LAW})
    multipliers = body.unknowns(opening_nodes(lower[inside], upper[inside], body.dofs)[1])
    patch = unilateral_interface(body.points, lower[inside], upper[inside], body.dofs, multipliers)
    body.terms.append(patch)
    fixed = np.zeros(body.points.shape, bool)
    fixed[:, 1] = True
    return body, patch, fixed


def line(body, x: float, z: float) -> np.ndarray:
    return np.flatnonzero((np.abs(body.points[:, 0] - x) < 1e-9) & (np.abs(body.points[:, 2] - z) < 1e-9))


@pytest.mark.press
def test_arms_pulled_apart_open_as_cantilevers():
    """Double cantilever beam: opening 8 P (a + chi h)^3 / (E' h^3) at its ends, with the compliance of the root
    chi^2 = E' / (11 G) (3 - 2 (q / (1 + q))^2), q = 1.18 E' / G (Williams, Eng. Fract. Mech. 33, 1989).
    Within 5 %, the accuracy of beam theory.
    """
    crack = 10.0
    body, _, fixed = split_beam(crack)
    fixed[np.abs(body.points[:, 0] - LENGTH) < 1e-9] = True
    load = np.zeros(body.points.shape)
    ends = line(body, 0.0, 0.0), line(body, 0.0, 2.0 * H)
    for nodes, sign in zip(ends, (-1.0, 1.0), strict=True):
        load[nodes, 2] = sign * LOAD * WIDTH / len(nodes)
    u = body.solve(fixed, 0.0, load).displacement[:, 2]
    q = 1.18 * PLANE / G
    chi = np.sqrt(PLANE / (11.0 * G) * (3.0 - 2.0 * (q / (1.0 + q)) ** 2))
    expected = 8.0 * LOAD * (crack + chi * H) ** 3 / (PLANE * H**3)
    assert u[ends[1][0]] - u[ends[0][0]] == pytest.approx(expected, rel=0.05)


def test_arms_pressed_together_bend_as_two_beams_on_one_another():
    """End-notched flexure of half span L sinks by P (s + 2 (1.2 L + 0.9 a) h^2 E' / G) / (8 E' h^3), s = 2 L^3 + 3 a^3,
    under the load (Carlsson, Gillespie and Pipes, J. Compos. Mater. 20, 1986), and a quarter of the load crosses the
    crack, since arms of equal curvature carry equal shares. Within 5 %, the accuracy of beam theory.
    """
    crack, half = 7.0, LENGTH / 2.0
    body, patch, fixed = split_beam(crack)
    supports, top = (line(body, x, 0.0) for x in (0.0, LENGTH)), line(body, half, 2.0 * H)
    for nodes in supports:
        fixed[nodes, 2] = True
    fixed[line(body, half, H), 0] = True
    load = np.zeros(body.points.shape)
    load[top, 2] = -LOAD * WIDTH / len(top)
    state = body.solve(fixed, 0.0, load)
    cubes = 2.0 * half**3 + 3.0 * crack**3
    shear = 2.0 * (1.2 * half + 0.9 * crack) * H**2 * PLANE / G
    expected = LOAD * (cubes + shear) / (8.0 * PLANE * H**3)
    middle = -state.displacement[line(body, half, H), 2].mean()
    assert middle == pytest.approx(expected, rel=0.05)
    across = np.vdot(state.x[patch.multipliers], patch.nodal_area) / WIDTH
    assert across == pytest.approx(LOAD / 4.0, rel=0.05)
    assert state.x[patch.multipliers].min() >= 0.0
