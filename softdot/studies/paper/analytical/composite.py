"""Medium 1 and film as one beam: what the paper's parameters leave out. SI units, per metre of width.

Classical theory of laminated beams: layers bonded without slip, plane sections stay plane. `modulus_Pa` is Young's
modulus, or plane_strain_modulus_Pa() of it for a wide beam.
"""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Lamina:
    """One layer of a beam."""

    thickness_m: float
    modulus_Pa: float

    @property
    def membrane_stiffness_N_per_m(self) -> float:
        """Force per width and strain in its own plane, E h."""
        return self.modulus_Pa * self.thickness_m

    @property
    def own_bending_stiffness_Nm(self) -> float:
        """Bending moment per width and curvature about its own middle, E h³ / 12."""
        return self.modulus_Pa * self.thickness_m**3 / 12.0


def plane_strain_modulus_Pa(modulus_Pa: float, poisson_ratio: float) -> float:
    """E / (1 - nu²): what a wide beam feels."""
    return modulus_Pa / (1.0 - poisson_ratio**2)


def neutral_axis_m(laminae: Sequence[Lamina]) -> float:
    """Height above the bottom of the first layer where bending stretches nothing: sum(E h z) / sum(E h)."""
    total = sum(lamina.membrane_stiffness_N_per_m for lamina in laminae)
    moments = zip(laminae, middles_m(laminae), strict=True)
    return sum(lamina.membrane_stiffness_N_per_m * middle for lamina, middle in moments) / total


def bending_stiffness_Nm(laminae: Sequence[Lamina]) -> float:
    """Moment per width and curvature about the neutral axis: sum(E h³ / 12 + E h (z - z_n)²)."""
    axis = neutral_axis_m(laminae)
    return sum(
        lamina.own_bending_stiffness_Nm + lamina.membrane_stiffness_N_per_m * (middle - axis) ** 2
        for lamina, middle in zip(laminae, middles_m(laminae), strict=True)
    )


def middles_m(laminae: Sequence[Lamina]) -> list[float]:
    """Height of the middle of each layer above the bottom of the first one."""
    middles, bottom = [], 0.0
    for lamina in laminae:
        middles.append(bottom + lamina.thickness_m / 2.0)
        bottom += lamina.thickness_m
    return middles


def stretch_of_deflected_strip(deflection_m: float, length_m: float) -> float:
    """Strain of a strip that is held at both ends and deflected to a triangle, 2 (u / l)² for small u / l."""
    return 2.0 * (deflection_m / length_m) ** 2


def middle_curvature_per_m(deflection_m: float, length_m: float, ends: str = "clamped") -> float:
    """Curvature under a force at the middle: 24 u / l² with clamped ends, 12 u / l² with supported ends.

    Clamped ends bend the other way, so that the mean curvature over the length, and with it the mean bending
    strain of the film, is exactly zero.
    """
    return {"clamped": 24.0, "supported": 12.0}[ends] * deflection_m / length_m**2
