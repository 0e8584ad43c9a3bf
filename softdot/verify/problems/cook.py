"""Cook's membrane in plane strain at finite strain, nearly incompressible, as a slice of one element."""

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.verify.body import ElasticBody, solid_body
from softdot.verify.lattice import Grid, grid
from softdot.verify.loads import traction_force
from softdot.verify.other_codes import reference
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, MediumLaw

TRACTION = 6.25  # upwards on the right edge
THICKNESS = 4.0
"""Thickness of the slice in y, mm."""
SHEAR, BULK = 80.194, 400889.8
"""Shear and bulk modulus, MPa."""


def panel_points(p: Floats) -> Floats:
    """Points of the unit square in the panel with corners (0, 0), (48, 44), (48, 60) and (0, 44) in x and z, mm."""
    s, y, t = p.T
    return np.column_stack([48.0 * s, y, 44.0 * s + t * (44.0 - 28.0 * s)])


def panel_mesh(n: int) -> Grid:
    """The mesh of the panel with n elements a side."""
    edge = np.linspace(0.0, 1.0, n + 1)
    return grid((edge, [0.0, THICKNESS], edge), panel_points)


def first_twins(shape: Grid) -> Ints:
    """The first node with the x and z of each node, (n,)."""
    _, first, same = np.unique(np.round(shape.points[:, [0, 2]], 9), axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[same.ravel()])


def slice_of(shape: Grid, law: MediumLaw, tied: bool) -> tuple[ElasticBody, Floats]:
    """The body and its prescribed displacements: without strain in y, by twins or by holding the two faces only."""
    body = solid_body(shape.points, law, shape.tets, first_twins(shape) if tied else None)
    prescribed = body.free_displacements()
    faces = (shape.points[:, 1] == 0.0) | (shape.points[:, 1] == THICKNESS)
    prescribed[faces | tied, 1] = 0.0
    prescribed[shape.points[:, 0] == 0.0] = 0.0
    return body, prescribed


def corner_rise(n: int, law: MediumLaw, tied: bool = True, traction: float = TRACTION) -> float:
    """Rise, mm, of the upper right corner, with n elements a side."""
    shape = panel_mesh(n)
    body, prescribed = slice_of(shape, law, tied)
    edge = shape.facets(lambda x: x[:, 0] > 48.0 - 1e-9)
    body.solve(prescribed, traction_force(shape.points, edge, [0.0, 0.0, traction]), steps=4, tolerance=1e-8)
    corner = (shape.points[:, 0] > 48.0 - 1e-9) & (shape.points[:, 2] > 60.0 - 1e-9)
    return float(body.u[corner, 2].mean())


def neo_hookean_law(shear: float, bulk: float) -> InvariantLaw:
    """A neo-Hookean law with the moduli, MPa."""
    return InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk)


PROBLEMS = (
    Problem(
        name="cook",
        title="Cook's membrane at finite strain, ν = 0.4999, rise of the upper right corner",
        source="Simo and Armero, Int. J. Numer. Meth. Eng. 33, 1992, p. 1413; " + reference("cook").source,
        unit="mm",
        bound_percent=1.0,
        basis="singular corner at the clamp, below first order: as much again as 24 elements change those of 12",
        reference=lambda: reference("cook").value,
        solve=lambda n: corner_rise(n, neo_hookean_law(SHEAR, BULK)),
        meshes=(12, 24),
        limit=True,
    ),
)
