"""Which fitted models these recordings cannot tell apart."""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.refit import Fitted
from diagnose.fit.samples import Samples
from diagnose.statistics.error_rates import AMBIGUITY_ERROR, RATES
from diagnose.statistics.separation import ambiguity_groups, least_separation
from foundation.arrays import Floats


def separations(samples: Samples, fits: Sequence[Fitted]) -> Floats:
    """Sigma (m, m) between fitted predictions, each in the metric of the one that is taken as true.

    The rival may still move along its tangents, and nuisances float; the smaller of both directions.
    """
    one_way = np.array([[_distance(samples, true, rival) for rival in fits] for true in fits]).reshape(len(fits), -1)
    return np.asarray(np.minimum(one_way, one_way.T))


def grouped(separation: Floats) -> tuple[tuple[int, ...], ...]:
    """Groups of models closer than the least separation, that of the first model first."""
    groups = ambiguity_groups(separation, least_separation(AMBIGUITY_ERROR), RATES.largest_group).groups
    return tuple(sorted(groups, key=lambda group: min(group)))


def alike(separation: Floats) -> int:
    """How many models cannot be told from the first, itself included."""
    return int((separation[0] < least_separation(AMBIGUITY_ERROR)).sum())


def _distance(samples: Samples, true: Fitted, rival: Fitted) -> float:
    if true is rival:
        return 0.0
    system = true.system
    apart = system.weighted_rows(_modelled(samples, true) - _modelled(samples, rival))
    slopes = system.weighted_rows(rival.slopes)
    gram = system.quadratic.inner_products(slopes, slopes)
    along = system.quadratic.inner_products(slopes, apart[:, None])[:, 0]
    return float(np.sqrt(max(system.quadratic.square(apart) - float(along @ np.linalg.pinv(gram) @ along), 0.0)))


def _modelled(samples: Samples, fit: Fitted) -> Floats:
    """What a fit predicts with its nuisances, (n,), but for discrepancies."""
    system = fit.system
    nuisances = system.best_nuisances(system.residual)
    moved = np.zeros(len(samples))
    moved[system.informative] = system.nuisance_design[:, : len(nuisances)] @ nuisances
    return np.asarray(samples.recorded_vector - system.residual + moved)
