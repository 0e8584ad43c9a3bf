"""Quadrature of the reference tetrahedron and triangle."""

from itertools import permutations

import numpy as np

from foundation.arrays import Floats


def _orbit(*barycentric: float) -> Floats:
    """Points (k, len) of all distinct permutations of a barycentric point."""
    return np.array(sorted(set(permutations(barycentric))))


def tetrahedron() -> tuple[Floats, Floats]:
    """Rule of degree 3 for the tetrahedron: points (8, 3) and weights (8,) that sum to 1/6.

    Curved quadratic elements need at least this degree. Source: Witherden and Vincent, Comput. Math. Appl. 69 (2015).
    """
    a, b = 0.32816330251638171, 0.10804724989842859
    orbits = [_orbit(a, a, a, 1 - 3 * a), _orbit(b, b, b, 1 - 3 * b)]
    weight = np.repeat([0.13621784253708741, 0.11378215746291261], 4)
    return np.ascontiguousarray(np.concatenate(orbits)[:, 1:]), weight / weight.sum() / 6.0


def triangle() -> tuple[Floats, Floats]:
    """Rule of degree 4 for the triangle: points (6, 2) and weights (6,) that sum to 1/2.

    Source: Dunavant, Int. J. Numer. Meth. Eng. 21 (1985).
    """
    a, b = 0.44594849091596489, 0.09157621350977074
    orbits = [_orbit(a, a, 1 - 2 * a), _orbit(b, b, 1 - 2 * b)]
    weight = np.repeat([0.22338158967801147, 0.10995174365532187], 3)
    return np.ascontiguousarray(np.concatenate(orbits)[:, 1:]), weight / weight.sum() / 2.0
