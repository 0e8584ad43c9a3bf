"""The drive of a recording: how deep its runs go, and by how much its zero may be off."""

from dataclasses import replace

import numpy as np

from diagnose.engines.segment.presses import ungapped
from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.vocabulary.layers.property_error import nuisance as wrong_number
from diagnose.vocabulary.scene import Scene
from solve.model import Model, Press
from solve.press import press_segment
from solve.solution.errors import NoEquilibriumError
from solve.tables import cache
from solve.tables.depth_press import DepthPress
from solve.tables.rig_mesh import Mesh

LADDER_STEP = 1.05  # noise of the drive is far less than a step, and a table 5 % too deep costs nothing
DEEPER = 1.3  # of the depth that a force reaches: softer candidates go deeper, and layers creep


def deepest(model: Model, tet_mesh: Mesh, recording: Recording) -> float:
    """mm: of the displacements that drive, and where forces drive, of those with some way to go."""
    depths = [float(run.drive_values.max()) for run in recording.runs if run.drive == "displacement_mm"]
    forces = [float(run.drive_values.max()) for run in recording.runs if run.drive == "force_N"]
    if forces:
        depths.append(DEEPER * reached(model, tet_mesh, max(forces)))
    return max(depths)


def rounded_up(value: float) -> float:
    """The next power of LADDER_STEP, so that noise of the drive does not ask for presses anew."""
    return float(LADDER_STEP ** np.ceil(np.log(value) / np.log(LADDER_STEP)))


def reached(model: Model, tet_mesh: Mesh, force_N: float) -> float:
    """Depth in mm under a force. NoEquilibriumError."""
    pushed = replace(model, press=Press(force_N=force_N, load_steps=4), readout=None, physics=model.physics.structure)
    name = cache.key(DepthPress(pushed, tet_mesh, force_N, ()))
    found = cache.recall(name)
    if found is None:
        found = np.array([_press(pushed, tet_mesh)])
        cache.keep(name, found)
    return float(found[0])


def _press(model: Model, tet_mesh: Mesh) -> float:
    result = press_segment(ungapped(model), tet_mesh)
    if result.failure is not None:
        raise NoEquilibriumError(f"the baseline under {model.press.force_N:.3g} N: {result.failure}", np.zeros(0), None)
    return 1e3 * float(result.trace.dot_path_m[-1])


ZERO = "zero-of-the-drive"


def nuisance(scene: Scene, recording: Recording, name: str) -> Candidate | None:
    """The candidate with the one coordinate of a nuisance, None where the model has no such part."""
    if name != "offset_mm":
        return wrong_number(scene, name)
    if not any(run.drive == "displacement_mm" for run in recording.runs):
        return None
    most = offset_reach_mm(recording)
    coordinate = Coordinate("offset_mm", -most, most, (0.1 * most, -0.1 * most))
    return Candidate(ZERO, "dot", (coordinate,), lambda _: {}, units={"offset_mm": "mm"})


def offset_reach_mm(recording: Recording) -> float:
    """Six sigma of the largest error of the first touch that is declared."""
    return 6.0 * max((run.nuisance.get("offset_mm", 0.0) for run in recording.runs), default=0.0)
