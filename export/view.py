"""A straight (orthographic) view of the segment: VTK draws the bodies, matplotlib all that is written around them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from export.rendering import ensure_rendering
from foundation.arrays import Floats

WIDTH_IN, HEIGHT_IN, DPI = 8.0, 6.0, 200
PICTURE_SIZE_PX = (int(WIDTH_IN * DPI), int(HEIGHT_IN * DPI))
"""Pixels of every picture, width and height."""
MARGIN_SHARES = {"left": 0.12, "right": 0.28, "bottom": 0.13, "top": 0.11}
INK = "#26303a"


@dataclass(frozen=True)
class View:
    """Direction of the view: turned by azimuth_deg from -y towards +x, lifted by elevation_deg."""

    azimuth_deg: float
    elevation_deg: float

    @property
    def axes(self) -> tuple[Floats, Floats, Floats]:
        """Unit vectors to the right, upwards and towards the viewer."""
        a, e = np.radians([self.azimuth_deg, self.elevation_deg])
        right = np.array([np.cos(a), np.sin(a), 0.0])
        toward = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
        return right, np.cross(toward, right), toward

    def flat(self, points_mm: Floats) -> Floats:
        """Points (n, 3) projected onto the picture, (n, 2) mm."""
        right, up, _ = self.axes
        return np.asarray(points_mm @ np.column_stack([right, up]))


@dataclass(frozen=True)
class DrawnBody:
    """A body to draw: a pyvista surface, its colour (None: its "rgb" array), line width (0: filled)."""

    surface: Any
    colour: str | None
    line_width: float = 0.0


def picture_box(flat_mm: Floats) -> tuple[float, float, float, float]:
    """Left, right, bottom and top in mm around flat points (n, 2), with a margin of 2 % of the longer side."""
    low, high = flat_mm.min(axis=0), flat_mm.max(axis=0)
    extra = 0.02 * (high - low).max()
    return low[0] - extra, high[0] + extra, low[1] - extra, high[1] + extra


def render(
    bodies: list[DrawnBody],
    view: View,
    box: tuple[float, float, float, float],
    pixels_per_mm: float,
    smooth_edges: bool = True,
) -> Any:
    """Image (h, w, 3) uint8 of what lies inside box (mm on the picture). InputError without OpenGL.

    smooth_edges : not needed where more pixels are drawn than shown; without a graphics card it takes half the time.
    """

    ensure_rendering()
    import pyvista

    left, right, bottom, top = box
    size = (max(1, round((right - left) * pixels_per_mm)), max(1, round((top - bottom) * pixels_per_mm)))
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size), lighting="light kit")
    if not smooth_edges:
        plotter.disable_anti_aliasing()
    plotter.background_color = pyvista.Color("white")
    flat_light = view.elevation_deg == 0
    for body in bodies:
        _add_body(plotter, body, flat_light)
    _aim_camera(plotter.camera, view, box)
    plotter.reset_camera_clipping_range()
    image = plotter.screenshot(None, return_img=True)
    plotter.close()
    return image


def _add_body(plotter: Any, body: DrawnBody, flat_light: bool) -> None:
    """Add filled surfaces in soft light (none at all in a straight front view), lines in ink."""
    if body.surface.n_points == 0:
        return
    flat = flat_light or body.line_width > 0
    light: dict[str, Any] = {"lighting": False} if flat else {"ambient": 0.6, "diffuse": 0.5, "specular": 0.0}
    if body.line_width:
        light["line_width"] = body.line_width
    if body.colour is None:
        plotter.add_mesh(body.surface, scalars="rgb", rgb=True, show_scalar_bar=False, **light)
    else:
        plotter.add_mesh(body.surface, color=body.colour, **light)


def _aim_camera(camera: Any, view: View, box: tuple[float, float, float, float]) -> None:
    """Aim a parallel camera so that the window is exactly the box."""
    right, up, toward = view.axes
    left, right_end, bottom, top = box
    focus = right * (left + right_end) / 2 + up * (bottom + top) / 2
    camera.parallel_projection = True
    camera.focal_point = focus
    camera.position = focus + 100.0 * toward
    camera.up = up
    camera.parallel_scale = (top - bottom) / 2


def picture_page(
    box: tuple[float, float, float, float], title: str, least_height_in: float = HEIGHT_IN
) -> tuple[Any, Any, float]:
    """A white page whose coordinates are mm on the picture, with room for writing around box.

    It has PICTURE_SIZE_PX, and is lower, down to least_height_in, where box is so flat that most of it would be empty.
    Returns figure, axes and pixels per mm.
    """
    from matplotlib.figure import Figure

    left, right, bottom, top = box
    margins_in = {side: MARGIN_SHARES[side] * HEIGHT_IN for side in ("bottom", "top")}
    width_in = (1 - MARGIN_SHARES["left"] - MARGIN_SHARES["right"]) * WIDTH_IN
    inch_per_mm = min(width_in / (right - left), (HEIGHT_IN - sum(margins_in.values())) / (top - bottom))
    needed_in = (top - bottom) * inch_per_mm + sum(margins_in.values())
    height_in = min(max(needed_in, least_height_in), HEIGHT_IN)
    figure = Figure(figsize=(WIDTH_IN, height_in), dpi=DPI, facecolor="white")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    span = np.array([WIDTH_IN, height_in]) / inch_per_mm
    x0 = (left + right) / 2 - span[0] * (MARGIN_SHARES["left"] + (1 - MARGIN_SHARES["right"])) / 2
    y0 = (bottom + top) / 2 - (margins_in["bottom"] + height_in - margins_in["top"]) / inch_per_mm / 2
    axes.set_xlim(x0, x0 + span[0])
    axes.set_ylim(y0, y0 + span[1])
    title_in = 0.045 * HEIGHT_IN
    figure.text(0.04, 1 - title_in / height_in, title, fontsize=15, fontweight="bold", color=INK, va="center")
    return figure, axes, inch_per_mm * DPI


def save_png(figure: Any, path: Any) -> None:
    """Write a PNG of the figure's full size."""
    figure.savefig(path, dpi=DPI, facecolor="white", pil_kwargs={"compress_level": 3})  # half the time of the usual 6


def draw_ruler(axes: Any, view: View, start_mm: Floats, end_mm: Floats, name: str, away: Floats) -> None:
    """Draw ticks in mm along the edge from start to end (3,), which run along one coordinate axis.

    away : (2,) direction on the picture in which ticks and numbers lie.
    """
    axis = int(np.abs(end_mm - start_mm).argmax())
    unit = np.asarray(away) / np.linalg.norm(away)
    mm = np.diff(axes.get_xlim())[0] / 100
    length = float(np.linalg.norm(np.diff(view.flat(np.stack([start_mm, end_mm])), axis=0)))
    for value in _round_values(start_mm[axis], end_mm[axis], most=length / (6.5 * mm)):
        place = start_mm.copy()
        place[axis] = value
        foot = view.flat(place[None])[0]
        tip, text = foot + 0.9 * mm * unit, foot + 3.0 * mm * unit
        axes.plot(*np.column_stack([foot, tip]), color=INK, lw=0.8, clip_on=False)
        axes.text(*text, f"{value:g}".replace("-", "\u2212"), fontsize=11, color=INK, ha="center", va="center")
    middle = view.flat((start_mm + end_mm)[None] / 2)[0] + 7.2 * mm * unit
    axes.text(*middle, f"{name} (mm)", fontsize=12, color=INK, ha="center", va="center")


def _round_values(low: float, high: float, most: float) -> list[float]:
    """Round numbers between low and high, about five, fewer where only ``most`` have room."""
    low, high = min(low, high), max(low, high)
    rough = (high - low) / min(4.0, max(most, 1.0))
    decade = 10.0 ** np.floor(np.log10(rough))
    step = next(decade * m for m in (1, 2, 2.5, 5, 10) if decade * m >= 0.8 * rough)
    first, last = np.ceil(low / step - 1e-6), np.floor(high / step + 1e-6)
    return [float(round(step * k, 9)) + 0.0 for k in np.arange(first, last + 1)]


def name_parts(axes: Any, names: Sequence[str], anchors: Floats, colours: Sequence[str], column_mm: float) -> None:
    """Write names in a column at column_mm, joined by thin lines to their anchors (n, 2)."""
    order = np.argsort(anchors[:, 1])
    low, high = axes.get_ylim()
    heights = _spread_out(anchors[order, 1], 0.06 * (high - low))
    width = np.diff(axes.get_xlim())[0]
    for index, height in zip(order, heights, strict=True):
        x, y = anchors[index]
        bend = column_mm - 0.012 * width
        axes.plot([x, bend - 0.03 * width, bend], [y, height, height], color=INK, lw=0.7)
        axes.plot(x, y, "o", color=INK, ms=2.5)
        axes.plot(column_mm + 0.004 * width, height, "s", color=colours[index], ms=10, mec=INK, mew=0.5)
        axes.text(column_mm + 0.022 * width, height, names[index], fontsize=12, color=INK, va="center")


def _spread_out(heights: Floats, gap: float) -> Floats:
    """Heights (n,), rising, moved apart to at least gap while keeping near their places."""
    result = heights.astype(float)
    for _ in range(100):
        short = gap - np.diff(result)
        if (short <= 1e-9 * gap).all():
            break
        push = np.maximum(short, 0) / 2
        result[:-1] -= push
        result[1:] += push
    return result


def draw_colour_bar(figure: Any, low: float, high: float, label: str, extend: str = "neither") -> None:
    """Draw a colour bar of the common colour map at the right of the page."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar_axes = figure.add_axes((0.82, 0.2, 0.025, 0.55))
    bar = figure.colorbar(ScalarMappable(Normalize(low, high), COLOUR_MAP), cax=bar_axes, extend=extend)
    bar.set_label(label, fontsize=12, color=INK)
    bar.ax.tick_params(labelsize=11, colors=INK)


COLOUR_MAP = "viridis"
"""Even to the eye, readable in grey and by the colour-blind."""
DIVERGING = "RdBu_r"
"""For signed quantities, white at zero."""
