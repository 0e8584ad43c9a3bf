"""All pictures of a run, and its curves: reaction force and voltage against indentation or time."""

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from export.course_figure import course_figure, voltage_unit
from export.cutaway import draw_parts, draw_von_mises, open_scene
from export.film_maps import film_figure
from export.skin import MM_PER_M
from export.view import DPI, HEIGHT_IN, INK, WIDTH_IN, DrawnBody, View, picture_page, render, save_png
from foundation.arrays import Floats
from foundation.files import whole_folder
from geometry.dot import DotShape
from geometry.parameters import Electrode
from mesh.types import TetMesh
from solve.readout.course import PressCourse
from solve.result import PressResult, Step

OPEN_CIRCUIT_COLOURS = ("#b5263b", "#33658a", "#e08e2b", "#7b4fa3", "#5a5a5a", "#c46ab0", "#2a9d9d", "#8c6d46")
READOUT_COLOUR = "#3f7a4d"


def draw_curves(
    abscissa: tuple[Floats, str],
    reaction_force_N: Floats,
    open_circuit_V: Mapping[str, Floats],
    readout_voltage_V: Floats | None,
    path: Path | BytesIO,
) -> None:
    """Draw force and voltages, each (s,), in two panels over the abscissa, and write a PNG.

    abscissa : its values (s,) and its label. open_circuit_V : by the names of the electrodes, which stand in the legend
    where there are several; the read-out is then that of all together.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    x, below = abscissa
    figure = Figure(
        figsize=(WIDTH_IN, HEIGHT_IN * 0.6),
        dpi=DPI,
        facecolor="white",
        layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.1),
    )
    force, voltage = figure.subplots(1, 2)
    force.plot(x, reaction_force_N, "o-", color="#33658a", lw=1.8, ms=4)
    _label_axes(force, below, "reaction force (N)")
    every = np.array(list(open_circuit_V.values()))
    scale, unit = voltage_unit(every)
    lines, several = [], len(every) > 1
    for number, (name, values) in enumerate(open_circuit_V.items()):
        look = {"label": name if several else "open circuit", "color": OPEN_CIRCUIT_COLOURS[number % 8]}
        lines += voltage.plot(x, scale * values, "o-", lw=1.8, ms=4, **look)
    _label_axes(voltage, below, f"{'open-circuit ' if several else ''}voltage ({unit})")
    if readout_voltage_V is not None:
        lines += _plot_readout(voltage, x, every, readout_voltage_V, "together, read" if several else "read-out")
    voltage.legend(handles=lines, frameon=False, fontsize=11, loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
    save_png(figure, path)


def _plot_readout(axes: Any, x: Floats, open_V: Floats, readout_V: Floats, label: str) -> list[Any]:
    """Plot the read-out beside the open-circuit voltage; return its line.

    It has a scale of its own where it would else look like zero.
    """
    scale, unit = voltage_unit(open_V)
    if np.abs(readout_V).max() < 0.1 * np.abs(open_V).max():
        axes = axes.twinx()
        scale, unit = voltage_unit(readout_V)
        axes.set_ylabel(f"read-out voltage ({unit})", fontsize=12, color=READOUT_COLOUR)
        axes.tick_params(labelsize=11, colors=READOUT_COLOUR)
        axes.spines["top"].set_visible(False)
    return list(axes.plot(x, scale * readout_V, "s--", color=READOUT_COLOUR, lw=1.6, ms=4, label=label))


def _label_axes(axes: Any, below: str, label: str) -> None:
    axes.set_xlabel(below, fontsize=12, color=INK)
    axes.set_ylabel(label, fontsize=12, color=INK)
    axes.grid(alpha=0.3)
    axes.locator_params(axis="x", nbins=5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=11)


PICTURE_NAMES = ("undeformed", "deformed", "von_mises", "film", "force_voltage", "course")


def write_pictures(
    tet_mesh: TetMesh,
    result: PressResult,
    dot_shape: DotShape,
    folder: Path,
    along: PressCourse,
    electrodes: Sequence[Electrode] = (),
) -> dict[str, Path]:
    """Write <name>.png for every name in PICTURE_NAMES; return paths by name. The folder appears whole or not at all.

    along : its course in time. electrodes : drawn with their names on the film.
    Raises InputError when this machine lacks the system libraries to draw.
    """
    first, last = result.steps[0], deepest(result)
    pressed = f"Pressed {last.indentation_m * MM_PER_M:.3g} mm deep with {last.reaction_force_N:.3g} N"
    with whole_folder(folder) as scratch:
        files = {name: scratch / f"{name}.png" for name in PICTURE_NAMES}
        draw_parts(open_scene(tet_mesh, first, dot_shape), "At rest, the dot just touching", files["undeformed"])
        scene = open_scene(tet_mesh, last, dot_shape)
        draw_parts(scene, pressed, files["deformed"])
        draw_von_mises(scene, pressed, files["von_mises"])
        save_png(film_figure(tet_mesh, last, result.film_peak, electrodes), files["film"])
        read = None if along.together_V is None else along.together_V[along.solved]
        force = np.array([step.reaction_force_N for step in result.steps])
        draw_curves(abscissa(result), force, _open_circuit_V(result), read, files["force_voltage"])
        save_png(course_figure(along, result.electrode_names), files["course"])
    return {name: folder / f"{name}.png" for name in PICTURE_NAMES}


def draw_sample() -> None:
    """Draw a surface and curves into memory, so that the next pictures of this process take less time.

    InputError as of write_pictures.
    """
    import pyvista

    box = (-1.0, 1.0, -1.0, 1.0)
    figure, axes, _ = picture_page(box, "sample")
    sphere = DrawnBody(pyvista.Sphere().clip_closed_surface("y"), INK)
    axes.imshow(render([sphere], View(28.0, 18.0), box, 50.0), extent=box)
    save_png(figure, BytesIO())
    draw_curves((np.arange(2.0), "sample"), np.arange(2.0), {"": np.arange(2.0)}, None, BytesIO())


def deepest(result: PressResult) -> Step:
    """The step to show: the deepest, of equal ones the last."""
    depth = [round(step.indentation_m, 12) for step in result.steps]
    return result.steps[len(depth) - 1 - int(np.argmax(depth[::-1]))]


def abscissa(result: PressResult) -> tuple[Floats, str]:
    """Values (s,) over which the curves are drawn, and their label.

    Time where the press follows it, else the depth, or on a slide the number of the step.
    """
    if result.follows_time:
        return np.array([step.time_s for step in result.steps]), "time (s)"
    depth = np.array([step.indentation_m * MM_PER_M for step in result.steps])
    if bool(np.all(np.diff(depth) > 0)):
        return depth, "indentation (mm)"
    return np.arange(len(depth), dtype=np.float64), "step"


def _open_circuit_V(result: PressResult) -> dict[str, Floats]:
    """Open-circuit voltage (s,) of each electrode by its name."""
    voltages = np.array([step.open_circuit_voltage_V for step in result.steps]).T
    return dict(zip(result.electrode_names, voltages, strict=True))
