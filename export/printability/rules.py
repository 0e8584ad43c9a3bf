"""Rules for the part as a whole (closed, within the printer, standing) and for walls, pins, bumps, gaps, sizes."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from export.printability.findings import CriticalSize, Finding, Point, Severity
from export.printability.measure import Measured
from export.printability.surface import Chords, Floats, connected_labels
from geometry.fabrication.part import PrinterProfile

BED_TOLERANCE_MM = 0.02
"""An underside this near to the lowest point rests on the printer."""


def manifold(measured: Measured) -> Iterator[Finding]:
    """Report edges that do not join exactly two triangles, and triangles that face inwards."""
    edges = measured.broken_edges
    if len(edges):
        words = ("the surface is not closed", "repair it, or export it again from the solid")
        yield Finding("manifold", len(edges), 0.0, "edges", plain_point(edges[0].mean(axis=0)), "error", *words)
    elif measured.walls is None:
        words = ("the surface faces inwards or both ways", "turn its triangles round, or export it again")
        place = plain_point(measured.surface.triangles_center[0])
        yield Finding("manifold", float(measured.surface.volume), 0.0, "mm3", place, "error", *words)


def size(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report a part larger than the build volume, its longer side along the longer side of the printer."""
    placed = measured.surface.vertices @ _printer_frame(measured.up).T
    extents = np.ptp(placed, axis=0)
    sides = sorted((profile["build_x_mm"], profile["build_y_mm"]), reverse=bool(extents[0] > extents[1]))
    room = np.array([*sides, profile["build_z_mm"]])
    axis = int(np.argmax(extents / room))
    if extents[axis] > room[axis]:
        place = plain_point(measured.surface.vertices[np.argmax(placed[:, axis])])
        problem = f"{extents[axis]:.0f} mm is larger than the printer"
        advice = f"split it into pieces of at most {room[axis]:g} mm"
        yield Finding("size", float(extents[axis]), float(room[axis]), "mm", place, "error", problem, advice)


def overhang(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report undersides flatter than the printer can build on air, by the largest connected one."""
    area, place = _largest_overhang(measured, profile["overhang_deg"])
    limit = profile["overhang_area_mm2"]
    if area > limit:
        problem = f"{area:.2g} mm² of underside slope less than {profile['overhang_deg']:g} degrees"
        advice = "print it with supports, or turn the part so that this face lies on the printer"
        yield Finding("overhang", area, limit, "mm2", place, "warning", problem, advice)


def plain_point(xyz: Any) -> Point:
    """Three plain numbers of an array (3,)."""
    return float(xyz[0]), float(xyz[1]), float(xyz[2])


def _largest_overhang(measured: Measured, steepest_deg: float) -> tuple[float, Point]:
    """Area in mm2 and a point of the largest connected underside flatter than this, off the bed."""
    surface, up = measured.surface, measured.up
    heights = surface.vertices @ up
    off_the_bed = heights[surface.faces].max(axis=1) > heights.min() + BED_TOLERANCE_MM
    hanging = (surface.face_normals @ up < -np.cos(np.radians(steepest_deg))) & off_the_bed
    pairs = surface.face_adjacency[hanging[surface.face_adjacency].all(axis=1)]
    labels = connected_labels(pairs, len(surface.faces))
    areas = np.bincount(labels[hanging], surface.area_faces[hanging], minlength=labels.max() + 1)
    largest = hanging & (labels == np.argmax(areas))
    if not largest.any():
        return 0.0, (0.0, 0.0, 0.0)
    middles = surface.triangles_center[largest]
    mean = np.average(middles, axis=0, weights=surface.area_faces[largest])
    return float(areas.max()), plain_point(middles[np.argmin(np.linalg.norm(middles - mean, axis=1))])


def _printer_frame(up: Floats) -> Floats:
    """Rows (3, 3): x and y of the printer and up; the drawing's own x and y where up is z."""
    across = np.eye(3)[1] if abs(up[1]) < 0.9 else np.eye(3)[2]
    x = np.cross(across, up)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(up, x), up])


SLACK_MM = 1e-3
"""A wall drawn as thick as the limit is not too thin by the triangulation."""


def wall(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report walls thinner than a wall that stands free; a wall thinner than a held one cannot be printed."""
    if measured.walls is None:
        return
    chords, name = measured.walls, profile.process.upper()
    held, free = profile["supported_wall_mm"], profile["wall_mm"]
    thickness, place = _shortest_chord(chords, chords.cross_mm >= profile["feature_mm"])
    if thickness < held - SLACK_MM:
        problem = f"a wall of {_mm_text(thickness)} cannot be printed by {name}"
        advice = f"make it at least {_mm_text(held)} thick, or cast it"
        yield Finding("wall", thickness, held, "mm", place, "error", problem, advice)
    elif thickness < free - SLACK_MM:
        problem = f"a wall of {_mm_text(thickness)} prints by {name} only where it is held on two sides"
        advice = f"make it {_mm_text(free)} thick where it stands free"
        yield Finding("wall", thickness, free, "mm", place, "warning", problem, advice)


def feature(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report pins, ribs and bumps narrower than the smallest feature."""
    if measured.walls is None or measured.bumps is None:
        return
    chords, limit, name = measured.walls, profile["feature_mm"], profile.process.upper()
    pins = _shortest_chord(chords, chords.cross_mm < limit - SLACK_MM)
    width, place = min([pins, *((bump.width_mm, bump.top_mm) for bump in measured.bumps)])
    advice = f"make it at least {_mm_text(limit)} wide, or use a finer printer"
    if width < profile["supported_wall_mm"] - SLACK_MM:
        problem = f"a detail of {_mm_text(width)} cannot be printed by {name}"
        yield Finding("feature", width, limit, "mm", place, "error", problem, advice)
    elif width < limit - SLACK_MM:
        problem = f"a detail of {_mm_text(width)} will be rough with {name}"
        yield Finding("feature", width, limit, "mm", place, "warning", problem, advice)


def relief(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report bumps and dents lower than several layers."""
    lowest = min(measured.bumps or [], key=lambda bump: bump.height_mm, default=None)
    limit, layer = profile["relief_mm"], profile["layer_mm"]
    if lowest is None or lowest.height_mm >= limit - SLACK_MM:
        return
    layers = lowest.height_mm / layer
    severity: Severity = "error" if layers < 1 else "warning"
    problem = (
        f"a height of {_mm_text(lowest.height_mm)} is {layers:.1f} layers of {_mm_text(layer)}: a dome becomes steps"
    )
    advice = "use a printer with thinner layers"
    yield Finding("relief", lowest.height_mm, limit, "mm", lowest.top_mm, severity, problem, advice)


def gap(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Report the slot or hole that misses the width at which it stays open by most."""
    if measured.gaps is None:
        return
    chords, hole = measured.gaps, measured.gaps.cross_mm < profile["hole_mm"]
    found = [
        (width / limit, width, limit, place, kind)
        for kind, limit, chosen in (("slot", profile["gap_mm"], ~hole), ("hole", profile["hole_mm"], hole))
        for width, place in [_shortest_chord(chords, chosen)]
        if width < limit - SLACK_MM
    ]
    if found:
        _, width, limit, place, kind = min(found)
        advice = f"make it at least {_mm_text(limit)}, or open it with a drill or a blade"
        yield Finding("gap", width, limit, "mm", place, "warning", f"a {kind} of {_mm_text(width)} may close", advice)


def tolerance(sizes: Sequence[CriticalSize], profile: PrinterProfile) -> Iterator[Finding]:
    """Report sizes that may be off by less than the printer is off."""
    off = profile["deviation_mm"]
    for size in sizes:
        if size.deviation_mm < off:
            problem = (
                f"{size.name} of {_mm_text(size.nominal_mm)} may be off by {_mm_text(size.deviation_mm)}, "
                f"{profile.process.upper()} is off by up to {_mm_text(off)}"
            )
            advice = "measure the print and correct the size that is asked for"
            yield Finding("tolerance", size.deviation_mm, off, "mm", size.place_mm, "warning", problem, advice)


def _shortest_chord(chords: Chords, chosen: NDArray[np.bool_]) -> tuple[float, Point]:
    """Length and middle of the shortest of the chosen chords, which are sorted; infinite where none is chosen."""
    where = np.flatnonzero(chosen)
    if len(where) == 0:
        return np.inf, (0.0, 0.0, 0.0)
    return float(chords.length_mm[where[0]]), plain_point(chords.middle_mm[where[0]])


def _mm_text(value: float) -> str:
    return f"{value:.2g} mm"
