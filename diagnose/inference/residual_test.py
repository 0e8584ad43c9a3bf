"""Is the residual larger than noise and stated errors make it, and where?"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from diagnose.inference.quadratic import Quadratic
from diagnose.inference.samples import Samples
from diagnose.inference.system import System
from diagnose.statistics.family_wise import null_energies, step_down
from diagnose.statistics.nuisance import Marginal
from mesh.types import Floats

DRAWS = 1999
UNTOUCHED = 1e-6  # of its prior variance: what a parameter must at least have learnt to be judged


@dataclass(frozen=True)
class Checked:
    """scores, p_values : (h,) of all hypotheses; the first are the cells. energies : (c,).

    p_strained : family-wise, that what floats lies where its priors have it.
    """

    scores: Floats
    p_values: Floats
    energies: Floats
    p_strained: float

    @property
    def p_value(self) -> float:
        """Family-wise: of the largest score, and of the most strained parameter (Bonferroni over these two)."""
        return min(1.0, 2.0 * min(float(self.p_values.min()), self.p_strained))


def checked(
    samples: Samples, system: System, rng: np.random.Generator, fitted: Floats | None = None, draws: int = DRAWS
) -> Checked:
    """fitted : (n, q) sensitivities of parameters that were fitted without a prior."""
    columns, sigma = system.excused, system.sigma
    if fitted is not None:
        columns = np.column_stack([columns, fitted[system.live]])
        sigma = np.concatenate([sigma, np.full(fitted.shape[1], np.inf)])
    weighted = system.weighted(columns)
    marginal = Marginal(weighted, sigma)
    white = system.residual * system.weight
    strained = p_of_strain(Quadratic(weighted, sigma), sigma, white[system.live])
    white[system.live] = marginal(white[system.live])
    free = np.zeros((len(white), marginal.free.shape[1]))
    free[system.live] = marginal.free
    family, cell = samples.hypotheses, samples.bank.cell
    null = family.scores(null_energies(family, cell, free, draws, rng))
    energies = np.asarray(np.bincount(cell, white**2, len(samples.bank.cells)), dtype=np.float64)
    scores = family.scores(energies)
    return Checked(scores, step_down(scores, null), energies, strained)


def p_of_strain(quadratic: Quadratic, sigma: Floats, residual: Floats) -> float:
    """p-value of the parameter that lies farthest from its prior, Bonferroni over all that have one.

    Before the data, a posterior mean is normal with the prior's variance less the posterior's.
    """
    learnt = sigma**2 - quadratic.variances()
    judged = np.isfinite(sigma) & (sigma > 0.0) & (learnt > UNTOUCHED * sigma**2)
    if not judged.any():
        return 1.0
    farthest = float(np.max(np.abs(quadratic.mean(residual)[judged]) / np.sqrt(learnt[judged])))
    return min(1.0, 2.0 * float(norm.sf(farthest)) * int(judged.sum()))
