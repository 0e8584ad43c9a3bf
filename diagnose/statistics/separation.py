"""How far apart models are on a set of recordings, and which of them cannot be told apart.

All arrays are whitened and free of nuisances (nuisance_projection.py), so that all lengths are in units of the standard
deviation sigma.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.stats import norm

from diagnose.statistics.nuisance_projection import orthonormal_basis
from foundation.arrays import Floats

Group = tuple[int, ...]


@dataclass(frozen=True)
class Groups:
    """Ambiguity groups of models. groups : each pair within one is closer than asked.

    split : close pairs in different groups.
    """

    groups: tuple[Group, ...]
    split: tuple[tuple[int, int], ...]


def least_separation(error: float) -> float:
    """Distance in sigma between two predictions at which the wrong one fits better with this probability.

    It is 2 z (Fisher 1936).
    """
    return 2.0 * float(norm.isf(error))


def distance_to_rival(prediction: Floats, rival: Floats) -> float:
    """Distance in sigma between a fitted prediction (n,) and the nearest point of a rival's tangent space (n, q)."""
    basis = orthonormal_basis(rival)
    return float(np.linalg.norm(prediction - basis @ (basis.T @ prediction)))


def separations(predictions: Sequence[Floats], tangents: Sequence[Floats]) -> Floats:
    """Symmetric matrix (m, m) of distances in sigma between models, the truth being the one that is easier to imitate.

    predictions : (n,) fitted change of each model. tangents : (n, q_i), its space at the off value.
    """
    one_way = np.array([[distance_to_rival(p, t) for t in tangents] for p in predictions])
    both = np.minimum(one_way, one_way.T)
    np.fill_diagonal(both, 0.0)
    return np.asarray(both)


def ambiguity_groups(separation: Floats, least: float, largest: int) -> Groups:
    """Groups of models in which all pairs are closer than `least` sigma, none with more than `largest` members.

    separation : (m, m) symmetric. Complete linkage (Sorensen 1948): the two groups whose farthest pair is closest join
    first. Being close is not transitive and groups are limited: `split` names the close pairs that the groups part.
    """
    groups: list[Group] = [(n,) for n in range(len(separation))]
    while pair := _next_merger(groups, separation, least, largest):
        groups = [group for group in groups if group not in pair] + [tuple(sorted(pair[0] + pair[1]))]
    groups.sort()
    home = {n: number for number, group in enumerate(groups) for n in group}
    close = np.argwhere(np.triu(separation < least, 1))
    return Groups(tuple(groups), tuple((int(a), int(b)) for a, b in close if home[int(a)] != home[int(b)]))


def _next_merger(groups: Sequence[Group], separation: Floats, least: float, largest: int) -> tuple[Group, Group] | None:
    """The two groups to join next, None when no two are close and small enough."""
    allowed = (pair for pair in combinations(groups, 2) if len(pair[0]) + len(pair[1]) <= largest)
    farthest = {pair: float(separation[np.ix_(*pair)].max()) for pair in allowed}
    best = min(farthest, key=farthest.__getitem__, default=None)
    return best if best is not None and farthest[best] < least else None
