"""Quadrature of the reference tetrahedron and triangle."""

from itertools import permutations

import numpy as np

from foundation.arrays import Floats


def _orbit(*barycentric: float) -> Floats:
    """Points (k, len) of all distinct permutations of a barycentric point."""
    return np.array(sorted(set(permutations(barycentric))))


def tetrahedron(degree: int = 3) -> tuple[Floats, Floats]:
    """Rule for the tetrahedron: points (q, 3) and weights (q,) that sum to 1/6.

    degree 3: 8 points; degree 5: 14 points. Curved quadratic elements need at least 3.
    Sources: Witherden and Vincent, Comput. Math. Appl. 69 (2015); Walkington, CMU report (2000).
    """
    if degree <= 3:
        a, b = 0.32816330251638171, 0.10804724989842859
        orbits = [_orbit(a, a, a, 1 - 3 * a), _orbit(b, b, b, 1 - 3 * b)]
        weights = [0.13621784253708741, 0.11378215746291261]
    else:
        a, b, c = 0.31088591926330061, 0.092735250310891226, 0.045503704125649649
        orbits = [_orbit(a, a, a, 1 - 3 * a), _orbit(b, b, b, 1 - 3 * b), _orbit(c, c, 0.5 - c, 0.5 - c)]
        weights = [0.11268792571801585, 0.073493043116361950, 0.042546020777081466]
    points = np.concatenate(orbits)[:, 1:]
    weight = np.concatenate([np.full(len(o), w) for o, w in zip(orbits, weights, strict=True)])
    return np.ascontiguousarray(points), weight / weight.sum() / 6.0


def triangle() -> tuple[Floats, Floats]:
    """Rule of degree 4 for the triangle: points (6, 2) and weights (6,) that sum to 1/2.

    Source: Dunavant, Int. J. Numer. Meth. Eng. 21 (1985).
    """
    a, b = 0.44594849091596489, 0.09157621350977074
    orbits = [_orbit(a, a, 1 - 2 * a), _orbit(b, b, 1 - 2 * b)]
    weight = np.repeat([0.22338158967801147, 0.10995174365532187], 3)
    return np.ascontiguousarray(np.concatenate(orbits)[:, 1:]), weight / weight.sum() / 2.0
