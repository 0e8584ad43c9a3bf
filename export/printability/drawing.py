"""A picture of the part with its findings marked."""

from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from export.printability.findings import Finding, Printability
from export.printability.surface import Floats, Rays, surface_of
from export.view import INK, WIDTH_IN, DrawnBody, View, picture_box, picture_page, render, save_png

VIEWS = tuple(View(azimuth, elevation) for elevation in (40.0, -30.0) for azimuth in (20.0, 110.0, 200.0, 290.0))
HIDDEN_DEPTH_SHARE = 0.03
"""A place that lies deeper than this, against the longest side of the part, is marked by a broken ring."""
SEVERITY_COLOURS = {"error": "#b5263b", "warning": "#d07a00", "note": "#2f6f9f"}
PART_COLOUR = "#d9d3c6"
RING_DIAMETER_IN, NUMBER_OFFSET_PT = 0.19, 22.0
LINE_CHARACTERS, FONT_PT = 36, 7.5
LINE_SHARE, PARAGRAPH_GAP_SHARE = 0.0235, 0.02
"""Height of a line and of the space between paragraphs, in parts of the page."""


def draw_findings(body: Any, printability: Printability, path: Path) -> Path:
    """Write a PNG of the part on which the place of every finding is marked; returns path.

    It is drawn from where the places are seen best; a broken ring says that a place lies behind what is seen.
    InputError without OpenGL.
    """
    import pyvista

    surface, findings = surface_of(body), printability.findings
    places = np.array([finding.place_mm for finding in findings]).reshape(-1, 3)
    view = clearest_view(surface, places)
    box = picture_box(view.flat(np.asarray(surface.vertices)))
    result = "cannot be printed" if not printability.printable else "needs care" if findings else "can be printed"
    figure, axes, pixels_per_mm = picture_page(box, f"{printability.label} by {printability.process.upper()}: {result}")
    axes.imshow(
        render([DrawnBody(pyvista.wrap(surface), PART_COLOUR)], view, box, pixels_per_mm), extent=box, aspect="equal"
    )
    hidden = buried_mm(surface, places, view) > HIDDEN_DEPTH_SHARE * max(surface.extents)
    for number, finding in enumerate(findings, 1):
        _mark_finding(axes, view, finding, number, "--" if hidden[number - 1] else "-")
    _write_list(figure, printability, bool(hidden.any()))
    save_png(figure, path)
    return path


def clearest_view(surface: Any, places_mm: Floats) -> View:
    """The view in which the places (n, 3) lie least deep behind the visible surface.

    Of views that differ by less than a tenth of the longest side, the first: from above where that will do.
    """
    step = 0.1 * max(surface.extents)
    return min(VIEWS, key=lambda view: round(float(buried_mm(surface, places_mm, view).sum()) / step))


def buried_mm(surface: Any, places_mm: Floats, view: View) -> Floats:
    """Depth (n,) in mm of each place behind the surface that the viewer sees there; 0 in front of it."""
    toward = np.broadcast_to(view.axes[2], places_mm.shape)
    away = 2 * float(np.linalg.norm(surface.extents))
    distance, _ = Rays(surface).first_hits(places_mm + away * toward, -toward, 2 * away)
    return np.maximum(np.where(np.isfinite(distance), away - distance, 0.0), 0.0)


def _mark_finding(axes: Any, view: View, finding: Finding, number: int, line: str) -> None:
    """Draw a ring at the place of a finding and its number beside it."""
    place = view.flat(np.array([finding.place_mm]))[0]
    colour = SEVERITY_COLOURS[finding.severity]
    axes.add_patch(_ring(axes, place, colour, line))
    turn = np.radians(36.0 * (2 - number))  # so that findings at one place keep their numbers apart
    offset = (NUMBER_OFFSET_PT * np.cos(turn), NUMBER_OFFSET_PT * np.sin(turn))
    label = {"boxstyle": "circle,pad=0.25", "facecolor": colour, "edgecolor": "none"}
    axes.annotate(
        str(number), place, xytext=offset, textcoords="offset points", color="white", fontsize=8,
        fontweight="bold", ha="center", va="center", bbox=label, arrowprops={"arrowstyle": "-", "color": colour},
    )  # fmt: skip


def _ring(axes: Any, place: Floats, colour: str, line: str) -> Any:
    """A circle of RING_DIAMETER_IN across."""
    from matplotlib.patches import Circle

    radius = RING_DIAMETER_IN / 2 / WIDTH_IN * float(np.diff(axes.get_xlim())[0])
    return Circle((place[0], place[1]), radius, fill=False, edgecolor=colour, linewidth=1.8, linestyle=line)


def _write_list(figure: Any, printability: Printability, some_hidden: bool) -> None:
    """Write the findings with their numbers, and the advice, at the right; smaller where there are many."""
    texts = [
        (f"{number}  {finding.rule}: {finding.problem}; {finding.advice}", SEVERITY_COLOURS[finding.severity])
        for number, finding in enumerate(printability.findings, 1)
    ]
    texts.append((f"Advice: {printability.advice if texts else 'no findings'}", INK))
    if some_hidden:
        texts.append(("Dashed ring: hidden behind the part", INK))
    paragraphs = [(wrap(text, LINE_CHARACTERS), colour) for text, colour in texts]
    scale = min(1.0, 0.82 / sum(LINE_SHARE * len(lines) + PARAGRAPH_GAP_SHARE for lines, _ in paragraphs))
    top = 0.87
    for lines, colour in paragraphs:
        text = "\n".join(lines)
        figure.text(0.735, top, text, fontsize=FONT_PT * scale, color=colour, va="top", linespacing=1.3)
        top -= scale * (LINE_SHARE * len(lines) + PARAGRAPH_GAP_SHARE)
