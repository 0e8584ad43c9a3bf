"""The numbers of one press without its files: what sweeps and studies ask for, kept on disk."""

from typing import Any

from geometry.cache import data_hash, recall, remember, source_hash
from mesh.types import MeshingError
from softdot import stages
from softdot.actual import actual
from softdot.config import Config, input_hash
from softdot.numbers import plain
from softdot.summary import mesh_part, press_part, stopped_solver
from softdot.warnings import design_warnings, result_warnings


def outcome(config: Config, on_step: stages.OnStep | None = None) -> dict[str, Any]:
    """The summary of a press as `softdot run` gives it, without configuration and times. InputError.

    Remembered under the hash of configuration and program, so that asking again costs nothing.
    A press that does not converge is an outcome too: solver.converged is False, solver.failure says why. A mesh
    that failed is not remembered: it may have run out of time.
    """
    known = remembered(config)
    if known is not None:
        return known
    numbers = solved(config, on_step or _silent)
    if "mesh" in numbers:
        remember(_name(config), numbers)
    return numbers


def remembered(config: Config) -> dict[str, Any] | None:
    """The outcome of an earlier call, None when there was none."""
    found = recall(_name(config))
    return found if isinstance(found, dict) else None


def outcome_key(config: Config) -> str:
    """Hash of all that an outcome depends on: configuration, the files it names, the program."""
    return data_hash([input_hash(config), source_hash(__name__)])


def _name(config: Config) -> str:
    return f"outcome-{outcome_key(config)}"


def solved(config: Config, on_step: stages.OnStep) -> dict[str, Any]:
    """Check, mesh and press one configuration, numbers only. InputError for what cannot be built."""
    changed, physics = actual(config)
    dot_shape, warnings = stages.check(changed)
    numbers: dict[str, Any] = {"warnings": [*warnings, *design_warnings(changed)]}
    try:
        tet_mesh = stages.build_mesh(changed, dot_shape)
        quality = stages.mesh_quality(changed, tet_mesh)
    except MeshingError as error:
        return {**numbers, "solver": stopped_solver(f"meshing: {error}")}
    result = stages.press(changed, physics, dot_shape, tet_mesh, on_step)
    readout, channels = stages.readout_voltage(changed, physics, result) or (None, None)
    numbers |= {"mesh": mesh_part(quality, result.unknowns), **press_part(changed, result, readout, channels)}
    numbers["warnings"] += result_warnings(changed, dot_shape, result.tet_mesh, result, physics.film_yield is not None)
    return dict(plain(numbers))


def _silent(*_args: Any) -> None:
    """No progress."""
