"""Every stable law fitted to first loadings, ranked by what it says of strains that took no part in the fit."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, nnls

from foundation.arrays import Bools, Floats
from softdot.material.stable_laws import STABLE_LAWS, Deformation, StableLaw

LARGEST_SLACK, FIRST_SLACK = 0.05, 0.002  # nominal strain before a specimen is loaded
BLOCKS = 8  # of each test, in order of strain: each is left out once


@dataclass(frozen=True)
class LoadingCurve:
    """First loading of a test within the range of the fit: its kind, nominal strain and stress_MPa (n,)."""

    kind: str
    strain: Floats
    stress_MPa: Floats

    def deformation(self, slack: float = 0.0) -> Deformation:
        """Its deformation where the specimen is loaded from a strain on, the slack of grips or the first touch."""
        return Deformation.of(self.kind, np.maximum(self.strain - slack, 0.0))

    def part(self, kept: Bools) -> "LoadingCurve":
        """The samples (n,) that are kept."""
        return LoadingCurve(self.kind, self.strain[kept], self.stress_MPa[kept])


@dataclass(frozen=True)
class FittedLaw:
    """A law with its constants in MPa, its shape values, and the slack of each test."""

    law: StableLaw
    constants: tuple[float, ...]
    shape: tuple[float, ...]
    slack: tuple[float, ...]

    def stress_MPa(self, deformation: Deformation) -> Floats:
        """Nominal stress (n,) of an incompressible specimen."""
        return np.asarray(self.law.rows([deformation], self.shape) @ self.constants)

    def missed(self, curves: Sequence[LoadingCurve]) -> list[Floats]:
        """What is missed of each curve (n,) in MPa."""
        pairs = zip(curves, self.slack, strict=True)
        return [self.stress_MPa(curve.deformation(slack)) - curve.stress_MPa for curve, slack in pairs]

    def error(self, curves: Sequence[LoadingCurve]) -> float:
        """Root mean square of what is missed, over that of the stress; tests count alike."""
        parts = zip(self.missed(curves), curves, strict=True)
        return float(np.sqrt(np.mean([(m @ m) / (c.stress_MPa @ c.stress_MPa) for m, c in parts])))


def fit_law(
    law: StableLaw, curves: Sequence[LoadingCurve], slack: float | None, near: FittedLaw | None = None
) -> FittedLaw:
    """Least squares over all curves, each in units of its own stress: constants by NNLS inside a search of the rest.

    slack : of every test; None fits one each. near : where the search starts, in place of the law's own starts.
    """
    weight = np.concatenate([np.full(len(c.strain), 1.0 / np.linalg.norm(c.stress_MPa)) for c in curves])
    stress = weight * np.concatenate([c.stress_MPa for c in curves])
    count = 0 if slack is not None else len(curves)

    def split(at: Floats) -> tuple[Floats, Floats]:
        """Shape values and slacks (tests,)."""
        return at[: len(at) - count], at[len(at) - count :] if count else np.full(len(curves), slack)

    def solved(at: Floats) -> tuple[Floats, Floats]:
        """Constants, and what is missed (n,)."""
        shape, slacks = split(at)
        deformed = [c.deformation(one) for c, one in zip(curves, slacks, strict=True)]
        rows = weight[:, None] * law.rows(deformed, shape.tolist())
        size = np.linalg.norm(rows, axis=0)
        constants = nnls(rows / size, stress)[0] / size
        return constants, rows @ constants - stress

    found = []
    for start in law.starts if near is None else law.starts[:1]:
        low = np.array([one[1] for one in start] + [0.0] * count)
        high = np.array([one[2] for one in start] + [LARGEST_SLACK] * count)
        at = np.array([one[0] for one in start] + [FIRST_SLACK] * count)
        if near is not None:
            at = np.array([*near.shape, *near.slack[:count]])
            low, high = np.minimum(low, at), np.maximum(high, at)
        if len(at):
            at = least_squares(lambda x: solved(x)[1], at, bounds=(low, high), x_scale=np.maximum(np.abs(at), 1e-3)).x
        constants, missed = solved(at)
        shape, slacks = split(at)
        fitted = FittedLaw(law, tuple(constants.tolist()), tuple(shape.tolist()), tuple(slacks.tolist()))
        found.append((float(missed @ missed), fitted))
    return min(found, key=lambda one: one[0])[1]


@dataclass(frozen=True)
class RankedLaw:
    """A law fitted to all curves, and error: of the fit, held_out: of blocks that took no part; both relative.

    without : the fits without one block each, whose scatter gives the intervals.
    """

    fitted: FittedLaw
    error: float
    held_out: float
    without: tuple[FittedLaw, ...]

    def deviation(self, value: Callable[[FittedLaw], Floats]) -> Floats:
        """One standard deviation (q,) of values (q,) of a fit, from the fits without one block: the jackknife.

        Blocks of neighbours are left out, as what a law misses is alike at like strains (Kunsch, Ann. Statist. 17,
        1989, p. 1217).
        """
        values = np.array([value(one) for one in self.without])
        count = len(values)
        return np.asarray(np.sqrt((count - 1) / count * ((values - values.mean(axis=0)) ** 2).sum(axis=0)))


def rank_laws(
    curves: Sequence[LoadingCurve], slack: float | None, laws: Sequence[StableLaw] = STABLE_LAWS
) -> list[RankedLaw]:
    """Laws by their error on left-out blocks of strain, the least first; of equals the one with fewer constants.

    slack : as of fit_law.
    """
    ranked = [_ranked(law, curves, slack) for law in laws]
    least = min(one.held_out for one in ranked)
    return sorted(ranked, key=lambda one: one.held_out if one.held_out > 1.01 * least else least)


def _ranked(law: StableLaw, curves: Sequence[LoadingCurve], slack: float | None) -> RankedLaw:
    whole, without, squares = fit_law(law, curves, slack), [], 0.0
    for block in range(BLOCKS):
        out = [np.arange(len(c.strain)) * BLOCKS // len(c.strain) == block for c in curves]
        fitted = fit_law(law, [c.part(~one) for c, one in zip(curves, out, strict=True)], slack, near=whole)
        without.append(fitted)
        for missed, curve, one in zip(fitted.missed(curves), curves, out, strict=True):
            squares += float(missed[one] @ missed[one]) / float(curve.stress_MPa @ curve.stress_MPa) / len(curves)
    return RankedLaw(whole, whole.error(curves), float(np.sqrt(squares)), tuple(without))
