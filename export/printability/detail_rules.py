"""Rules for details: walls, pins, bumps, gaps, and sizes that must come out right."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from export.printability.body_rules import point
from export.printability.chords import Chords
from export.printability.findings import CriticalSize, Finding, Point, Severity
from export.printability.measure import Measured
from geometry.printers import PrinterProfile

SLACK_MM = 1e-3
"""A wall drawn as thick as the limit is not too thin by the triangulation."""


def wall(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Walls at least as thick as a wall that stands free; thinner than a held one cannot be printed."""
    if measured.walls is None:
        return
    chords, name = measured.walls, profile.process.upper()
    held, free = profile["supported_wall_mm"], profile["wall_mm"]
    thickness, place = _shortest(chords, chords.cross_mm >= profile["feature_mm"])
    if thickness < held - SLACK_MM:
        problem = f"a wall of {_mm(thickness)} cannot be printed by {name}"
        advice = f"make it at least {_mm(held)} thick, or cast it"
        yield Finding("wall", thickness, held, "mm", place, "error", problem, advice)
    elif thickness < free - SLACK_MM:
        problem = f"a wall of {_mm(thickness)} prints by {name} only where it is held on two sides"
        advice = f"make it {_mm(free)} thick where it stands free"
        yield Finding("wall", thickness, free, "mm", place, "warning", problem, advice)


def feature(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Pins, ribs and bumps at least as wide as the smallest feature."""
    if measured.walls is None or measured.bumps is None:
        return
    chords, limit, name = measured.walls, profile["feature_mm"], profile.process.upper()
    pins = _shortest(chords, chords.cross_mm < limit - SLACK_MM)
    width, place = min([pins, *((bump.width_mm, bump.top_mm) for bump in measured.bumps)])
    advice = f"make it at least {_mm(limit)} wide, or use a finer printer"
    if width < profile["supported_wall_mm"] - SLACK_MM:
        problem = f"a detail of {_mm(width)} cannot be printed by {name}"
        yield Finding("feature", width, limit, "mm", place, "error", problem, advice)
    elif width < limit - SLACK_MM:
        problem = f"a detail of {_mm(width)} will be rough with {name}"
        yield Finding("feature", width, limit, "mm", place, "warning", problem, advice)


def relief(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Bumps and dents high enough to be built of several layers."""
    lowest = min(measured.bumps or [], key=lambda bump: bump.height_mm, default=None)
    limit, layer = profile["relief_mm"], profile["layer_mm"]
    if lowest is None or lowest.height_mm >= limit - SLACK_MM:
        return
    layers = lowest.height_mm / layer
    severity: Severity = "error" if layers < 1 else "warning"
    problem = f"a height of {_mm(lowest.height_mm)} is {layers:.1f} layers of {_mm(layer)}: a dome becomes steps"
    advice = "use a printer with thinner layers"
    yield Finding("relief", lowest.height_mm, limit, "mm", lowest.top_mm, severity, problem, advice)


def gap(measured: Measured, profile: PrinterProfile) -> Iterator[Finding]:
    """Slots and holes wide enough to stay open; the one that misses its limit by most is reported."""
    if measured.gaps is None:
        return
    chords, hole = measured.gaps, measured.gaps.cross_mm < profile["hole_mm"]
    found = [
        (width / limit, width, limit, place, kind)
        for kind, limit, chosen in (("slot", profile["gap_mm"], ~hole), ("hole", profile["hole_mm"], hole))
        for width, place in [_shortest(chords, chosen)]
        if width < limit - SLACK_MM
    ]
    if found:
        _, width, limit, place, kind = min(found)
        advice = f"make it at least {_mm(limit)}, or open it with a drill or a blade"
        yield Finding("gap", width, limit, "mm", place, "warning", f"a {kind} of {_mm(width)} may close", advice)


def tolerance(sizes: Sequence[CriticalSize], profile: PrinterProfile) -> Iterator[Finding]:
    """Sizes that may be off by less than the printer is off."""
    off = profile["deviation_mm"]
    for size in sizes:
        if size.deviation_mm < off:
            problem = (
                f"{size.name} of {_mm(size.nominal_mm)} may be off by {_mm(size.deviation_mm)}, "
                f"{profile.process.upper()} is off by up to {_mm(off)}"
            )
            advice = "measure the print and correct the size that is asked for"
            yield Finding("tolerance", size.deviation_mm, off, "mm", size.place_mm, "warning", problem, advice)


def _shortest(chords: Chords, chosen: NDArray[np.bool_]) -> tuple[float, Point]:
    """Length and middle of the first, which is the shortest, of the chosen chords; infinite where none is."""
    where = np.flatnonzero(chosen)
    if len(where) == 0:
        return np.inf, (0.0, 0.0, 0.0)
    return float(chords.length_mm[where[0]]), point(chords.middle_mm[where[0]])


def _mm(value: float) -> str:
    return f"{value:.2g} mm"
