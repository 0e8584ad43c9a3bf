"""Thin and thick plates and a membrane of solid elements against the theories of thin bodies."""

import numpy as np

from foundation.arrays import Floats
from softdot.verify.body import solid_body
from softdot.verify.lattice import Grid, disc, graded_coordinates, grid
from softdot.verify.loads import traction_force
from softdot.verify.problem import Problem
from softdot.verify.von_karman import centre_deflection
from solve.materials.laws import LinearLaw, bulk_modulus

THIN, THICK = 0.02, 0.2  # of the plates of radius 1
POISSON = 0.3
SMALL_PRESSURE = 1e-6
"""Pressure over E at which the answer is linear."""
STRIP_LENGTH, STRIP_WIDTH, STRIP_THICKNESS, STRIP_DEFLECTION = 1.0, 0.02, 5e-4, 0.05
"""Length, width, thickness and deflection of the strip."""
NON_LINEAR_LOAD = 27.0
"""Load F a^2 / (E t^4) whose deflection is about the thickness."""


def hooke(poisson_ratio: float) -> LinearLaw:
    """The linear law with E = 1."""
    shear = 0.5 / (1.0 + poisson_ratio)
    return LinearLaw(shear, bulk_modulus(shear, poisson_ratio))


def deflection(shape: Grid, thickness: float, patch: float, force: float, steps: int = 3) -> float:
    """Deflection at the centre of a clamped quarter of a disc under a force that is spread over r < patch."""
    body = solid_body(shape.points, hooke(POISSON), shape.tets)
    prescribed = body.free_displacements()
    radius = np.hypot(shape.points[:, 0], shape.points[:, 1])
    prescribed[radius > 1.0 - 1e-9] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    top = shape.facets(lambda x: (x[:, 2] == thickness) & (np.hypot(x[:, 0], x[:, 1]) < patch + 1e-9))
    load = traction_force(shape.points, top, [0.0, 0.0, 1.0])
    body.solve(prescribed, 0.25 * force / load.sum() * load, steps=steps, tolerance=1e-6)
    return float(body.u[radius < 1e-9, 2].mean())


def quarter_disc(middle: Floats, heights: Floats) -> Grid:
    """The mesh of a quarter of a disc, finer towards its edge from r = 0.85."""
    return disc(np.append(middle, [0.9, 0.94, 0.97, 1.0]), np.linspace(0.0, np.pi / 2, 11), heights)


def thin_plate(load: float = NON_LINEAR_LOAD, patch: float = 1.0) -> float:
    """Deflection of a thin plate over its thickness under a pressure on r < patch; load = F a^2 / (E t^4)."""
    middle = (
        np.linspace(0.0, 0.85, 12) if patch == 1.0 else np.append(0.0, graded_coordinates(patch, 0.85, patch, 0.08))
    )
    shape = quarter_disc(middle, np.array([0.0, THIN]))
    return deflection(shape, THIN, patch, load * THIN**4) / THIN


def thick_plate(n: int) -> float:
    """Deflection by the force of a pressure of 1 on the disc, times E, with n elements through the thickness."""
    shape = quarter_disc(np.linspace(0.0, 0.85, 3 * n + 1), np.linspace(0.0, THICK, n + 1))
    return deflection(shape, THICK, 1.0, SMALL_PRESSURE * np.pi, steps=1) / SMALL_PRESSURE


def thick_plate_by_reissner() -> float:
    """Deflection of the thick plate by Reissner's theory: q a^4 / (64 D) + q a^2 / (4 k G t), k = 5/6."""
    stiffness = THICK**3 / (12.0 * (1.0 - POISSON**2))
    shear = 0.5 / (1.0 + POISSON)
    return 1.0 / (64.0 * stiffness) + 1.0 / (4.0 * 5.0 / 6.0 * shear * THICK)


def strip_force() -> float:
    """Force of a line across the middle of a clamped strip that it deflects, over E; nu = 0, no strain across."""
    half = STRIP_LENGTH / 2
    x = graded_coordinates(0.0, half / 2, 0.001, 0.03)
    x = np.concatenate([x, half - x[-2::-1]])
    shape = grid((x, [0.0, STRIP_WIDTH], [0.0, STRIP_THICKNESS]))
    body = solid_body(shape.points, hooke(0.0), shape.tets)
    prescribed = body.free_displacements()
    prescribed[:, 1] = np.where(np.isin(shape.points[:, 1], (0.0, STRIP_WIDTH)), 0.0, np.nan)
    prescribed[shape.points[:, 0] == 0.0] = 0.0
    middle = np.flatnonzero(shape.points[:, 0] == half)
    prescribed[middle, 0] = 0.0
    prescribed[middle, 2] = STRIP_DEFLECTION
    body.solve(prescribed, steps=25, tolerance=1e-8)
    return 2.0 * float(body.reaction(middle)[2])


def strip_force_by_membrane() -> float:
    """Force of the line over E by membrane theory: 8 E A (d / l)^3, l between the ends of the boundary layers.

    A strip under tension N bends at each clamp and under the line within sqrt(E I / N), as a beam under tension does: d
    = V / N (l/2 - 2 sqrt(E I / N)); the strain 2 (d / l)^2 of the straight part makes N.
    """
    area, half = STRIP_WIDTH * STRIP_THICKNESS, STRIP_LENGTH / 2
    layer = 0.0
    for _ in range(20):
        slope = STRIP_DEFLECTION / (half - 2.0 * layer)
        strain = 0.5 * slope**2 * (half - 2.0 * layer) / half + _layer_stretch(slope, layer, half)
        layer = STRIP_THICKNESS / np.sqrt(12.0 * strain)
    return float(2.0 * area * strain * slope)


def _layer_stretch(slope: float, layer: float, half: float) -> float:
    """Share of the boundary layers in the mean of w'^2 / 2, w' = slope (1 - exp(-x / layer)) at both ends of a half."""
    return 0.5 * slope**2 * (2.0 * layer - 2.0 * 1.5 * layer) / half


PROBLEMS = (
    Problem(
        name="thick-plate",
        title="Thick clamped disc under pressure, thickness a fifth of the radius, deflection times E over pressure",
        source="Reissner, J. Appl. Mech. 12, 1945, p. A69; Timoshenko and Woinowsky-Krieger, 1959, sec. 20",
        unit="1",
        bound_percent=4.0,
        basis="the theory leaves out terms of the square of thickness over radius, 4 %, such as the layer at the edge",
        reference=thick_plate_by_reissner,
        solve=thick_plate,
        meshes=(1, 2),
    ),
    Problem(
        name="plate-large-deflection",
        title="Clamped disc under pressure, deflection over thickness about 1",
        source="von Kármán's equations (Timoshenko and Woinowsky-Krieger, 1959, eq. 231), solved by SciPy's solve_bvp",
        unit="1",
        bound_percent=1.0,
        basis="shear, which the theory leaves out, is 0.2 % at this thickness; 15 elements along the radius",
        reference=lambda: centre_deflection(NON_LINEAR_LOAD, 1.0),
        solve=thin_plate,
    ),
    Problem(
        name="clamped-membrane",
        title="Clamped strip deflected by a line across its middle, force over E",
        source="membrane 8 E A (d/l)³ with boundary layers √(EI/N) at clamps and line (Timoshenko, 1959, sec. 2)",
        unit="1",
        bound_percent=1.0,
        basis="the square of the boundary layer over the half length is 0.01 %, large slope 0.5 %; graded mesh",
        reference=strip_force_by_membrane,
        solve=strip_force,
    ),
)
