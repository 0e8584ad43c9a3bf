"""The acrylic beam that carries dot and strain gauge, as a displacement sensor.

A cantilever of free length L, the gauge at its clamp, the dot at its end. The hand pushes with P at the distance a
nearer to the clamp, the sensor pushes back with F. Bernoulli's beam (Gere and Goodno, Mechanics of Materials, 2012,
appendix H) gives the moment at the gauge and the deflection of the dot,
    M = P (L - a) - F L,
    w = P (L - a)^2 (2 L + a) / 6 E I - F L^3 / 3 E I          (a >= 0; beyond the dot P L^2 (2 L - 3 a) / 6 E I).
The gauge was calibrated at the end: it reads u = M L^2 / 3 E I. With a = 0 that is w, whatever F: the beam is a
spring in parallel to the sensor, and stays out of p.
"""

from collections.abc import Callable

from scipy.optimize import brentq

BENDING_STIFFNESS_N_MM2 = 2800.0 * 9.0 * 2.0**3 / 12.0
"""E I of acrylic, 2.8 GPa, 9 mm wide and 2 mm high."""


def tip_stiffness_N_per_mm(length_mm: float) -> float:
    """Force per deflection at the end of the beam alone."""
    return 3.0 * BENDING_STIFFNESS_N_MM2 / length_mm**3


def dot_depth_mm(read_mm: float, force_at: Callable[[float], float], length_mm: float, push_offset_mm: float) -> float:
    """Depth of the dot in mm when the gauge reads read_mm; force_at : depth in mm -> force in N."""

    def missing(depth: float) -> float:
        return _deflection_mm(read_mm, force_at(depth), length_mm, push_offset_mm) - depth

    return float(brentq(missing, 0.0, 4.0 * read_mm, xtol=1e-9)) if missing(0.0) > 0.0 else 0.0


def _deflection_mm(read_mm: float, force_N: float, length_mm: float, offset_mm: float) -> float:
    """Deflection of the dot at what the gauge reads and a force of the sensor."""
    moment = 3.0 * BENDING_STIFFNESS_N_MM2 / length_mm**2 * read_mm
    arm = length_mm - offset_mm
    push = (moment + force_N * length_mm) / arm
    if offset_mm >= 0.0:
        by_push = push * arm**2 * (2.0 * length_mm + offset_mm)
    else:
        by_push = push * length_mm**2 * (2.0 * length_mm - 3.0 * offset_mm)
    return (by_push - 2.0 * force_N * length_mm**3) / (6.0 * BENDING_STIFFNESS_N_MM2)
