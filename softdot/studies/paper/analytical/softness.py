"""Softness of the two media, Eqs. (3) to (9) of the paper. SI units; the index 1 is the medium above the film."""

from typing import Literal

Regime = Literal["medium1", "both", "medium2"]
"""Whose deflection the output follows by Eq. (8)."""
MUCH = 10.0
"""How many times larger "much larger" is in Eq. (8); the paper gives no number."""


def index_of_thickness(h1_m: float, h2_m: float) -> float:
    """Ratio of the thicknesses f = h1 / h2, Eq. (3)."""
    return h1_m / h2_m


def index_of_modulus(e1_Pa: float, e2_Pa: float) -> float:
    """Ratio of the moduli e = E1 / E2, Eq. (4)."""
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
    """Deflections delta_1 and delta_2, Eq. (7). With alpha1 = alpha2 = 1 they are those of two springs in series."""
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
