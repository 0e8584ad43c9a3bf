"""Measurements of a part, taken once for all printers."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from export.printability.bumps import Bump, bumps
from export.printability.findings import Point
from export.printability.surface import Chords, Floats, inner_chords, outer_chords, surface_of
from geometry.fabrication.part import LimitName, printer_names, printer_profile

THICKNESS_LIMITS: tuple[LimitName, ...] = ("wall_mm", "feature_mm", "gap_mm", "hole_mm")


@dataclass(frozen=True)
class Measured:
    """Measurements of a part. surface : trimesh.Trimesh; up : unit vector (3,) that points up on the printer.

    broken_edges : (n, 2, 3) ends of the edges that do not join exactly two triangles; with any, there is no
        inside, and walls, gaps and bumps are None.
    walls, gaps : chords through the material and through the air, as long as the largest limit of any printer.
    """

    surface: Any
    up: Floats
    broken_edges: Floats
    walls: Chords | None
    gaps: Chords | None
    bumps: list[Bump] | None


def measure(body: Any, up: Point) -> Measured:
    """Measure a build123d shape or a trimesh.Trimesh."""
    surface = surface_of(body)
    upward = np.array(up, dtype=np.float64) / np.linalg.norm(up)
    broken = _broken_edges(surface)
    if len(broken) or not surface.is_volume:
        return Measured(surface, upward, broken, None, None, None)
    reach = max(printer_profile(name)[limit] for name in printer_names() for limit in THICKNESS_LIMITS)
    walls, gaps = inner_chords(surface, reach), outer_chords(surface, reach)
    return Measured(surface, upward, broken, walls, gaps, bumps(surface))


def _broken_edges(surface: Any) -> Floats:
    edges, count = np.unique(surface.edges_sorted, axis=0, return_counts=True)
    return np.asarray(surface.vertices[edges[count != 2]])
