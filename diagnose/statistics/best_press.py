"""The press that would best tell the surviving rivals apart, before it is made.

The separation of a proposed press is the distance in sigma between what two rivals predict for it, after the rival's
parameters and the nuisances have moved as far as earlier presses leave them free (T-optimality: Atkinson and Fedorov,
Biometrika 62 (1975) 57; the criterion of the least separated pair: Hunter and Reiner, Technometrics 7 (1965) 307).
"""

import numpy as np
from scipy.sparse.csgraph import connected_components

from diagnose.statistics.separation import Group
from foundation.arrays import Bools, Floats


def remaining_spread(information: Floats) -> Floats:
    """A root (p, p) of the covariance that earlier presses, with priors, leave to p parameters: R R' = information^-1.

    LinAlgError where they leave one undetermined.
    """
    return np.linalg.inv(np.linalg.cholesky(information)).T


def best_press(separation: Floats, settled: float) -> int:
    """The press that parts most pairs of rivals by settled; of equals the one whose least separated pair is farthest.

    separation : (presses, pairs) in sigma.
    """
    parted = (separation >= settled).sum(axis=1)
    return int(max(range(len(separation)), key=lambda n: (parted[n], separation[n].min(), separation[n].mean())))


def linked(count: int, together: Bools) -> tuple[Group, ...]:
    """Groups of two and more that pairs (count (count - 1) / 2,), in the order of combinations, link to each other."""
    of_pairs = np.zeros((count, count), dtype=bool)
    of_pairs[np.triu_indices(count, 1)] = together
    number, labels = connected_components(of_pairs, directed=False)
    groups = (tuple(int(n) for n in np.flatnonzero(labels == label)) for label in range(number))
    return tuple(group for group in groups if len(group) > 1)
