"""What electrodes collect from a film, also of the elements that their edges cut.

An electrode is a polygon in the plane of the film, taken as convex pieces, and the elements do not follow its edges.
The part of an element under a piece is clipped exactly: each half-space leaves tetrahedra of a tetrahedron. An integral
over that part is a sum over the quadrature points of the element, with weights that are exact for linear functions:
moment fitting (Müller, Kummer and Oberlack, Int. J. Numer. Meth. Eng. 96, 2013, 512-528), here with the least change
of weights.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from geometry.polygons import convex_pieces
from mesh.types import signed_volumes, split_prisms

PRISM = split_prisms(np.array([[0, 1, 2]]), np.array([[3, 4, 5]]))
"""Three tetrahedra of a prism, by its corners."""


@dataclass(frozen=True)
class Coverage:
    """Pairs of an element and an electrode over some of it: their numbers (k,), and the weights (k, q) of the covered
    volume at the quadrature points of the element. electrodes : how many there are.
    """

    element: Ints
    electrode: Ints
    weight: Floats
    electrodes: int

    def integral(self, density: Floats) -> Floats:
        """Integral (e,) of a density at the quadrature points (m, q) over the volume under each electrode."""
        part = (density[self.element] * self.weight).sum(axis=1)
        return np.bincount(self.electrode, part, self.electrodes).astype(np.float64)

    def volume(self) -> Floats:
        """Volume (e,) under each electrode."""
        return np.bincount(self.electrode, self.weight.sum(axis=1), self.electrodes).astype(np.float64)


def electrode_pieces(outlines: Sequence[Floats]) -> list[list[Floats]]:
    """Convex pieces, corners (h, 2) counter-clockwise, of each outline (c, 2)."""
    return [[np.array(piece) for piece in convex_pieces([(float(x), float(y)) for x, y in one])] for one in outlines]


def _half_planes(corners: Floats) -> Floats:
    """Half-planes (h, 3) to the left of the edges of a convex polygon (h, 2).

    A point p lies in the half-plane (n1, n2, c) where n . p > c; n is of unit length.
    """
    along = np.roll(corners, -1, axis=0) - corners
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    return np.column_stack([normal, (normal * corners).sum(axis=1)])


def electrode_over(points: Floats, pieces: Sequence[Sequence[Floats]]) -> Ints:
    """Index of the electrode over each point (n, 3), -1 for bare film. pieces : of electrode_pieces."""
    index = np.full(len(points), -1)
    for number, convex in enumerate(pieces):
        for piece in convex:
            index[np.all([_distance(points, plane) >= 0.0 for plane in _half_planes(piece)], axis=0)] = number
    return index


def _distance(points: Floats, plane: Floats) -> Floats:
    """Distance (...,) of points (..., 3) from the edge of a half-plane (3,), positive inside."""
    return np.asarray(points[..., 0] * plane[0] + points[..., 1] * plane[1] - plane[2])


def coverage(corners: Floats, points: Floats, weight: Floats, pieces: Sequence[Sequence[Floats]]) -> Coverage:
    """Coverage by electrodes, the convex pieces of each, of straight elements with corners (m, 4, 3), quadrature points
    (m, q, 3) and weights (m, q).
    """
    every = [(number, piece) for number, convex in enumerate(pieces) for piece in convex]
    found = [_elements_under(corners, points, weight, piece) for _, piece in every]
    electrode = np.repeat([number for number, _ in every], [len(element) for element, _ in found])
    element, covered = (np.concatenate(each) for each in zip(*found, strict=True))
    return Coverage(element, electrode, covered, len(pieces))


def _elements_under(corners: Floats, points: Floats, weight: Floats, piece: Floats) -> tuple[Ints, Floats]:
    """Elements under a convex piece of metal (h, 2): their numbers (k,) and weights (k, q)."""
    touched, whole = _touched(corners, _half_planes(piece))
    cut = np.flatnonzero(touched & ~whole)
    fan = [np.array([piece[0], *edge]) for edge in pairwise(piece[1:])]
    parts = [_parts_under(corners[cut], triangle) for triangle in fan]
    tetrahedra, owner = (np.concatenate(each) for each in zip(*parts, strict=True))
    fitted = _fit_weights(points[cut], weight[cut], tetrahedra, owner)
    return np.concatenate([np.flatnonzero(whole), cut]), np.concatenate([weight[whole], fitted])


def _touched(corners: Floats, planes: Floats) -> tuple[Bools, Bools]:
    """Whether each element (m, 4, 3) may have a part, and whether it lies as a whole, in half-planes (h, 3); (m,)."""
    touched, whole = np.ones((2, len(corners)), dtype=bool)
    for plane in planes:
        distance = _distance(corners, plane)
        touched &= (distance > 0.0).any(axis=1)
        whole &= (distance >= 0.0).all(axis=1)
    return touched, whole


def _parts_under(corners: Floats, triangle: Floats) -> tuple[Floats, Ints]:
    """Tetrahedra (k, 4, 3) of the parts of elements (m, 4, 3) under a triangle (3, 2), and the element (k,) of each."""
    planes = _half_planes(triangle)
    owner = np.flatnonzero(_touched(corners, planes)[0])
    parts = corners[owner]
    for plane in planes:
        parts, owner = _clip(parts, owner, _distance(parts, plane))
    return parts, owner


def _clip(corners: Floats, owner: Ints, distance: Floats) -> tuple[Floats, Ints]:
    """Tetrahedra (k, 4, 3) of the parts where the distances (n, 4) of corners (n, 4, 3) are positive, with the owners
    (k,) of those that they are parts of.
    """
    order = np.argsort(-distance, axis=1)
    corner, height = np.take_along_axis(corners, order[..., None], axis=1), np.take_along_axis(distance, order, axis=1)
    inside = (height > 0.0).sum(axis=1)

    def on_edge(chosen: Ints, i: int, j: int) -> Floats:
        share = height[chosen, i] / (height[chosen, i] - height[chosen, j])
        return np.asarray(corner[chosen, i] + share[:, None] * (corner[chosen, j] - corner[chosen, i]))

    one, two, three, four = (np.flatnonzero(inside == count) for count in (1, 2, 3, 4))
    tip = [corner[one, 0], *(on_edge(one, 0, j) for j in (1, 2, 3))]
    wedge = [
        corner[two, 0],
        on_edge(two, 0, 2),
        on_edge(two, 0, 3),
        corner[two, 1],
        on_edge(two, 1, 2),
        on_edge(two, 1, 3),
    ]
    stump = [*(corner[three, i] for i in range(3)), *(on_edge(three, i, 3) for i in range(3))]
    prisms = [np.stack(six, axis=1)[:, PRISM].reshape(-1, 4, 3) for six in (wedge, stump)]
    owners = [owner[four], owner[one], *(np.repeat(owner[each], len(PRISM)) for each in (two, three))]
    return np.concatenate([corner[four], np.stack(tip, axis=1), *prisms]), np.concatenate(owners)


def _fit_weights(points: Floats, weight: Floats, pieces: Floats, owner: Ints) -> Floats:
    """Weights (n, q) at points (n, q, 3) of elements, with the volume and the first moments of the pieces (k, 4, 3)."""
    middle = points.mean(axis=1, keepdims=True)
    size = np.abs(points - middle).max(axis=1, keepdims=True, initial=0.0)
    volume = np.abs(signed_volumes(pieces.reshape(-1, 3), np.arange(4 * len(pieces)).reshape(-1, 4)))
    place = (pieces.mean(axis=1) - middle[owner, 0]) / size[owner, 0]
    moments = np.stack(
        [np.bincount(owner, volume * one, len(points)) for one in (np.ones(len(place)), *place.T)], axis=1
    )
    linear = np.concatenate([np.ones((*weight.shape, 1)), (points - middle) / size], axis=2)
    in_share = weight * (moments[:, :1] / weight.sum(axis=1, keepdims=True))
    missing = moments - np.einsum("nqi,nq->ni", linear, in_share)
    normal = np.einsum("nqi,nq,nqj->nij", linear, weight, linear)
    return np.asarray(
        in_share + weight * np.einsum("nqi,ni->nq", linear, np.linalg.solve(normal, missing[..., None])[..., 0])
    )
