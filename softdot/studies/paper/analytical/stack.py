"""Medium 1 and film of the paper as layers of a beam."""

from softdot.studies.paper.analytical.composite import Lamina
from softdot.studies.paper.segment import E1_MPA

FILM = Lamina(thickness_m=28e-6, modulus_Pa=2e9)


H1_MM = (0.5, 0.8, 2.0, 4.0)
"""Every thickness of medium 1 in the paper."""


def medium1(h1_mm: float) -> Lamina:
    """Medium 1 of a thickness."""
    return Lamina(1e-3 * h1_mm, 1e6 * E1_MPA)


def stiffness_ratio(h1_mm: float) -> float:
    """In-plane stiffness of the film over that of medium 1."""
    return FILM.membrane_stiffness_N_per_m / medium1(h1_mm).membrane_stiffness_N_per_m
