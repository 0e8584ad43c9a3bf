"""The choice of the press, before it is made, that best tells the surviving rivals apart.

The separation of a proposed press is the distance in sigma between what two rivals predict for it, after the rival's
parameters and the nuisances have moved as far as earlier presses leave them free (T-optimality: Atkinson and Fedorov,
Biometrika 62 (1975) 57; the criterion of the least separated pair: Hunter and Reiner, Technometrics 7 (1965) 307).
"""

import numpy as np
from scipy.sparse.csgraph import connected_components

from diagnose.statistics.separation import Group
from foundation.arrays import Bools, Floats


def covariance_root(information: Floats) -> Floats:
    """Root R (p, p) of the covariance of p parameters with an information matrix (p, p): R R' = information^-1.

    LinAlgError where a parameter is undetermined.
    """
    return np.linalg.inv(np.linalg.cholesky(information)).T


def best_press(separation: Floats, settled: float) -> int:
    """Number of the press that separates most pairs of rivals by at least `settled` sigma.

    separation : (presses, pairs) in sigma. Of equals it is the press whose least separated pair is farthest.
    """
    parted = (separation >= settled).sum(axis=1)
    return int(max(range(len(separation)), key=lambda n: (parted[n], separation[n].min(), separation[n].mean())))


def linked_groups(count: int, together: Bools) -> tuple[Group, ...]:
    """Groups of two and more of `count` items that are linked by pairs.

    together : (count (count - 1) / 2,) flags of linked pairs, in the order of itertools.combinations.
    """
    of_pairs = np.zeros((count, count), dtype=bool)
    of_pairs[np.triu_indices(count, 1)] = together
    number, labels = connected_components(of_pairs, directed=False)
    groups = (tuple(int(n) for n in np.flatnonzero(labels == label)) for label in range(number))
    return tuple(group for group in groups if len(group) > 1)
