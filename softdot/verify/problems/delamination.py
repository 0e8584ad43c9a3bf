"""Split beams of two arms, depth h each, that open or stay closed: the two standard delamination tests. Plane strain,
E' = E / (1 - nu^2), per unit width, small displacements.
"""

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from softdot.verify.body import ElasticBody, solid_body
from softdot.verify.lattice import grid
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw
from solve.terms.unilateral_interface import UnilateralInterface, opening_nodes, unilateral_interface

YOUNG, POISSON = 1.0, 0.3
"""Elastic constants of the beam; lengths are in depths of an arm."""
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
PLANE = YOUNG / (1.0 - POISSON**2)
LAW = InvariantLaw(0.5 * SHEAR, 0.0, 0.0, 0.0, YOUNG / (3.0 * (1.0 - 2.0 * POISSON)))
DEPTH, WIDTH, LENGTH = 1.0, 0.5, 20.0
"""Depth of an arm, width and length of the beam."""
OPEN_CRACK, CLOSED_CRACK = 10.0, 7.0
"""Lengths of the crack in the two tests."""
LOAD = 1e-6


def split_beam(crack: float) -> tuple[ElasticBody, UnilateralInterface, Floats]:
    """Beam of two arms, the patch at z = h and 0 <= x < crack where they are apart, and prescribed displacements
    (n, 3).
    """
    z = np.linspace(0.0, 2.0 * DEPTH, 5)
    shape = grid((np.linspace(0.0, LENGTH, 41), [0.0, WIDTH], z))
    points, tets = shape.points, shape.tets.copy()
    above = shape.centres[:, 2] > DEPTH
    inside = np.flatnonzero((np.abs(points[:, 2] - DEPTH) < 1e-9) & (points[:, 0] < crack - 1e-9))
    twin = np.arange(len(points))
    twin[inside] = len(points) + np.arange(len(inside))
    lower = _facets_at(points, shape.tets[~above], crack)
    tets[above] = twin[tets[above]]
    body = solid_body(np.vstack([points, points[inside]]), LAW, tets)
    upper = twin[lower]
    multipliers = body.add_unknowns(opening_nodes(lower, upper, body.displacement)[1])
    patch = unilateral_interface(body.points, lower, upper, body.displacement, multipliers)
    body.terms.append(patch)
    prescribed = body.free_displacements()
    prescribed[:, 1] = 0.0
    return body, patch, prescribed


def _facets_at(points: Floats, tets: Ints, crack: float) -> Ints:
    """Facets (k, 6) of the lower arm at z = h within the crack, normal up."""
    from softdot.verify.lattice import FACE_NODES

    facets = tets[:, FACE_NODES].reshape(-1, 6)
    at = points[facets]
    return facets[((np.abs(at[..., 2] - DEPTH) < 1e-9) & (at[..., 0] < crack + 1e-9)).all(axis=1)]


def _nodes_on_line(body: ElasticBody, x: float, z: float) -> Bools:
    """Whether each node lies on the line along y at (x, z)."""
    return np.asarray((np.abs(body.points[:, 0] - x) < 1e-9) & (np.abs(body.points[:, 2] - z) < 1e-9))


def arm_opening() -> float:
    """Opening of the ends of the arms under forces that part them, over the force per width."""
    body, _, prescribed = split_beam(OPEN_CRACK)
    prescribed[np.abs(body.points[:, 0] - LENGTH) < 1e-9] = 0.0
    load = np.zeros(body.points.shape)
    ends = _nodes_on_line(body, 0.0, 0.0), _nodes_on_line(body, 0.0, 2.0 * DEPTH)
    for nodes, sign in zip(ends, (-1.0, 1.0), strict=True):
        load[nodes, 2] = sign * LOAD * WIDTH / nodes.sum()
    body.solve(prescribed, load, tolerance=1e-8)
    return float(body.u[ends[1], 2].mean() - body.u[ends[0], 2].mean()) / LOAD


def arm_opening_by_beams() -> float:
    """The opening by beam theory, 8 (a + chi h)^3 / (E' h^3), with the compliance of the root chi (Williams 1989)."""
    q = 1.18 * PLANE / SHEAR
    chi = np.sqrt(PLANE / (11.0 * SHEAR) * (3.0 - 2.0 * (q / (1.0 + q)) ** 2))
    return float(8.0 * (OPEN_CRACK + chi * DEPTH) ** 3 / (PLANE * DEPTH**3))


def load_share_across() -> float:
    """Share of the load that the closed patch carries from arm to arm while the beam is bent on three points."""
    body, patch, prescribed = split_beam(CLOSED_CRACK)
    half = LENGTH / 2.0
    for x in (0.0, LENGTH):
        prescribed[_nodes_on_line(body, x, 0.0), 2] = 0.0
    prescribed[_nodes_on_line(body, half, DEPTH), 0] = 0.0
    top = _nodes_on_line(body, half, 2.0 * DEPTH)
    load = np.zeros(body.points.shape)
    load[top, 2] = -LOAD * WIDTH / top.sum()
    body.solve(prescribed, load, tolerance=1e-8)
    return float(np.vdot(body.x[patch.multipliers], patch.nodal_area)) / (LOAD * WIDTH)


PROBLEMS = (
    Problem(
        name="delaminated-open",
        title="Split beam whose arms are pulled apart, opening times E over force per width",
        source="double cantilever beam with the compliance of its root (Williams, Eng. Fract. Mech. 33, 1989, p. 535)",
        unit="1",
        bound_percent=5.0,
        basis="beam theory of arms ten times as long as deep, with a fitted root: 3 % in its source",
        reference=arm_opening_by_beams,
        solve=arm_opening,
    ),
    Problem(
        name="delaminated-closed",
        title="Split beam bent on three points, share of the load that the loose patch carries from arm to arm",
        source="end-notched flexure (Carlsson, Gillespie and Pipes, J. Compos. Mater. 20, 1986): arms of one curvature",
        unit="1",
        bound_percent=5.0,
        basis="beam theory leaves out the depth over the crack's length, squared: 2 %, and the mesh's support",
        reference=lambda: 0.25,
        solve=load_share_across,
    ),
)
