"""Rules for the part as a whole: closed, within the printer, standing without supports."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from export.printability.connected import connected_labels
from export.printability.findings import Finding, Point
from export.printability.measure import Measured
from export.printability.rays import Floats
from geometry.printers import PrinterProfile

ON_THE_BED_MM = 0.02
"""An underside this near to the lowest point rests on the printer."""


def manifold(measured: Measured) -> Iterator[Finding]:
    """Every edge joins exactly two triangles, and the triangles face outwards."""
    edges = measured.broken_edges
    if len(edges):
        words = ("the surface is not closed", "repair it, or export it again from the solid")
        yield Finding("manifold", len(edges), 0.0, "edges", point(edges[0].mean(axis=0)), "error", *words)
    elif measured.walls is None:
        words = ("the surface faces inwards or both ways", "turn its triangles round, or export it again")
        place = point(measured.surface.triangles_center[0])
        yield Finding("manifold", float(measured.surface.volume), 0.0, "mm3", place, "error", *words)


def size(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """The part stands within the build volume, its longer side along the longer side of the printer."""
    placed = measured.surface.vertices @ _printer_frame(measured.up).T
    extents = np.ptp(placed, axis=0)
    sides = sorted((profile["build_x_mm"], profile["build_y_mm"]), reverse=bool(extents[0] > extents[1]))
    room = np.array([*sides, profile["build_z_mm"]])
    axis = int(np.argmax(extents / room))
    if extents[axis] > room[axis]:
        place = point(measured.surface.vertices[np.argmax(placed[:, axis])])
        problem = f"{extents[axis]:.0f} mm is larger than the printer"
        advice = f"split it into pieces of at most {room[axis]:g} mm"
        yield Finding("size", float(extents[axis]), float(room[axis]), "mm", place, "error", problem, advice)


def overhang(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Undersides flatter than the printer can build on air; the largest connected one is reported."""
    area, place = _largest_overhang(measured, profile["overhang_deg"])
    limit = profile["overhang_area_mm2"]
    if area > limit:
        problem = f"{area:.2g} mm² of underside slope less than {profile['overhang_deg']:g} degrees"
        advice = "print it with supports, or turn the part so that this face lies on the printer"
        yield Finding("overhang", area, limit, "mm2", place, "warning", problem, advice)


def point(xyz: Any) -> Point:
    """Three plain numbers."""
    return float(xyz[0]), float(xyz[1]), float(xyz[2])


def _largest_overhang(measured: Measured, steepest_deg: float) -> tuple[float, Point]:
    """Area (mm2) and a point of the largest connected underside flatter than this, off the bed."""
    surface, up = measured.surface, measured.up
    heights = surface.vertices @ up
    off_the_bed = heights[surface.faces].max(axis=1) > heights.min() + ON_THE_BED_MM
    hanging = (surface.face_normals @ up < -np.cos(np.radians(steepest_deg))) & off_the_bed
    pairs = surface.face_adjacency[hanging[surface.face_adjacency].all(axis=1)]
    labels = connected_labels(pairs, len(surface.faces))
    areas = np.bincount(labels[hanging], surface.area_faces[hanging], minlength=labels.max() + 1)
    largest = hanging & (labels == np.argmax(areas))
    if not largest.any():
        return 0.0, (0.0, 0.0, 0.0)
    middles = surface.triangles_center[largest]
    mean = np.average(middles, axis=0, weights=surface.area_faces[largest])
    return float(areas.max()), point(middles[np.argmin(np.linalg.norm(middles - mean, axis=1))])


def _printer_frame(up: Floats) -> Floats:
    """Rows (3, 3): x and y of the printer and up; the drawing's own x and y where up is z."""
    across = np.eye(3)[1] if abs(up[1]) < 0.9 else np.eye(3)[2]
    x = np.cross(across, up)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(up, x), up])
