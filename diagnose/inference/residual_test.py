"""Is the residual larger than noise and stated errors make it, and where?"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.samples import Samples
from diagnose.statistics.family_wise import null_energies, step_down_p_values
from diagnose.statistics.nuisance_projection import Marginal
from foundation.arrays import Floats

DRAWS = 1999
UNTOUCHED = 1e-6  # of its prior variance: what a parameter must at least have learnt to be judged


@dataclass(frozen=True)
class Checked:
    """scores, p_values : (h,) of all hypotheses; the first are the cells. energies : (c,).

    strain : of what floats. draws : random ones behind p_values.
    """

    scores: Floats
    p_values: Floats
    energies: Floats
    strain: "NuisancePull"
    draws: int

    @property
    def least_p_value(self) -> float:
        """The smallest family-wise p-value that the draws can give."""
        return 2.0 / (1 + self.draws)

    @property
    def p_value(self) -> float:
        """Family-wise: of the largest score, and of the most strained parameter (Bonferroni over these two)."""
        return min(1.0, 2.0 * min(float(self.p_values.min()), self.strain.p_value))


def checked(
    samples: Samples,
    system: LinearisedSystem,
    rng: np.random.Generator,
    fitted: Floats | None = None,
    draws: int = DRAWS,
) -> Checked:
    """fitted : (n, q) sensitivities of parameters that were fitted without a prior."""
    weighted, sigma = _floating(system, fitted)
    marginal = Marginal(weighted, sigma)
    white = system.residual * system.weight
    white[system.informative] = marginal(white[system.informative])
    free = np.zeros((len(white), marginal.free.shape[1]))
    free[system.informative] = marginal.free
    family, cell = samples.hypotheses, samples.bank.cell
    null = family.scores(null_energies(family, cell, free, draws, rng))
    energies = np.asarray(np.bincount(cell, white**2, len(samples.bank.cells)), dtype=np.float64)
    scores = family.scores(energies)
    return Checked(scores, step_down_p_values(scores, null), energies, nuisance_pull(system, fitted), draws)


@dataclass(frozen=True)
class NuisancePull:
    """How far nuisances are pulled from their priors. excess : sum of squared distances above what chance makes.

    p_value : of the parameter that lies farthest off, Bonferroni over all that have a prior.
    """

    excess: float
    p_value: float


def nuisance_pull(system: LinearisedSystem, fitted: Floats | None = None) -> NuisancePull:
    """fitted : as in checked. Before the data, a posterior mean has the prior's variance less the posterior's."""
    columns, sigma = _floating(system, fitted)
    quadratic = Quadratic(columns, sigma)
    learnt = sigma**2 - quadratic.variances()
    judged = np.isfinite(sigma) & (sigma > 0.0) & (learnt > UNTOUCHED * sigma**2)
    distances = quadratic.mean(system.weighted_rows(system.residual))[judged] / np.sqrt(learnt[judged])
    farthest = float(np.max(np.abs(distances), initial=0.0))
    p_value = min(1.0, 2.0 * float(norm.sf(farthest)) * max(len(distances), 1))
    return NuisancePull(max(float(distances @ distances) - len(distances), 0.0), p_value)


def _floating(system: LinearisedSystem, fitted: Floats | None) -> tuple[Floats, Floats]:
    """Columns (n, k) of all that floats, whitened, and its prior deviations (k,)."""
    if fitted is None:
        return system.weighted_rows(system.nuisance_design), system.sigma
    columns = np.column_stack([system.nuisance_design, fitted[system.informative]])
    return system.weighted_rows(columns), np.concatenate([system.sigma, np.full(fitted.shape[1], np.inf)])
