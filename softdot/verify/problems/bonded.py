"""Layers bonded between rigid plates, nearly incompressible: apparent modulus without volumetric locking."""

from collections.abc import Callable

import numpy as np
from scipy.special import iv

from foundation.arrays import Floats
from softdot.verify.body import solid_body
from softdot.verify.lattice import Grid, disc, graded_coordinates, grid
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, bulk_modulus

YOUNG_MPA = 5.0
STRAIN = 1e-4


def neo_hookean_rubber(poisson_ratio: float) -> InvariantLaw:
    """A neo-Hookean law with Young's modulus YOUNG_MPA."""
    shear = YOUNG_MPA / (2.0 * (1.0 + poisson_ratio))
    return InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk_modulus(shear, poisson_ratio))


def apparent_modulus(
    shape: Grid, law: InvariantLaw, area: float, half_height: float, hold: Callable[[Floats], None]
) -> float:
    """Apparent modulus, MPa, of the upper half of a bonded layer, symmetric at z = 0. hold : sets further supports."""
    body = solid_body(shape.points, law, shape.tets)
    prescribed = body.free_displacements()
    hold(prescribed)
    prescribed[shape.points[:, 2] == 0.0, 2] = 0.0
    top = np.flatnonzero(shape.points[:, 2] == half_height)
    prescribed[top] = 0.0, 0.0, -STRAIN * half_height
    body.solve(prescribed)
    return -float(body.reaction(top)[2]) / area / STRAIN


def strip_modulus(half_width: float, height: float, poisson_ratio: float, n: int = 4) -> float:
    """Apparent modulus, MPa, of a long strip without strain in y; elements shrink towards the edge."""
    layer = height / 2
    x = half_width - graded_coordinates(0.0, half_width, layer / (2 * n), min(layer, half_width / n))[::-1]
    z = layer - graded_coordinates(0.0, layer, layer / (2 * n), layer / n)[::-1]
    shape = grid((x, [0.0, layer / n], z))

    def hold(prescribed: Floats) -> None:
        prescribed[:, 1] = np.where(np.isin(shape.points[:, 1], (0.0, layer / n)), 0.0, np.nan)
        prescribed[shape.points[:, 0] == 0.0, 0] = 0.0

    return apparent_modulus(shape, neo_hookean_rubber(poisson_ratio), half_width * layer / n, layer, hold)


def disc_modulus(radius: float, height: float, poisson_ratio: float, n: int = 3) -> float:
    """Apparent modulus, MPa, of a disc, of which a quarter is meshed."""
    layer = height / 2
    r = radius - graded_coordinates(0.0, radius, layer / (2 * n), min(layer, radius / n))[::-1]
    shape = disc(
        r, np.linspace(0.0, np.pi / 2, 5), layer - graded_coordinates(0.0, layer, layer / (2 * n), layer / n)[::-1]
    )

    def hold(prescribed: Floats) -> None:
        for axis in range(2):
            prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0

    return apparent_modulus(shape, neo_hookean_rubber(poisson_ratio), np.pi * radius**2 / 4, layer, hold)


def strip_formula(half_width: float, height: float, poisson_ratio: float) -> float:
    """Apparent modulus of a strip, E_c = M - (l^2 / M) tanh(q) / q, with q = sqrt(12 G / M) b / h, M = K + 4 G / 3 and
    l = K - 2 G / 3.

    A parabola u over the height in the balance M u'' = 12 G u / h^2 of a compressed layer, no lateral stress at the
    edge. Its limits: 4 G + K (1 - tanh(q) / q) for K >> G, 4/3 E (1 + S^2) incompressible, M for S -> infinity.
    """
    shear, m, lame = _moduli(poisson_ratio)
    q = np.sqrt(12.0 * shear / m) * half_width / height
    return float(m - lame**2 / m * np.tanh(q) / q)


def disc_formula(radius: float, height: float, poisson_ratio: float) -> float:
    """Apparent modulus of a disc, E_c = M - 2 l^2 I1(q) / (M q I0(q) - 2 G I1(q)), q = sqrt(12 G / M) R / h.

    The balance of strip_formula in the radius. Its limits: 3 G + K [1 - 2 I1 / (q I0)] for K >> G, E (1 + 2 S^2)
    incompressible, E for S -> 0.
    """
    shear, m, lame = _moduli(poisson_ratio)
    q = np.sqrt(12.0 * shear / m) * radius / height
    return float(m - 2.0 * lame**2 * iv(1, q) / (m * q * iv(0, q) - 2.0 * shear * iv(1, q)))


def gent_and_lindley(shape_factor: float, poisson_ratio: float) -> float:
    """Apparent modulus of a disc, E_a = E (1 + 2 S^2), with the bulk in series: 1 / E_a' = 1 / E_a + 1 / K."""
    bulk = YOUNG_MPA / (3.0 * (1.0 - 2.0 * poisson_ratio))
    return 1.0 / (1.0 / (YOUNG_MPA * (1.0 + 2.0 * shape_factor**2)) + 1.0 / bulk)


def _moduli(poisson_ratio: float) -> tuple[float, float, float]:
    """Shear modulus, confined modulus and Lame's first constant, MPa."""
    shear = YOUNG_MPA / (2.0 * (1.0 + poisson_ratio))
    bulk = YOUNG_MPA / (3.0 * (1.0 - 2.0 * poisson_ratio))
    return shear, bulk + 4.0 * shear / 3.0, bulk - 2.0 * shear / 3.0


PROBLEMS = (
    Problem(
        name="bonded-disc",
        title="Rubber disc bonded between plates, shape factor 4, ν = 0.4999, apparent modulus",
        source="Gent and Lindley, Proc. Inst. Mech. Eng. 173, 1959, p. 111: E (1 + 2 S²) with the bulk in series",
        unit="MPa",
        bound_percent=5.0,
        basis="the parabolic profile of a thin layer leaves out its edge, of order 1/S² = 6 %",
        reference=lambda: gent_and_lindley(4.0, 0.4999),
        solve=lambda n: disc_modulus(8.0, 1.0, 0.4999, n),
        meshes=(2, 3),
    ),
    Problem(
        name="bonded-strip",
        title="Rubber strip bonded between plates, shape factor 8, ν = 0.4999, apparent modulus",
        source="Gent and Meinecke, Polym. Eng. Sci. 10, 1970, p. 48, with compressibility: E_c = M - l²/M tanh(q)/q",
        unit="MPa",
        bound_percent=3.0,
        basis="the parabolic profile of a thin layer leaves out its edge, of order 1/S² = 1.6 %, and the mesh's corner",
        reference=lambda: strip_formula(8.0, 1.0, 0.4999),
        solve=lambda n: strip_modulus(8.0, 1.0, 0.4999, n),
        meshes=(2, 4),
    ),
)
