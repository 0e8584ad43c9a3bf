"""Medium 1 as a beam, Eqs. (10) to (12) of the paper. SI units.

Medium 1 and film as one beam: what the paper's parameters leave out. SI units, per metre of width.

Classical theory of laminated beams: layers bonded without slip, plane sections stay plane. `modulus_Pa` is Young's
modulus, or plane_strain_modulus_Pa() of it for a wide beam.

Softness of the two media, Eqs. (3) to (9) of the paper. SI units; the index 1 is the medium above the film.

Medium 1 and film of the paper as layers of a beam.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from softdot.studies.paper.published import E1_MPA

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
    """What shear adds at the middle, F l / (4 k G A), the same for both ends; large for a beam this thick."""
    shear_modulus = modulus_Pa / (2.0 * (1.0 + poisson_ratio))
    return force_N * length_m / (4.0 * SHEAR_FACTOR * shear_modulus * width_m * height_m)


def bending_softness(length_m: float, modulus_Pa: float, height_m: float) -> float:
    """S_b = l³ / (E h³) in 1/Pa, Eq. (11); of medium 1 it is S_1b, of the film S_Pb."""
    return length_m**3 / (modulus_Pa * height_m**3)


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


Regime = Literal["medium1", "both", "medium2"]
"""Whose deflection the output follows by Eq. (8)."""

MUCH = 10.0
"""How many times larger "much larger" is in Eq. (8); the paper gives no number."""


def index_of_thickness(h1_m: float, h2_m: float) -> float:
    """f = h1 / h2, Eq. (3)."""
    return h1_m / h2_m


def index_of_modulus(e1_Pa: float, e2_Pa: float) -> float:
    """e = E1 / E2, Eq. (4)."""
    return e1_Pa / e2_Pa


def softness_of_jiang(thickness_m: float, modulus_Pa: float) -> float:
    """S = h / E in m/Pa, Eq. (5): the first definition, by Jiang and others, which knows no length."""
    return thickness_m / modulus_Pa


def softness(thickness_m: float, length_m: float, modulus_Pa: float) -> float:
    """S = h / (l E) in 1/Pa, Eq. (6): the definition that the paper works with."""
    return thickness_m / (length_m * modulus_Pa)


def shares(softness1: float, softness2: float) -> tuple[float, float]:
    """S_A and S_B, Eq. (9): the shares of medium 1 and medium 2 in the whole softness. They add up to 1."""
    ratio = softness2 / softness1
    return 1.0 / (1.0 + ratio), ratio / (1.0 + ratio)


def deflections_m(
    u2_m: float, softness1: float, softness2: float, alpha1: float = 1.0, alpha2: float = 1.0
) -> tuple[float, float]:
    """delta_1 and delta_2, Eq. (7). With alpha1 = alpha2 = 1 they are those of two springs in series."""
    share_a, share_b = shares(softness1, softness2)
    return u2_m * alpha1 * share_a, u2_m * alpha2 * share_b


def regime(softness1: float, softness2: float, much: float = MUCH) -> Regime:
    """Which of the three lines of Eq. (8) holds: S2 >> S1, S1 about S2, or S1 >> S2."""
    if softness2 > much * softness1:
        return "medium1"
    return "medium2" if softness1 > much * softness2 else "both"


def output_m(
    u2_m: float,
    softness1: float,
    softness2: float,
    alpha1: float = 1.0,
    alpha2: float = 1.0,
    much: float = MUCH,
) -> float:
    """The deflection that the free output is proportional to, Eq. (8)."""
    delta1, delta2 = deflections_m(u2_m, softness1, softness2, alpha1, alpha2)
    return {"medium1": delta1, "both": delta1 + delta2, "medium2": delta2}[regime(softness1, softness2, much)]


FILM = Lamina(thickness_m=28e-6, modulus_Pa=2e9)
H1_MM = (0.5, 0.8, 2.0, 4.0)
"""Every thickness of medium 1 in the paper."""


def medium1(h1_mm: float) -> Lamina:
    """Medium 1 of a thickness."""
    return Lamina(1e-3 * h1_mm, 1e6 * E1_MPA)


def stiffness_ratio(h1_mm: float) -> float:
    """In-plane stiffness of the film over that of medium 1."""
    return FILM.membrane_stiffness_N_per_m / medium1(h1_mm).membrane_stiffness_N_per_m
