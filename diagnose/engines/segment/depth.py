"""Depth of the deepest run of a recording, and the error of the zero of its drive."""

from dataclasses import replace

import numpy as np

from diagnose.engines.segment.presses import without_gap
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

DEPTH_LADDER_RATIO = 1.05  # noise of the drive is far less than a step, and a table 5 % too deep costs nothing
FORCE_DEPTH_MARGIN = 1.3  # of the depth that a force reaches: softer candidates go deeper, and layers creep


def deepest_mm(model: Model, tet_mesh: Mesh, recording: Recording) -> float:
    """Depth in mm of the deepest run: largest driving displacement, or depth under the largest force with a margin."""
    depths = [float(run.drive_values.max()) for run in recording.runs if run.drive == "displacement_mm"]
    forces = [float(run.drive_values.max()) for run in recording.runs if run.drive == "force_N"]
    if forces:
        depths.append(FORCE_DEPTH_MARGIN * depth_under_force_mm(model, tet_mesh, max(forces)))
    return max(depths)


def round_up_depth(value: float) -> float:
    """Next power of DEPTH_LADDER_RATIO, so that noise of the drive does not ask for presses anew."""
    return float(DEPTH_LADDER_RATIO ** np.ceil(np.log(value) / np.log(DEPTH_LADDER_RATIO)))


def depth_under_force_mm(model: Model, tet_mesh: Mesh, force_N: float) -> float:
    """Depth in mm of the baseline under a force, from the cache if it is known. NoEquilibriumError."""
    pushed = replace(model, press=Press(force_N=force_N, load_steps=4), readout=None, physics=model.physics.structure)
    name = cache.key(DepthPress(pushed, tet_mesh, force_N, ()))
    found = cache.recall(name)
    if found is None:
        found = np.array([_press_to_force(pushed, tet_mesh)])
        cache.keep(name, found)
    return float(found[0])


def _press_to_force(model: Model, tet_mesh: Mesh) -> float:
    """Depth in mm at the end of a press of the model to its force. NoEquilibriumError."""
    result = press_segment(without_gap(model), tet_mesh)
    if result.failure is not None:
        raise NoEquilibriumError(f"the baseline under {model.press.force_N:.3g} N: {result.failure}", np.zeros(0), None)
    return 1e3 * float(result.trace.dot_path_m[-1])


DRIVE_ZERO = "zero-of-the-drive"


def nuisance_candidate(scene: Scene, recording: Recording, name: str) -> Candidate | None:
    """Candidate with the one coordinate of a nuisance; None where the model has no such part."""
    if name != "offset_mm":
        return wrong_number(scene, name)
    if not any(run.drive == "displacement_mm" for run in recording.runs):
        return None
    most = offset_reach_mm(recording)
    coordinate = Coordinate("offset_mm", -most, most, (0.1 * most, -0.1 * most))
    return Candidate(DRIVE_ZERO, "dot", (coordinate,), lambda _: {}, units={"offset_mm": "mm"})


def offset_reach_mm(recording: Recording) -> float:
    """Six sigma, in mm, of the largest error of the first touch that is declared."""
    return 6.0 * max((run.nuisance.get("offset_mm", 0.0) for run in recording.runs), default=0.0)
