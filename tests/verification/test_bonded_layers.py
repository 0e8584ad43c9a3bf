"""Layers bonded between rigid plates: apparent compression modulus without volumetric locking."""

import numpy as np
from scipy.special import iv

from solve.materials.laws import InvariantLaw, bulk_modulus
from tests.cases import for_each
from tests.verification.body import solid_body
from tests.verification.lattice import disc, graded, grid
from tests.verification.row import agrees

YOUNG = 5.0
STRAIN = 1e-4
RATIOS = (0.45, 0.49, 0.495, 0.499, 0.4999)


def rubber(poisson_ratio: float) -> InvariantLaw:
    shear = YOUNG / (2.0 * (1.0 + poisson_ratio))
    return InvariantLaw(shear / 2.0, 0.0, 0.0, 0.0, bulk_modulus(shear, poisson_ratio))


def compress(shape, law, area: float, half_height: float, held) -> float:
    """Apparent modulus of the upper half of a layer: bonded on top, symmetric at z = 0."""
    body = solid_body(shape.points, law, shape.tets)
    prescribed = body.free()
    held(prescribed)
    prescribed[shape.points[:, 2] == 0.0, 2] = 0.0
    top = np.flatnonzero(shape.points[:, 2] == half_height)
    prescribed[top] = 0.0, 0.0, -STRAIN * half_height
    body.solve(prescribed)
    return -body.reaction(top)[2] / area / STRAIN


def strip_modulus(half_width: float, height: float, poisson_ratio: float, n: int = 4) -> float:
    """A long strip, one element in y without strain there; elements shrink towards the edge."""
    layer = height / 2
    x = half_width - graded(0.0, half_width, layer / (2 * n), min(layer, half_width / n))[::-1]
    z = layer - graded(0.0, layer, layer / (2 * n), layer / n)[::-1]
    shape = grid((x, [0.0, layer / n], z))

    def held(prescribed):
        prescribed[:, 1] = np.where(np.isin(shape.points[:, 1], (0.0, layer / n)), 0.0, np.nan)
        prescribed[shape.points[:, 0] == 0.0, 0] = 0.0

    return compress(shape, rubber(poisson_ratio), half_width * layer / n, layer, held)


def disc_modulus(radius: float, height: float, poisson_ratio: float, n: int = 3) -> float:
    layer = height / 2
    r = radius - graded(0.0, radius, layer / (2 * n), min(layer, radius / n))[::-1]
    shape = disc(r, np.linspace(0.0, np.pi / 2, 5), layer - graded(0.0, layer, layer / (2 * n), layer / n)[::-1])

    def held(prescribed):
        for axis in range(2):
            prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0

    return compress(shape, rubber(poisson_ratio), np.pi * radius**2 / 4, layer, held)


def strip_formula(half_width: float, height: float, poisson_ratio: float) -> float:
    """E_c = M - (l^2 / M) tanh(q) / q with q = sqrt(12 G / M) b / h, M = K + 4 G / 3, l = K - 2 G / 3.

    A parabola u over the height in the balance M u'' = 12 G u / h^2 of a compressed layer, no lateral stress at the
    edge. Its limits: 4 G + K (1 - tanh(q) / q) for K >> G, 4/3 E (1 + S^2) incompressible, M for S -> infinity.
    """
    shear, m, lame = _moduli(poisson_ratio)
    q = np.sqrt(12.0 * shear / m) * half_width / height
    return m - lame**2 / m * np.tanh(q) / q


def disc_formula(radius: float, height: float, poisson_ratio: float) -> float:
    """E_c = M - 2 l^2 I1(q) / (M q I0(q) - 2 G I1(q)), q = sqrt(12 G / M) R / h: the same balance in the radius.

    Its limits: 3 G + K [1 - 2 I1 / (q I0)] for K >> G, E (1 + 2 S^2) incompressible, E for S -> 0.
    """
    shear, m, lame = _moduli(poisson_ratio)
    q = np.sqrt(12.0 * shear / m) * radius / height
    return m - 2.0 * lame**2 * iv(1, q) / (m * q * iv(0, q) - 2.0 * shear * iv(1, q))


def _moduli(poisson_ratio: float) -> tuple[float, float, float]:
    """G, confined modulus, Lame's first constant."""
    law = rubber(poisson_ratio)
    shear, bulk = law.shear_modulus, law.bulk_modulus
    return shear, bulk + 4.0 * shear / 3.0, bulk - 2.0 * shear / 3.0


@for_each("poisson_ratio", RATIOS)
def test_thin_bonded_strip(poisson_ratio):
    """16 x 1 mm, S = 8."""
    ours = strip_modulus(8.0, 1.0, poisson_ratio)
    agrees(f"bonded strip S 8, nu {poisson_ratio}", ours, strip_formula(8.0, 1.0, poisson_ratio), 0.05)


@for_each(("poisson_ratio", "reference"), [(0.495, 114.0), (0.499, 272.0), (0.4999, 409.0)])
def test_thin_bonded_strip_by_the_formula_for_rubber(poisson_ratio, reference):
    """4 G + K (1 - tanh(q) / q), q = sqrt(12 G / K) b / h, for K >> G: below nu = 0.495 it exceeds the confined M."""
    agrees(f"bonded strip S 8, nu {poisson_ratio}, K >> G", strip_modulus(8.0, 1.0, poisson_ratio), reference, 0.05)


@for_each("poisson_ratio", RATIOS)
def test_thin_bonded_disc(poisson_ratio):
    """Diameter 32, height 1: S = R / (2 h) = 8."""
    ours = disc_modulus(16.0, 1.0, poisson_ratio)
    agrees(f"bonded disc S 8, nu {poisson_ratio}", ours, disc_formula(16.0, 1.0, poisson_ratio), 0.05)


@for_each("poisson_ratio", RATIOS)
@for_each("height", [2.0, 0.8], ids=["S 0.625", "S 1.56"])
def test_blocky_bonded_strip(height, poisson_ratio):
    """2.5 mm wide: below S = 2 edges matter, and the thin-layer formula is good to some 10 %."""
    ours = strip_modulus(1.25, height, poisson_ratio)
    agrees(f"bonded strip {height} high, nu {poisson_ratio}", ours, strip_formula(1.25, height, poisson_ratio), 0.1)


@for_each("height", [2.0, 0.8], ids=["S 0.625", "S 1.56"])
def test_a_coarse_bonded_strip_does_not_lock(height):
    coarse, fine = (strip_modulus(1.25, height, 0.4999, n) for n in (2, 6))
    agrees(f"bonded strip {height} high, nu 0.4999, coarse against fine", coarse, fine, 0.01)


def test_gent_and_lindley_disc():
    """E_a = E (1 + 2 S^2), S = 4, and the bulk in series: 1 / E_a' = 1 / E_a + 1 / K."""
    reference = 1.0 / (1.0 / (YOUNG * (1.0 + 2.0 * 4.0**2)) + 1.0 / rubber(0.4999).bulk_modulus)
    agrees("Gent-Lindley disc S 4", disc_modulus(8.0, 1.0, 0.4999), reference, 0.05)
