"""Layers bonded between rigid plates at other ratios and shapes than those of softdot verify."""

import pytest

from softdot.verify.problems.bonded import disc_formula, disc_modulus, strip_formula, strip_modulus
from tests.cases import for_each
from tests.verification.row import agrees

RATIOS = (0.45, 0.49, 0.495, 0.499)


@pytest.mark.press
@for_each("poisson_ratio", RATIOS)
def test_thin_bonded_strip(poisson_ratio):
    """16 x 1 mm, S = 8."""
    ours = strip_modulus(8.0, 1.0, poisson_ratio)
    agrees(f"bonded strip S 8, nu {poisson_ratio}", ours, strip_formula(8.0, 1.0, poisson_ratio), 0.05)


@pytest.mark.press
@for_each(("poisson_ratio", "reference"), [(0.495, 114.0), (0.499, 272.0), (0.4999, 409.0)])
def test_thin_bonded_strip_by_the_formula_for_rubber(poisson_ratio, reference):
    """4 G + K (1 - tanh(q) / q), q = sqrt(12 G / K) b / h, for K >> G: below nu = 0.495 it exceeds the confined M."""
    agrees(f"bonded strip S 8, nu {poisson_ratio}, K >> G", strip_modulus(8.0, 1.0, poisson_ratio), reference, 0.05)


@pytest.mark.press
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
