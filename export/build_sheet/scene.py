"""A few solids drawn in their places, with names and an outline."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from export.annotations import name_parts
from export.printability.surface import surface_of
from export.view import DPI, INK, Body, View, frame, page, render
from geometry.flat.pattern import Outline

ABOVE = View(28.0, 32.0)
FACET_DEG, SHARPNESS, MARGIN_PX = 25.0, 1.5, 30


@dataclass(frozen=True)
class Thing:
    """A closed pyvista surface in mm, its colour, and its name where it is to be written beside it."""

    surface: Any
    colour: str
    name: str = ""

    def lifted(self, by_mm: float) -> "Thing":
        """The same, higher."""
        return replace(self, surface=self.surface.translate((0.0, 0.0, by_mm), inplace=False))

    def moved(self, x_mm: float, y_mm: float) -> "Thing":
        """The same, elsewhere."""
        return replace(self, surface=self.surface.translate((x_mm, y_mm, 0.0), inplace=False))

    def cut_open(self, y_mm: float) -> "Thing":
        """Its half behind a plane of constant y, closed."""
        return replace(self, surface=self.surface.clip_closed_surface("y", origin=(0.0, y_mm, 0.0)))


def solid_thing(solid: Any, colour: str | tuple[float, float, float], name: str = "") -> Thing:
    """A build123d solid."""
    import pyvista

    if not isinstance(colour, str):
        colour = "#" + "".join(f"{round(255 * part):02x}" for part in colour)
    return Thing(pyvista.wrap(surface_of(solid)), colour, name)


def sheet_thing(outline: Outline, bottom_mm: float, thickness_mm: float, colour: str, name: str = "") -> Thing:
    """A flat outline with a thickness."""
    import pyvista

    points = np.array([(x, y, bottom_mm) for x, y in outline.points])
    flat = pyvista.PolyData(points, faces=[len(points), *range(len(points))]).triangulate()
    return Thing(flat.extrude((0.0, 0.0, thickness_mm), capping=True), colour, name)


def draw_things(things: Sequence[Thing], title: str, path: Path, view: View = ABOVE) -> None:
    """Write a PNG. InputError without OpenGL."""
    shown = [thing for thing in things if thing.surface.n_points]
    box = frame(np.vstack([view.flat(np.asarray(thing.surface.points)) for thing in shown]))
    figure, axes, pixels_per_mm = page(box, title)
    bodies = [Body(_shaded(thing.surface), thing.colour) for thing in shown]
    bodies += [Body(_edges(thing.surface, view), INK, 2.0) for thing in shown]
    limits = axes.get_xlim(), axes.get_ylim()
    image = render(bodies, view, box, SHARPNESS * pixels_per_mm)
    axes.imshow(image, extent=box, interpolation="antialiased", aspect="auto")
    axes.set_xlim(limits[0])
    axes.set_ylim(limits[1])
    named = [thing for thing in shown if thing.name]
    anchors = np.array([_anchor(thing.surface, view) for thing in named])
    column = box[1] + 0.03 * (limits[0][1] - limits[0][0])
    if named:
        name_parts(axes, [thing.name for thing in named], anchors, [thing.colour for thing in named], column)
    _save_cropped(figure, path)


def _save_cropped(figure: Any, path: Path) -> None:
    """Write a PNG without the empty upper and lower ends of the page."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.image import imsave

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    rows = np.flatnonzero((pixels[..., :3] < 255).any(axis=(1, 2)))
    imsave(path, pixels[max(rows[0] - MARGIN_PX, 0) : rows[-1] + MARGIN_PX], dpi=DPI)


def _shaded(surface: Any) -> Any:
    """Normals that keep sharp edges."""
    return surface.compute_normals(split_vertices=True, feature_angle=FACET_DEG, cell_normals=False)


def _edges(surface: Any, view: View) -> Any:
    """Sharp edges, a little towards the viewer."""
    edges = surface.clean().extract_feature_edges(
        feature_angle=FACET_DEG, manifold_edges=False, non_manifold_edges=False, boundary_edges=False
    )
    if edges.n_points:
        edges.points = np.asarray(edges.points) + 0.01 * view.axes[2]
    return edges


def _anchor(surface: Any, view: View) -> Any:
    """The rightmost corner of its top, which is seldom hidden."""
    points = np.asarray(surface.points)
    flat = view.flat(points[points[:, 2] > points[:, 2].max() - 1e-6])
    return flat[int(np.argmax(flat[:, 0]))]
