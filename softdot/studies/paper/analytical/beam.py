"""Medium 1 as a beam, Eqs. (10) to (12) of the paper. SI units."""

from typing import Literal

Ends = Literal["supported", "clamped"]
STIFFNESS_FACTOR: dict[Ends, float] = {"supported": 48.0, "clamped": 192.0}
"""Beam under a force at its middle (Timoshenko, Strength of Materials); the paper's Eq. (10) has 48."""
SHEAR_FACTOR = 5.0 / 6.0


def second_moment_m4(width_m: float, height_m: float) -> float:
    """I = b h³ / 12 of a rectangle."""
    return width_m * height_m**3 / 12.0


def beam_deflection_m(
    force_N: float, length_m: float, modulus_Pa: float, second_moment: float, ends: Ends = "supported"
) -> float:
    """Deflection at the middle, F l³ / (48 E I) or F l³ / (192 E I): Eq. (10) with its two end conditions."""
    return force_N * length_m**3 / (STIFFNESS_FACTOR[ends] * modulus_Pa * second_moment)


def shear_deflection_m(
    force_N: float, length_m: float, width_m: float, height_m: float, modulus_Pa: float, poisson_ratio: float
) -> float:
    """Deflection of the middle by shear, F l / (4 k G A), the same for both ends; large for a beam this thick."""
    shear_modulus = modulus_Pa / (2.0 * (1.0 + poisson_ratio))
    return force_N * length_m / (4.0 * SHEAR_FACTOR * shear_modulus * width_m * height_m)


def bending_softness(length_m: float, modulus_Pa: float, height_m: float) -> float:
    """S_b = l³ / (E h³) in 1/Pa, Eq. (11); of medium 1 it is S_1b, of the film S_Pb."""
    return length_m**3 / (modulus_Pa * height_m**3)
