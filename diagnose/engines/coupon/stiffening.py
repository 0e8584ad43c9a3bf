"""A law that stiffens, or gives way, beyond the one stated: more terms of Ogden's series, or of Yeoh's.

Neo-Hookean is Ogden's law with the exponent 2, Mooney-Rivlin's second term that with -2. Terms of 4, 8 and -2 are
added, in compression -4, -8 and -2, and one of 2 that keeps the small-strain modulus. The coordinates are what all of
them add to the force at the largest strain of the recording, over that of the law as it stands and but for a change of
volume, and what the second and third have of it: 0 leaves the law. Of Gent's law up to 60 % of its limit of I1 - 3 this
family misses 0.6 % of the stress in tension; of the silicones and the natural rubber of examples/recordings, up to
stretch 4 and 7.6, about 1 %. A Yeoh law keeps its form: its quadratic and cubic terms change.
Under a force the terms only add, for a law that turns over has no answer to it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from diagnose.forward import Coordinate
from solve.materials.parameters import Material, MooneyRivlin, Ogden, Yeoh

OGDEN_EXPONENTS = (4.0, 8.0, -2.0)
SHEAR_EXPONENTS = (4.0, 8.0, 1.0)  # -2 is the same as 2 there
FORCE_DRIVEN_EXPONENTS = (4.0, 8.0)
FORCE_CHANGE = Coordinate("force_ratio_less_1", -0.95, 20.0, (0.5, -0.5))
LARGEST_TERM_SHARE = 20.0  # of one term, in terms of the force without; terms may compensate each other


@dataclass(frozen=True)
class Stiffening:
    """The family of laws around a material. stretch : the principal one, along the load, at the largest strain.

    lateral : a principal stretch across is stretch ** -lateral, 1/2 in tension and compression, 1 in simple shear.
    by_force : whether any run is driven by its force.
    """

    material: Material
    stretch: float
    lateral: float
    by_force: bool

    @property
    def exponents(self) -> tuple[float, ...]:
        """Exponents of the terms that are added to Ogden's series."""
        if self.by_force:
            chosen: tuple[float, ...] = FORCE_DRIVEN_EXPONENTS
        else:
            chosen = SHEAR_EXPONENTS if self.lateral == 1.0 else OGDEN_EXPONENTS
        return tuple(-abs(exponent) for exponent in chosen) if self.stretch < 1.0 else chosen

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Coordinates of a fit: the force at the largest strain, and the share of each term but the first.

        One for each term where a force drives.
        """
        names = ("c20", "c30") if isinstance(self.material, Yeoh) else [f"exponent_{a:g}" for a in self.exponents]
        if self.by_force:
            return tuple(Coordinate(f"force_by_{name}", 0.0, LARGEST_TERM_SHARE, (0.5,)) for name in names)
        return FORCE_CHANGE, *(
            Coordinate(f"force_by_{name}", -LARGEST_TERM_SHARE, LARGEST_TERM_SHARE, (0.5, -0.5)) for name in names[1:]
        )

    def parameters(self, values: Sequence[float]) -> dict[str, Any]:
        """Constants of the law by name, from the values of the coordinates."""
        added = values if self.by_force else [values[0] - sum(values[1:]), *values[1:]]
        if isinstance(self.material, Yeoh):
            whole, x = self._yeoh_slope_MPa, self._invariant_excess
            c20 = self.material.c20_MPa + whole * added[0] / (2.0 * x)
            c30 = self.material.c30_MPa + whole * added[1] / (3.0 * x**2)
            return {"c10_MPa": self.material.c10_MPa, "c20_MPa": c20, "c30_MPa": c30}
        mu, alpha = _ogden_terms(self.material)
        whole = sum(m * self._term_stress(a) for m, a in zip(mu, alpha, strict=True))
        extra = [
            whole * value / (self._term_stress(a) - 0.5 * a * self._term_stress(2.0))
            for value, a in zip(added, self.exponents, strict=True)
        ]
        kept = -0.5 * sum(m * a for m, a in zip(extra, self.exponents, strict=True))
        terms: dict[float, float] = {}
        for a, m in zip((*alpha, 2.0, *self.exponents), (*mu, kept, *extra), strict=True):
            terms[a] = terms.get(a, 0.0) + m
        return {"mu_MPa": list(terms.values()), "alpha": list(terms)}

    def _term_stress(self, exponent: float) -> float:
        """Stress of one term over its mu, dW / d ln(stretch) / mu, at constant volume."""
        return float(self.stretch**exponent - self.stretch ** (-self.lateral * exponent))

    @property
    def _invariant_excess(self) -> float:
        """I1 - 3 at the largest strain: stretches are l, 1 / l and 1 in shear, else l and twice l^-1/2."""
        across = self.stretch ** (-2.0 * self.lateral)
        return float(self.stretch**2 + across + (1.0 if self.lateral == 1.0 else across)) - 3.0

    @property
    def _yeoh_slope_MPa(self) -> float:
        """Slope dW / dI1 of a Yeoh law at the largest strain."""
        assert isinstance(self.material, Yeoh)
        x = self._invariant_excess
        return self.material.c10_MPa + 2.0 * self.material.c20_MPa * x + 3.0 * self.material.c30_MPa * x**2


def _ogden_terms(material: Material) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Constants mu in MPa and alpha of a law, written as Ogden's."""
    if isinstance(material, MooneyRivlin):
        return (2.0 * material.c10_MPa, -2.0 * material.c01_MPa), (2.0, -2.0)
    if isinstance(material, Ogden):
        return tuple(material.mu_MPa), tuple(material.alpha)
    return (material.shear_modulus_MPa,), (2.0,)
