"""Force and voltage at the deepest step, their derivatives, and their values at the ends of a shift. Where the path of
a press does not matter and its voltage is open-circuit, only its full load is solved.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from foundation.arrays import Floats
from foundation.cache import data_hash, recall, remember
from foundation.errors import InputError
from foundation.source_hash import source_hash
from mesh.morphing import morphed_mesh
from mesh.types import TetMesh
from softdot.config.hashes import config_hash, input_hash
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.differentiation import press_with_derivatives, variations_of
from softdot.json_files import plain
from softdot.prepared_press import PreparedPress
from softdot.summary import history
from softdot.tolerances.factors import with_factors
from solve.result import PressResult
from solve.solution.full_load import FullLoad, FullResponse, StoppedShortError

MOST_LOAD_STEPS = 3
"""Enough load steps for Newton's method; only the deepest one is asked for."""


class Response(NamedTuple):
    """Force in N and voltage in V at the deepest step, or their derivatives."""

    force: float
    voltage: float


def coarser_press(config: Config, factor: float) -> Config:
    """The configuration in fewer load steps on elements larger by a factor; never on the mesh of a file."""
    press = config.press.model_copy(update={"load_steps": min(config.press.load_steps, MOST_LOAD_STEPS)})
    return with_larger_elements(config, factor).model_copy(update={"press": press})


def with_larger_elements(config: Config, factor: float) -> Config:
    """The configuration on elements that are larger by a factor; never on the mesh of a file."""
    options = config.mesh.scale_sizes(factor).model_copy(update={"file": None})
    return config.model_copy(update={"mesh": options})


def solved_mesh(config: Config) -> TetMesh:
    """The mesh on which a configuration is solved. InputError, MeshingError."""
    return PreparedPress(config).solved_mesh


class FullLoadResponse(NamedTuple):
    """The response at full load, the voltage of each electrode alone, and the derivatives of the response by key."""

    nominal: Response
    electrode_voltages_V: tuple[float, ...]
    slopes: dict[str, Response]


class KitPress:
    """A configuration that is pressed on one mesh when first asked for; every answer is kept on disk."""

    def __init__(self, config: Config) -> None:
        self.config = config

    def slopes(self, keys: Sequence[str]) -> tuple[Response, dict[str, Response]]:
        """The response and its derivative by each key of the configuration with factors. InputError, MeshingError,
        LinearSolveError, StoppedShortError.
        """
        found = kept_on_disk(with_factors(self.config), slopes_label(keys), lambda: self._slopes(keys))
        return Response(*found[0]), {key: Response(*pair) for key, pair in found[1].items()}

    def full_load(self, keys: Sequence[str]) -> FullLoadResponse:
        """Force and open-circuit voltages at full load, before any slide and without amplifier, with their slopes.

        InputError also where the path of the press matters; other errors as in slopes.
        """
        changed = with_factors(self.config)
        voltages, nominal, slopes = kept_on_disk(changed, f"full load {keys}", lambda: self._at_full_load(keys))
        by_key = {key: Response(*pair) for key, pair in slopes.items()}
        return FullLoadResponse(Response(*nominal), tuple(voltages), by_key)

    def value(self, moved: Config) -> Response:
        """The response of a moved configuration, on the mesh of the unmoved one so that meshes do not blur the
        difference. Errors as in slopes.
        """
        return Response(*kept_on_disk(moved, moved_label(self.config), lambda: self._value(moved)))

    def slopes_at(self, moved: Config, keys: Sequence[str]) -> tuple[Response, dict[str, Response]]:
        """As slopes, of a moved configuration that has the factors, at full load on the moved mesh."""
        label = f"{moved_label(self.config)}, {slopes_label(keys)}"
        found = kept_on_disk(moved, label, lambda: self._slopes_at(moved, keys))
        return Response(*found[0]), {key: Response(*pair) for key, pair in found[1].items()}

    @cached_property
    def _mesh(self) -> TetMesh:
        return solved_mesh(self.config)

    @cached_property
    def _full_load(self) -> FullLoad:
        return FullLoad(model_of(with_factors(self.config)), self._mesh)

    def _slopes(self, keys: Sequence[str]) -> tuple[Response, dict[str, Response]]:
        changed = with_factors(self.config)
        if path_matters(changed):
            return slopes_along(changed, keys, self._mesh)
        return self._full_load_slopes(keys)

    def _at_full_load(self, keys: Sequence[str]) -> tuple[Floats, Response, dict[str, Response]]:
        slopes = self._full_load_slopes(keys)
        return (self._full_load.answer.electrode_voltages, *slopes)

    def _full_load_slopes(self, keys: Sequence[str]) -> tuple[Response, dict[str, Response]]:
        changed = with_factors(self.config)
        try:
            found = self._full_load.derivatives(variations_of(changed, keys))
        except ValueError as error:
            raise InputError(str(error)) from None
        return _of_all(self._full_load.answer), {key: _of_all(answer) for key, answer in found.items()}

    def _slopes_at(self, moved: Config, keys: Sequence[str]) -> tuple[Response, dict[str, Response]]:
        model = model_of(moved)
        load = FullLoad(model, morphed_mesh(self._mesh, model_of(with_factors(self.config)).segment, model.segment))
        try:
            found = load.derivatives(variations_of(moved, keys))
        except ValueError as error:
            raise InputError(str(error)) from None
        finally:
            load.close()
        return _of_all(load.answer), {key: _of_all(answer) for key, answer in found.items()}

    def _value(self, moved: Config) -> Response:
        if path_matters(moved):
            return value_along(moved, morphed_mesh(self._mesh, self.config.segment, moved.segment))
        return _of_all(self._full_load.similar_answer(model_of(moved)))


def _of_all(answer: FullResponse) -> Response:
    """Force and voltage of all electrodes in parallel."""
    return Response(answer.force, answer.voltage)


def path_matters(config: Config) -> bool:
    """Whether the response at full load depends on how the load came to be there."""
    case = PreparedPress(config)
    return case.model.follows_time or case.is_amplified


def slopes_along(config: Config, keys: Sequence[str], tet_mesh: TetMesh) -> tuple[Response, dict[str, Response]]:
    """The response and its derivative by each key, along the whole press. InputError, StoppedShortError."""
    result, found = press_with_derivatives(config, keys, tet_mesh)
    response, step = _response(config, result), _deepest_step(result)
    at = int(np.argmin(np.abs(found[0].time_s - result.steps[step].time_s)))
    by_key = {}
    for one in found:
        voltage = one.open_circuit_voltage_V if one.readout_voltage_V is None else one.readout_voltage_V
        by_key[one.key] = Response(float(one.reaction_force_N[at]), float(voltage[at]))
    return response, by_key


def value_along(config: Config, tet_mesh: TetMesh) -> Response:
    """The response of a whole press on a given mesh. InputError, StoppedShortError."""
    return _response(config, PreparedPress(config).solve(tet_mesh=tet_mesh))


def slopes_label(keys: Sequence[str]) -> str:
    """The words for derivatives by keys, as part of the name under which they are kept."""
    return f"slopes {list(keys)}"


def moved_label(config: Config) -> str:
    """The words for the response of a moved configuration on another's mesh, as part of the name of what is kept."""
    return f"on the mesh of {config_hash(config)}"


def response_name(config: Config, what: str) -> str:
    """The name under which an answer is kept."""
    return f"response-{data_hash([what, input_hash(config), source_hash(__name__)])}"


def kept_on_disk(config: Config, what: str, make: Callable[[], Any]) -> Any:
    """Plain numbers from the cache on disk, or from make, then kept there under configuration, program and label."""
    name = response_name(config, what)
    known = recall(name)
    if known is None:
        known = make()
        remember(name, plain(known))
    return known


def _response(config: Config, result: PressResult) -> Response:
    if not result.converged:
        raise StoppedShortError(result.failure)
    along = PreparedPress(config).course(result)
    voltage = history(result).open_circuit_voltage_V if along.together_V is None else along.together_V[along.solved]
    step = _deepest_step(result)
    return Response(result.steps[step].reaction_force_N, float(voltage[step]))


def _deepest_step(result: PressResult) -> int:
    """The number of the deepest step, the first of equally deep ones."""
    return int(np.argmax(np.round([step.indentation_m for step in result.steps], 12)))
