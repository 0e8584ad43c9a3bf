"""Newest-vertex bisection of a triangulation, with one boundary circle that new vertices are put on."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class Triangulation:
    """A labelled triangulation. points : (n, 2) mm; triangles : (m, 3), newest vertex first; part : (m,) label."""

    points: Floats
    triangles: Ints
    part: Ints


CENTRE_AT_ORIGIN = np.zeros((1, 2))


def refine(
    start: Triangulation,
    size: Callable[[Floats], Floats],
    circle_radius: float | None,
    centres: Floats = CENTRE_AT_ORIGIN,
) -> Triangulation:
    """Bisect until the longest edge of each triangle is at most the size at its centroid.

    circle_radius : the edges between different parts are arcs of this circle about the nearest of the centres (n, 2).
    """
    current = start
    while True:
        corner = current.points[current.triangles]
        longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
        marked = longest > size(corner.mean(axis=1)) * (1 + 1e-9)
        if not marked.any():
            return current
        current = _bisect(current, marked, circle_radius, centres)


def _bisect(old: Triangulation, marked: Bools, circle_radius: float | None, centres: Floats) -> Triangulation:
    """Cut every marked triangle at least once and close the triangulation (L. Chen, iFEM, 2009)."""
    edges, of_triangle = _triangle_edges(old.triangles)
    cut = np.zeros(len(edges), dtype=bool)
    cut[of_triangle[marked, 0]] = True
    while True:
        open_ones = cut[of_triangle].any(axis=1) & ~cut[of_triangle[:, 0]]
        if not open_ones.any():
            break
        cut[of_triangle[open_ones, 0]] = True
    points, middle = _cut_edges(old, edges, of_triangle, cut, circle_radius, centres)
    triangles, part = old.triangles, old.part
    for _ in range(2):  # the children's cut edges are edges of the old triangle, so twice is enough
        triangles, part, of_triangle = _halve_triangles(triangles, part, of_triangle, middle)
    return Triangulation(points, triangles, part)


def _triangle_edges(triangles: Ints) -> tuple[Ints, Ints]:
    """Unique edges (e, 2) and, for each triangle, the edges opposite to its three vertices (m, 3)."""
    pairs = np.sort(triangles[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
    edges, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    return edges, number.reshape(-1, 3)


def _cut_edges(
    old: Triangulation, edges: Ints, of_triangle: Ints, cut: Bools, circle_radius: float | None, centres: Floats
) -> tuple[Floats, Ints]:
    """All points with the new mid-points, and the number (e,) of each edge's mid-point, -1 where it is not cut."""
    middle = np.full(len(edges), -1, dtype=np.int64)
    middle[cut] = len(old.points) + np.arange(cut.sum())
    new = old.points[edges[cut]].mean(axis=1)
    if circle_radius is not None:
        low, high = np.full(len(edges), np.iinfo(np.int64).max), np.full(len(edges), -1, dtype=np.int64)
        for side in range(3):
            np.minimum.at(low, of_triangle[:, side], old.part)
            np.maximum.at(high, of_triangle[:, side], old.part)
        on_circle = (low != high)[cut]
        new[on_circle] = _onto_circle(new[on_circle], circle_radius, centres)
    return np.vstack([old.points, new]), middle


def _onto_circle(points: Floats, radius: float, centres: Floats) -> Floats:
    """Points (m, 2) moved onto the circle of this radius about the nearest centre."""
    away = points[:, None] - centres
    arm = away[np.arange(len(points)), np.linalg.norm(away, axis=2).argmin(axis=1)]
    return np.asarray(points + arm * (radius / np.linalg.norm(arm, axis=1, keepdims=True) - 1.0))


def _halve_triangles(triangles: Ints, part: Ints, of_triangle: Ints, middle: Ints) -> tuple[Ints, Ints, Ints]:
    """Cut triangles whose first edge is cut; return triangles, parts and edges of triangles.

    Halves know the old edges that they keep; their new edges have the number -1 and are not cut.
    """
    first = of_triangle[:, 0]
    new = np.where(first >= 0, middle[first], -1)
    keep, cut = new < 0, new >= 0
    a, b, c = triangles[cut].T
    _, edge_b, edge_c = of_triangle[cut].T
    none = np.full(len(a), -1, dtype=np.int64)
    left, right = np.stack([new[cut], a, b], axis=1), np.stack([new[cut], c, a], axis=1)
    left_edges, right_edges = np.stack([edge_c, none, none], axis=1), np.stack([edge_b, none, none], axis=1)
    return (
        np.vstack([triangles[keep], left, right]),
        np.concatenate([part[keep], part[cut], part[cut]]),
        np.vstack([of_triangle[keep], left_edges, right_edges]),
    )
