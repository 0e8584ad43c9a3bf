"""Force and voltage at the deepest step, their derivatives, and their values at the ends of a shift."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mesh.fingerprint import data_hash, files_hash
from mesh.types import TetMesh
from softdot import stages
from softdot.actual import actual
from softdot.config import Config
from softdot.differentiate import press_with_derivatives
from softdot.outcome import outcome_key
from softdot.remembered import recall, remember
from softdot.summary import history
from solve.result import PressResult

LOAD_STEPS = 3
"""Enough for the march; what is asked for is the deepest step alone."""
SOURCES = "differentiate.py", "kit/responses.py", "kit/factors.py"
"""Any change of their code makes other responses, beside what an outcome depends on."""


class StoppedShortError(RuntimeError):
    """A press did not reach its full load."""


class Response(NamedTuple):
    """Force in N and voltage in V at the deepest step, or their derivatives."""

    force: float
    voltage: float


def coarser(config: Config, factor: float) -> Config:
    """The same press in fewer steps on elements that are larger by the factor."""
    options = config.mesh
    sizes = {
        name: factor * size
        for name in ("element_size_mm", "contact_element_size_mm", "film_element_size_mm")
        if (size := getattr(options, name)) is not None
    }
    press = config.press.model_copy(update={"load_steps": min(config.press.load_steps, LOAD_STEPS)})
    return config.model_copy(update={"mesh": options.model_copy(update=sizes), "press": press})


def mesh_of(config: Config) -> TetMesh:
    """The mesh of a configuration. InputError, MeshingError."""
    changed, _ = actual(config)
    return stages.build_mesh(changed, stages.check(changed)[0])


def slopes(config: Config, keys: Sequence[str], tet_mesh: TetMesh) -> tuple[Response, dict[str, Response]]:
    """The response and its derivative by each key. InputError, StoppedShortError."""
    result, found = press_with_derivatives(config, keys, tet_mesh)
    response, step = _response(config, result), _deepest(result)
    at = int(np.argmin(np.abs(found[0].time_s - result.steps[step].time_s)))
    by_key = {}
    for one in found:
        voltage = one.open_circuit_voltage_V if one.readout_voltage_V is None else one.readout_voltage_V
        by_key[one.key] = Response(float(one.reaction_force_N[at]), float(voltage[at]))
    return response, by_key


def value(config: Config, tet_mesh: TetMesh) -> Response:
    """The response of a press on a given mesh. InputError, StoppedShortError."""
    changed, physics = actual(config)
    dot_shape, _ = stages.check(changed)
    result = stages.press(changed, physics, dot_shape, tet_mesh, lambda *_: None)
    return _response(config, result)


def remembered(config: Config, what: str, make: Callable[[], Any]) -> Any:
    """Plain numbers kept on disk under the hash of a configuration, of the program and of what was asked."""
    source = files_hash(Path(__file__).parents[1] / name for name in SOURCES)
    name = f"response-{data_hash([what, outcome_key(config), source])}"
    known = recall(name)
    if known is None:
        known = make()
        remember(name, known)
    return known


def _response(config: Config, result: PressResult) -> Response:
    if not result.converged:
        raise StoppedShortError(result.failure)
    _, physics = actual(config)
    amplified = stages.readout_voltage(config, physics, result)
    voltage = history(result).open_circuit_voltage_V if amplified is None else amplified[0]
    step = _deepest(result)
    return Response(result.steps[step].reaction_force_N, float(voltage[step]))


def _deepest(result: PressResult) -> int:
    """Of equally deep steps the first."""
    return int(np.argmax(np.round([step.indentation_m for step in result.steps], 12)))
