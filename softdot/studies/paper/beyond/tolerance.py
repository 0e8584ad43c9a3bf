"""What making a segment does to a design: thicknesses and moduli off their nominal values."""

from dataclasses import replace

import numpy as np

from foundation.arrays import Floats
from softdot.studies.paper.beyond.designs import Design
from softdot.studies.paper.beyond.search import capacitance_pF
from softdot.studies.paper.beyond.surrogate import Surrogate

MODULUS_SPREAD, THICKNESS_SPREAD = 0.15, 0.05
"""Standard deviations: castable silicones within 30 %, half a millimetre of cast sheet within 0.05 mm, at two sigma."""
COPIES = 400


def draw_copies(design: Design, copies: int, seed: int) -> list[Design]:
    """Draw copies of a design as they would come out; the same seed errs alike for every design. The film is bought."""
    luck = np.random.default_rng(seed).standard_normal((copies, 6))
    spread = [THICKNESS_SPREAD, MODULUS_SPREAD] * 3
    factors = np.exp(luck * spread)
    names = ("h1_mm", "e1_MPa", "h2_mm", "e2_MPa", "effector_height_mm", "effector_MPa")
    nominal = np.array([getattr(design, name) for name in names])
    return [replace(design, **dict(zip(names, map(float, row), strict=True))) for row in factors * nominal]


def made_worse_V(surrogate: Surrogate, design: Design, cable_pF: float = 0.0) -> Floats:
    """Worse voltage (COPIES,) of the copies by the surrogate, with its own uncertainty; the k-th err alike."""
    copies = draw_copies(design, COPIES, seed=0)
    guess = surrogate.draw(copies, COPIES, seed=1)
    worse = (guess.charge_pC / (capacitance_pF(copies) + cable_pF)).min(axis=0)
    one_draw_each: Floats = np.diagonal(worse)
    return one_draw_each
