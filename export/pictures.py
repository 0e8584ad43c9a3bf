"""All pictures of a run."""

from pathlib import Path

import numpy as np

from export.curves import draw_curves
from export.cutaway import draw_parts, draw_von_mises, is_slice, open_scene
from export.files import whole_folder
from export.film_map import draw_film
from export.units import MM_PER_M
from geometry.dot_shape import DotShape
from mesh.types import Floats, TetMesh
from solve.result import PressResult, Step

FILES = ("undeformed", "deformed", "von_mises", "film", "force_voltage")


def write_pictures(
    tet_mesh: TetMesh,
    result: PressResult,
    dot_shape: DotShape,
    folder: Path,
    readout_voltage_V: Floats | None = None,
) -> dict[str, Path]:
    """Write <name>.png for every name in FILES; return them by name. The folder appears whole or not at all.

    readout_voltage_V : (s,) voltage behind the amplifier at each step, where there is one.
    Raises InputError when this machine lacks the system libraries to draw.
    """
    first, last = result.steps[0], deepest(result)
    depth, force = last.indentation_m * MM_PER_M, last.reaction_force_N
    pressed = f"Pressed {depth:.3g} mm deep with {force:.3g} N"
    with whole_folder(folder) as scratch:
        files = {name: scratch / f"{name}.png" for name in FILES}
        draw_parts(open_scene(tet_mesh, first, dot_shape), "At rest, the dot just touching", files["undeformed"])
        scene = open_scene(tet_mesh, last, dot_shape)
        draw_parts(scene, pressed, files["deformed"])
        draw_von_mises(scene, pressed, files["von_mises"])
        draw_film(tet_mesh, last, result.film_peak, f"Film at {depth:.3g} mm", files["film"], is_slice(tet_mesh))
        draw_curves(abscissa(result), *_history(result), readout_voltage_V, files["force_voltage"])
    return {name: folder / f"{name}.png" for name in FILES}


def deepest(result: PressResult) -> Step:
    """The step to show: the deepest, of equal ones the last."""
    depth = [round(step.indentation_m, 12) for step in result.steps]
    return result.steps[len(depth) - 1 - int(np.argmax(depth[::-1]))]


def abscissa(result: PressResult) -> tuple[Floats, str]:
    """What the curves are drawn over (s,), and its name: time where it matters, else depth, on a slide the step."""
    if result.follows_time:
        return np.array([step.time_s for step in result.steps]), "time (s)"
    depth = np.array([step.indentation_m * MM_PER_M for step in result.steps])
    if bool(np.all(np.diff(depth) > 0)):
        return depth, "indentation (mm)"
    return np.arange(len(depth), dtype=np.float64), "step"


def _history(result: PressResult) -> tuple[Floats, Floats]:
    """Force (N) and open-circuit voltage (V) of the electrodes in parallel, each (s,)."""
    share = result.capacitance_F / result.capacitance_F.sum()
    return (
        np.array([step.reaction_force_N for step in result.steps]),
        np.array([step.open_circuit_voltage_V @ share for step in result.steps]),
    )
