"""How deep the runs of a recording go."""

from dataclasses import replace

import numpy as np

from diagnose.recording import Recording
from diagnose.segment import store
from diagnose.segment.presses import Job
from geometry.dot import resolve_dot
from mesh.types import TetMesh
from solve.model import Model, Physics
from solve.parameters import Press
from solve.press import press_segment
from solve.solution.newton import NoEquilibriumError

RUNG = 1.05  # noise of the drive is far less than a step, and a table 5 % too deep costs nothing
DEEPER = 1.3  # of the depth that a force reaches: softer candidates go deeper, and layers creep


def deepest(model: Model, tet_mesh: TetMesh, recording: Recording) -> float:
    """mm: of the displacements that drive, and where forces drive, of those with some way to go."""
    depths = [float(run.drive_values.max()) for run in recording.runs if run.drive == "displacement_mm"]
    forces = [float(run.drive_values.max()) for run in recording.runs if run.drive == "force_N"]
    if forces:
        depths.append(DEEPER * reached(model, tet_mesh, max(forces)))
    return max(depths)


def rung(value: float) -> float:
    """The next number up of a ladder in steps of RUNG, so that noise of the drive does not ask for presses anew."""
    return float(RUNG ** np.ceil(np.log(value) / np.log(RUNG)))


def reached(model: Model, tet_mesh: TetMesh, force_N: float) -> float:
    """Depth in mm under a force. NoEquilibriumError."""
    pushed = replace(model, press=Press(force_N=force_N, load_steps=4), readout=None, physics=_elastic(model.physics))
    name = store.key(Job(pushed, tet_mesh, force_N, ()))
    found = store.recall(name)
    if found is None:
        found = np.array([_press(pushed, tet_mesh)])
        store.keep(name, found)
    return float(found[0])


def _press(model: Model, tet_mesh: TetMesh) -> float:
    dot = resolve_dot(model.dot.model_copy(update={"gap_mm": 0.0}), model.segment)
    result = press_segment(model.segment, model.materials, dot, model.press, tet_mesh, physics=model.physics)
    if result.failure is not None:
        raise NoEquilibriumError(f"the baseline under {model.press.force_N:.3g} N: {result.failure}", np.zeros(0), None)
    return 1e3 * float(result.trace.dot_path_m[-1])


def _elastic(physics: Physics) -> Physics:
    """Without what acts in time."""
    return Physics(bonds=physics.bonds, delaminations=physics.delaminations, prestretch=physics.prestretch)
