"""The reduced model against presses of the 3D model that had no part in its making."""

from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np

from foundation.arrays import Floats
from geometry.dot import DotShape
from geometry.parameters import Dot, Segment
from mesh.types import TetMesh
from solve.materials.parameters import Material
from solve.materials.prony import Prony
from solve.model import Model, Press
from solve.physics import Physics
from solve.press import press_segment
from solve.reduced.model import ReducedModel
from solve.reduced.response import Accuracy
from solve.result import Trace
from solve.solution.errors import NoEquilibriumError
from solve.waveform import Waveform

SAMPLES_A_STEP = 20  # samples of the reduced model to each time step of the 3D model


def measure_accuracy(
    model: ReducedModel,
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    tet_mesh: TetMesh,
    physics: Physics,
) -> Accuracy:
    """Largest errors over presses kept out of the fit. NoEquilibriumError where one of these has no answer."""
    found = []
    for waveform, depth, share in _validation_presses(bool(model.relaxing)):
        inelastic = {layer: (Prony((share * most,), (waveform.rise_s,)),) for layer, most in model.relaxing.items()}
        tested = replace(physics.structure, inelastic=inelastic)
        press = Press(indentation_mm=depth * model.depth_mm, load_steps=8, waveform=waveform)
        result = press_segment(Model(segment, materials, Dot(), press, None, tested), tet_mesh, dot=dot)
        if result.failure is not None:
            raise NoEquilibriumError(f"a press to check the reduced model: {result.failure}", np.zeros(0), None)
        found.append(compare(model, result.trace, tested))
    return Accuracy(*(max(getattr(a, f.name) for a in found) for f in fields(Accuracy)))


def _validation_presses(relaxes: bool) -> list[tuple[Waveform, float, float]]:
    """Waveform, share of the depth and share of the largest relaxation of presses kept out of the fit; all relaxation
    times are that of the rise.
    """
    if not relaxes:
        return [(Waveform(shape="ramp", rise_s=0.1), 0.97, 0.0)]
    hold = Waveform(shape="trapezoid", rise_s=0.1, hold_s=0.3, fall_s=0.1)
    return [(hold, 1.0, 1.0), (Waveform(shape="half-sine", rise_s=0.1), 0.8, 0.6)]


def compare(model: ReducedModel, trace: Trace, physics: Physics) -> Accuracy:
    """Errors at the times of a 3D press, whose own depth is given to the reduced model."""
    time = with_samples_between(trace.time_s)
    depth = 1e3 * np.interp(time, trace.time_s, trace.indentation_m)
    answer = model.respond(time, depth, physics)
    force, charge = answer.force_N[::SAMPLES_A_STEP], answer.electrode_charge_C[::SAMPLES_A_STEP].sum(axis=1)
    wanted = trace.film_charge_C.sum(axis=1)
    rate, wanted_rate = np.diff(charge) / np.diff(trace.time_s), np.diff(wanted) / np.diff(trace.time_s)
    return Accuracy(
        relative_error(force, trace.reaction_force_N),
        relative_error(charge, wanted),
        relative_error(rate, wanted_rate),
    )


def with_samples_between(time: Floats) -> Floats:
    """Times with SAMPLES_A_STEP even parts in every interval, the given ones at every such place."""
    places = np.arange((len(time) - 1) * SAMPLES_A_STEP + 1) / SAMPLES_A_STEP
    return np.asarray(np.interp(places, np.arange(len(time)), time))


def relative_error(found: Floats, wanted: Floats) -> float:
    """Largest difference over the largest wanted value."""
    return float(np.abs(found - wanted).max() / max(np.abs(wanted).max(), 1e-300))
