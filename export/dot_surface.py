"""The surface of the rigid dot and its plate as triangles, for ParaView, pictures and the 3D view."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from mesh.types import TetMesh

PLATE_THICKNESS_MM = 0.2
"""Thickness of the drawn plate; that of the real one is of no consequence."""


@dataclass(frozen=True)
class DotPart:
    """One closed surface: points_mm (v, 3) in the dot frame, triangles (t, 3) with outward normals."""

    points_mm: Floats
    triangles: Ints


def dot_parts(dot_shape: DotShape, half_size_mm: tuple[float, float], facets: int = 48) -> list[DotPart]:
    """Closed surfaces of every dot and of their plate in the dot frame.

    half_size_mm : half of the plate's drawn size in x and y about the pressed dot; dots beyond it widen it.
    facets : edges around a circle.
    """
    half = np.asarray(half_size_mm)
    if dot_shape.kind == "plate":
        return [_plate_box(-half, half, 0.0)]
    reach = 1.1 * np.array([1.0, 0.0 if dot_shape.kind == "ridge" else 1.0]) * dot_shape.base_diameter_mm / 2
    centers = dot_shape.tips_mm[:, :2]
    low, high = np.minimum(-half, centers.min(axis=0) - reach), np.maximum(half, centers.max(axis=0) + reach)
    profiles = [_meridian(dot_shape, tip[2], facets // 2) for tip in dot_shape.tips_mm]
    if dot_shape.kind == "ridge":
        dots = [
            _extrude_profile(profile, x, low[1], high[1]) for profile, (x, _) in zip(profiles, centers, strict=True)
        ]
    else:
        dots = [_revolve_profile(profile, center, facets) for profile, center in zip(profiles, centers, strict=True)]
    return [*dots, _plate_box(low, high, dot_shape.height_mm)]


def placed_dot(dot_shape: DotShape, tet_mesh: TetMesh, origin_mm: Floats, facets: int = 48) -> list[Any]:
    """The parts of the dot as pyvista surfaces in the segment frame, the plate wider than the segment."""
    half = np.ptp(tet_mesh.points_mm, axis=0)[:2] * 0.55
    return [
        triangle_surface(in_segment_frame(dot_shape, part.points_mm, origin_mm), part.triangles)
        for part in dot_parts(dot_shape, (float(half[0]), float(half[1])), facets)
    ]


def triangle_surface(points_mm: Floats, triangles: Ints) -> Any:
    """A pyvista surface of points (v, 3) and triangles (t, 3)."""
    import pyvista

    return pyvista.PolyData.from_regular_faces(points_mm, triangles)  # type: ignore[arg-type]


def in_segment_frame(dot_shape: DotShape, points_mm: Floats, origin_mm: Floats) -> Floats:
    """Points (v, 3) of the dot frame in the segment frame, the dot's origin at origin_mm; in mm."""
    return np.asarray(origin_mm + points_mm @ dot_shape.rotation.T)


def _meridian(dot_shape: DotShape, tip_mm: float, count: int) -> Floats:
    """Meridian (p, 2) from a tip at z = tip_mm to the plate, radius and z in mm."""
    if dot_shape.profile is not None:
        return dot_shape.profile.meridian_mm(count)
    radius, height = dot_shape.radius_mm, dot_shape.height_mm - tip_mm
    opening = np.arccos(1 - min(height, radius) / radius)
    angle = np.linspace(0.0, opening, count)
    arc = np.column_stack([radius * np.sin(angle), tip_mm + radius * (1 - np.cos(angle))])
    if height <= radius:
        return arc
    return np.vstack([arc, [radius, dot_shape.height_mm]])


def _revolve_profile(profile: Floats, center: Floats, facets: int) -> DotPart:
    """The profile turned about the z axis through center and closed by a disc at its end."""
    angle = np.arange(facets) * 2 * np.pi / facets
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    rings = [np.column_stack([center + r * ring, np.full(facets, z)]) for r, z in profile[1:]]
    tip, lid = np.append(center, profile[0, 1]), np.append(center, profile[-1, 1])
    a = np.arange(facets)
    b = np.roll(a, -1)
    triangles = [np.column_stack([np.zeros(facets, int), 1 + b, 1 + a])]
    for k in range(len(rings) - 1):
        low, high = 1 + k * facets, 1 + (k + 1) * facets
        triangles += [
            np.column_stack([low + a, low + b, high + b]),
            np.column_stack([low + a, high + b, high + a]),
        ]
    last = 1 + (len(rings) - 1) * facets
    triangles.append(np.column_stack([last + a, last + b, np.full(facets, 1 + len(rings) * facets)]))
    return DotPart(np.vstack([tip, *rings, lid]), np.vstack(triangles).astype(np.int64))


def _extrude_profile(profile: Floats, center_x: float, front_y: float, back_y: float) -> DotPart:
    """The profile, mirrored in x, drawn out along y over the plate's width and closed at both ends."""
    outline = np.vstack([profile[:0:-1] * [-1, 1], profile])
    count = len(outline)
    front, back = (
        np.column_stack([center_x + outline[:, 0], np.full(count, y), outline[:, 1]]) for y in (front_y, back_y)
    )
    a = np.arange(count)
    b = np.roll(a, -1)
    sides = [np.column_stack([a, count + b, b]), np.column_stack([a, count + a, count + b])]
    inner = np.arange(1, count - 1)
    ends = [
        np.column_stack([np.zeros_like(inner), inner, inner + 1]),
        count + np.column_stack([np.zeros_like(inner), inner + 1, inner]),
    ]
    return DotPart(np.vstack([front, back]), np.vstack([*sides, *ends]).astype(np.int64))


def _plate_box(low: Floats, high: Floats, bottom: float) -> DotPart:
    """The plate as a box with its face at z = bottom."""
    foot = np.where([[0, 0], [1, 0], [1, 1], [0, 1]], high, low)
    points = np.vstack([np.column_stack([foot, np.full(4, bottom + z)]) for z in (0.0, PLATE_THICKNESS_MM)])
    quads = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    return DotPart(points, np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int64))
