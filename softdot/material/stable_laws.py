"""Laws that are stable at every strain, as sums of terms with constants that are not negative.

The nominal stress of an incompressible specimen is linear in the constants, so that non-negative least squares finds
them. Each term is convex in the logarithms of the stretches and rises in tension, compression and shear without end:
powers of I1 - 3 from the first on, Knowles' with an exponent of 1 or more, Ogden's with mu alpha > 0 and an alpha of 1
or more, or -2 or less (Hill, Proc. R. Soc. Lond. A 314, 1970, p. 457; Ogden, Non-linear Elastic Deformations, 1984,
section 6.2). So no fit can turn over beyond its data.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnose.engines.coupon.kinematics import STRETCHINGS
from foundation.arrays import Floats

Values = Sequence[float]
Shape = tuple[float, float, float]
"""Start and bounds of an exponent or a rate."""
LEAST_EXPONENT = -3.0
"""Of Ogden's terms: smaller ones hardly show in tension, and explode where a sheet is pulled both ways or pressed."""
SHARES = {"equibiaxial": 0.5, "compression": -1.0}
"""Kind -> nominal stress over the slope of the energy by the stretch along the load; 1 of all others."""


@dataclass(frozen=True)
class Deformation:
    """Strains (n,) of one kind of test: logarithm of the stretch along the load, of the others at constant volume.

    by_travel : slope of the first by the nominal strain or the amount of shear, times the share of SHARES.
    """

    log_stretches: Floats
    axes: Floats
    by_travel: Floats

    @classmethod
    def of(cls, kind: str, strain: Floats) -> "Deformation":
        """The deformation of a kind of test at nominal strains, or amounts of shear."""
        if kind == "shear":
            stretch = 0.5 * strain + np.sqrt(1.0 + 0.25 * strain**2)
            return cls(np.outer(np.log(stretch), (1.0, 0.0, -1.0)), np.array([1.0, 0.0, -1.0]),
                       stretch / (stretch**2 + 1.0))  # fmt: skip
        axes = np.array(STRETCHINGS[kind].log_stretches)[:, 0]
        stretch = 1.0 - strain if kind == "compression" else 1.0 + strain
        return cls(np.outer(np.log(stretch), axes), axes, SHARES.get(kind, 1.0) / stretch)

    def ogden(self, alpha: float) -> Floats:
        """Nominal stress (n,) of an Ogden term with mu alpha = 2, whose shear modulus is 1."""
        return np.asarray(2.0 / alpha * (np.exp(alpha * self.log_stretches) @ self.axes) * self.by_travel)

    def of_invariant(self, slope: Callable[[Floats], Floats]) -> Floats:
        """Nominal stress (n,) of an energy with a slope dW / dI1 that depends on I1 - 3."""
        squares = np.exp(2.0 * self.log_stretches)
        return np.asarray(slope(squares.sum(axis=1) - 3.0) * 2.0 * (squares @ self.axes) * self.by_travel)


@dataclass(frozen=True)
class StableLaw:
    """A family of laws. name : as --law and the pages call it.

    terms : columns of nominal stress (n,) per unit constant at a deformation and shape values. table : the entry of
    [materials] from constants in MPa and shape values. starts : where a fit begins, each with a start and bounds for
    every shape value.
    """

    name: str
    terms: Callable[[Deformation, Values], list[Floats]]
    table: Callable[[Values, Values], dict[str, Any]]
    starts: tuple[tuple[Shape, ...], ...] = ((),)

    def rows(self, tests: Sequence[Deformation], shape: Values) -> Floats:
        """Nominal stress (n, m) per unit constant at the strains of several tests."""
        return np.concatenate([np.column_stack(self.terms(test, shape)) for test in tests])


def _ogden(*starts: tuple[float, ...]) -> StableLaw:
    """Ogden's law with as many terms as each start has exponents."""

    def table(constants: Values, shape: Values) -> dict[str, Any]:
        used = [(2.0 * c / a, a) for c, a in zip(constants, shape, strict=True) if c > 0.0]
        return {"model": "ogden", "mu_MPa": [mu for mu, _ in used], "alpha": [a for _, a in used]}

    bounded = tuple(tuple((a, LEAST_EXPONENT, -2.0) if a < 0.0 else (a, 1.0, 25.0) for a in start) for start in starts)
    return StableLaw(f"ogden-{len(starts[0])}", lambda at, shape: [at.ogden(a) for a in shape], table, bounded)


def knowles_slope(b: float, n: float) -> Callable[[Floats], Floats]:
    """Slope of (1 + b / n (I1 - 3))^n / b; an infinite n: of the exponential."""
    return lambda x: np.exp(b * x) if np.isinf(n) else (1.0 + b / n * x) ** (n - 1.0)


STABLE_LAWS = (
    StableLaw(
        "neo-hookean",
        lambda at, _: [at.ogden(2.0)],
        lambda c, _: {"model": "neo-hookean", "youngs_modulus_MPa": 3.0 * c[0]},
    ),
    StableLaw(
        "mooney-rivlin",
        lambda at, _: [at.ogden(2.0), at.ogden(-2.0)],
        lambda c, _: {"model": "mooney-rivlin", "c10_MPa": 0.5 * c[0], "c01_MPa": 0.5 * c[1]},
    ),
    StableLaw(
        "yeoh",
        lambda at, _: [at.of_invariant(lambda x, k=k: k * x ** (k - 1.0)) for k in (1.0, 2.0, 3.0)],  # type: ignore[misc]
        lambda c, _: {"model": "yeoh", "c10_MPa": c[0], "c20_MPa": c[1], "c30_MPa": c[2]},
    ),
    StableLaw(
        "knowles",
        lambda at, shape: [at.of_invariant(knowles_slope(shape[0], shape[1]))],
        lambda c, shape: {"model": "knowles", "c10_MPa": c[0], "b": shape[0], "n": shape[1]},
        (((0.1, 1e-3, 50.0), (2.0, 1.0, 50.0)), ((1.0, 1e-3, 50.0), (3.0, 1.0, 50.0))),
    ),
    StableLaw(
        "fung",
        lambda at, shape: [at.of_invariant(knowles_slope(shape[0], np.inf))],
        lambda c, shape: {"model": "knowles", "c10_MPa": c[0], "b": shape[0]},
        (((0.05, 1e-3, 50.0),), ((0.5, 1e-3, 50.0),)),
    ),
    _ogden((1.5,), (3.0,), (6.0,), (-2.5,)),
    _ogden((1.2, 4.0), (2.0, 8.0), (-2.5, 2.5), (-2.9, 5.0)),
)


def laws_for(kinds: int) -> list[StableLaw]:
    """Laws that tests of a number of kinds can tell apart.

    One kind says nothing of terms with negative exponents, which decide what a law makes of the others: two laws that
    agree within a percent in tension differ there by a third or more (Ogden, Saccomandi and Sgura, Comput. Mech. 34,
    2004, p. 484).
    """
    if kinds > 1:
        return list(STABLE_LAWS)
    known = [law for law in STABLE_LAWS if law.name != "mooney-rivlin"]
    positive = [tuple(start for start in law.starts if all(one[0] > 0.0 for one in start)) for law in known]
    return [replace(law, starts=starts) for law, starts in zip(known, positive, strict=True)]
