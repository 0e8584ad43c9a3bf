"""What electrodes collect from a film, also of the elements that their edges cut.

An electrode is a rectangle in the plane of the film, and the elements do not follow its edges. The part of an element
under it is clipped exactly: each half-space leaves tetrahedra of a tetrahedron. An integral over that part is a sum
over the quadrature points of the element, with weights that are exact for linear functions: moment fitting (Müller,
Kummer and Oberlack, Int. J. Numer. Meth. Eng. 96, 2013, 512-528), here with the least change of weights.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
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


def coverage(corners: Floats, points: Floats, weight: Floats, rectangles: Floats) -> Coverage:
    """Coverage by rectangles (e, 4) x0, x1, y0, y1 of straight elements with corners (m, 4, 3), quadrature points
    (m, q, 3) and weights (m, q).
    """
    found = [_elements_under(corners, points, weight, rectangle) for rectangle in rectangles]
    electrode = np.repeat(np.arange(len(rectangles)), [len(element) for element, _ in found])
    element, covered = (np.concatenate(each) for each in zip(*found, strict=True))
    return Coverage(element, electrode, covered, len(rectangles))


def _elements_under(corners: Floats, points: Floats, weight: Floats, rectangle: Floats) -> tuple[Ints, Floats]:
    """Elements under a rectangle x0, x1, y0, y1, (k,), and their weights (k, q)."""
    low, high = corners.min(axis=1)[:, :2], corners.max(axis=1)[:, :2]
    start, end = rectangle[0::2], rectangle[1::2]
    touched = ((high > start) & (low < end)).all(axis=1)
    whole = ((low >= start) & (high <= end)).all(axis=1)
    cut = np.flatnonzero(touched & ~whole)
    pieces, owner = corners[cut], np.arange(len(cut))
    for axis, side, sign in ((0, start, 1.0), (0, end, -1.0), (1, start, 1.0), (1, end, -1.0)):
        if np.isfinite(side[axis]):
            pieces, owner = _clip(pieces, owner, sign * (pieces[..., axis] - side[axis]))
    fitted = _fit_weights(points[cut], weight[cut], pieces, owner)
    return np.concatenate([np.flatnonzero(whole), cut]), np.concatenate([weight[whole], fitted])


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
