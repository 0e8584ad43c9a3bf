"""The numbers of one press without its files, kept on disk."""

from collections.abc import Mapping
from typing import Any

from foundation.cache import data_hash, recall, remember
from foundation.source_hash import source_hash
from mesh.types import MeshingError
from softdot.case import Case
from softdot.config.hashes import input_hash
from softdot.config.schema import Config
from softdot.json_files import plain
from softdot.prepared_press import OnStep, PreparedPress
from softdot.pressed import Pressed
from softdot.summary import mesh_part, press_part, stopped_solver
from solve.result import PressResult


def outcome(config: Config, on_step: OnStep | None = None) -> dict[str, Any]:
    """The summary of a press as `softdot run` gives it, without configuration and times. InputError.

    Stored under the hash of configuration and program, so that asking again costs nothing. A press that does not
    converge is an outcome too: solver.converged is False, solver.failure says why. A mesh that failed is not stored: it
    may have run out of time.
    """
    known = stored_outcome(config)
    if known is not None:
        return known
    numbers = solve_outcome(config, on_step)
    keep_outcome(config, numbers)
    return numbers


def keep_outcome(config: Config, numbers: Mapping[str, Any]) -> None:
    """Store an outcome that was solved here or elsewhere, where there was a mesh."""
    if "mesh" in numbers and stored_outcome(config) is None:
        remember(_stored_name(config), dict(numbers))


def stored_outcome(config: Config) -> dict[str, Any] | None:
    """The outcome of an earlier call, None where there was none."""
    found = recall(_stored_name(config))
    return found if isinstance(found, dict) else None


def outcome_key(config: Config) -> str:
    """Hash of all that an outcome depends on: configuration, the files it names, the program."""
    return data_hash([input_hash(config), source_hash(__name__)])


def _stored_name(config: Config) -> str:
    return f"outcome-{outcome_key(config)}"


def solve_outcome(config: Config, on_step: OnStep | None = None) -> dict[str, Any]:
    """Check, mesh and press a configuration; its numbers alone. InputError for what cannot be built."""
    return solve_with_fields(config, on_step)[0]


def solve_with_fields(config: Config, on_step: OnStep | None = None) -> tuple[dict[str, Any], PressResult | None]:
    """The numbers of a press, and the solver's own result, None without a mesh. InputError for what cannot be built.

    An array is pressed by its dots where they stand; its presses are checked together (softdot.arrays.case).
    """
    case = Case(config) if config.array is None else PreparedPress(config)
    numbers: dict[str, Any] = {"warnings": case.warnings if config.array is None else []}
    try:
        quality = case.mesh_quality
    except MeshingError as error:
        return {**numbers, "solver": stopped_solver(f"meshing: {error}")}, None
    pressed = Pressed(case, case.solve(on_step))
    result = pressed.result
    numbers |= {"mesh": mesh_part(quality, result.unknowns), **press_part(case.model, result, pressed.course)}
    numbers["warnings"] += pressed.doubts
    return dict(plain(numbers)), result
