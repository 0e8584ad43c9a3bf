"""Small round bumps and dents of a part: curved faces that stand on, or are sunk into, one flat rim."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from export.printability.surface import Floats, connected_labels

SMOOTH_ANGLE_RAD = np.radians(18.0)
"""Facets that meet at less belong to one face: more than inside a curved face (export/printability/measure.py),
less than at the rim of the flattest dots, 28 degrees for 0.2 mm on 1.6 mm."""
ROUND_SPREAD_RAD = np.radians(1.0)
"""A face whose normals spread by less is flat."""


@dataclass(frozen=True)
class Bump:
    """A curved face that stands on, or is sunk into, one flat rim.

    width_mm : smallest extent of its rim; height_mm : how far it rises over the rim, or sinks below it.
    top_mm : (x, y, z) of the point farthest from the rim.
    """

    width_mm: float
    height_mm: float
    top_mm: tuple[float, float, float]


def bumps(surface: Any) -> list[Bump]:
    """All bumps and dents of a trimesh.Trimesh."""
    found = (_bump_of_face(surface, faces) for faces in _smooth_faces(surface))
    return [bump for bump in found if bump is not None]


def _smooth_faces(surface: Any) -> list[Any]:
    """Numbers of the triangles of each face, as sharp edges separate faces."""
    smooth = surface.face_adjacency[surface.face_adjacency_angles < SMOOTH_ANGLE_RAD]
    labels = connected_labels(smooth, len(surface.faces))
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(labels[order])) + 1)


def _bump_of_face(surface: Any, faces: Any) -> Bump | None:
    """The bump of one face; None where the face is flat or its rim does not lie in a plane."""
    normals = surface.face_normals[faces]
    mean = normals.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6 or (normals @ normals[0]).min() > np.cos(ROUND_SPREAD_RAD):
        return None
    points, rim = _points_and_rim(surface, faces)
    if len(rim) < 3:
        return None
    axes, spread = _principal_axes(rim)
    heights = (points - rim.mean(axis=0)) @ axes[2]
    # a rim that is not plane, or a face that goes on beyond its rim on both sides, is no bump
    if spread[2] > 0.02 * spread[1] or min(heights.max(), -heights.min()) > 0.02 * np.ptp(heights):
        return None
    top = points[np.argmax(np.abs(heights))]
    return Bump(float(spread[1]), float(np.ptp(heights)), (float(top[0]), float(top[1]), float(top[2])))


def _points_and_rim(surface: Any, faces: Any) -> tuple[Floats, Floats]:
    """All corners (n, 3) of some triangles, and those (m, 3) on edges that only one of them has."""
    corners = surface.faces[faces]
    edges = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    single, count = np.unique(edges, axis=0, return_counts=True)
    rim = np.unique(single[count == 1])
    return surface.vertices[np.unique(corners)], surface.vertices[rim]


def _principal_axes(points: Floats) -> tuple[Floats, Floats]:
    """Rows (3, 3): axes of decreasing extent; and the extents (3,)."""
    centred = points - points.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    return axes, np.ptp(centred @ axes.T, axis=0)
