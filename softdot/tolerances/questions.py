"""Questions about presses: force and voltage at the deepest step, their derivatives, and those of changed presses.

Where the path of a press does not matter and its voltage is open-circuit, only its full load is solved. A changed press
stands on the mesh of the unchanged one, moved to its sizes, so that meshes do not blur the difference. Every answer is
kept on disk.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from foundation.cache import data_hash, recall, remember
from foundation.errors import InputError
from foundation.executor import Executor, completed_calls
from foundation.source_hash import source_hash
from mesh.morphing import morphed_mesh
from mesh.types import TetMesh
from softdot.config.hashes import input_hash
from softdot.config.model import as_segment, model_of
from softdot.config.schema import Config
from softdot.differentiation import press_with_derivatives, variations_of, with_changes
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


class PressAnswer(NamedTuple):
    """A response and its derivatives by key. electrodes_V : at full load the open-circuit voltage (e,) of each
    electrode alone under "", its derivatives under their keys.
    """

    nominal: Response
    slopes: Mapping[str, Response]
    electrodes_V: Mapping[str, tuple[float, ...]] = {}


@dataclass(frozen=True)
class Question:
    """A question about the press of a configuration, an array being one segment with an electrode on each of its own.

    keys : of the configuration with factors, for derivatives. changes : by which its keys are moved. is_full_load : ask
    for open circuits at full load, before any slide and without amplifier.
    """

    config: Config
    keys: tuple[str, ...] = ()
    changes: Mapping[str, float] = field(default_factory=dict)
    is_full_load: bool = False

    def answer(self) -> PressAnswer:
        """The answer, calculated by the last press of this process where that fits.

        InputError, also for a full load where the path of the press matters; LinearSolveError, MeshingError,
        StoppedShortError.
        """
        last = _last_press(self.config)
        moved = with_changes(last.stated, self.changes) if self.changes else last.stated
        if not self.is_full_load and path_matters(moved):
            return answer_along(moved, self.keys, last.moved_mesh(moved))
        try:
            return last.at_full_load(moved, self.keys)
        except ValueError as error:
            raise InputError(str(error)) from None

    def stored_answer(self) -> PressAnswer | None:
        """The answer to an earlier equal question, None where there was none."""
        known = recall(self._name)
        if known is None:
            return None
        nominal, slopes, electrodes_V = known
        by_key = {key: Response(*pair) for key, pair in slopes.items()}
        return PressAnswer(Response(*nominal), by_key, {key: tuple(each) for key, each in electrodes_V.items()})

    def keep(self, answer: PressAnswer) -> None:
        """Store an answer."""
        remember(self._name, plain(answer))

    def kept_answer(self) -> PressAnswer:
        """The stored answer, or else the calculated one, then stored. Errors as in answer."""
        known = self.stored_answer()
        if known is None:
            known = self.answer()
            self.keep(known)
            _LAST_PRESS.clear()
        return known

    @property
    def _name(self) -> str:
        return _stored_name(self.config, [list(self.keys), dict(self.changes), self.is_full_load])


class _Pressed:
    """A configuration that is pressed on one mesh. stated : with factors, an array as one segment."""

    def __init__(self, config: Config) -> None:
        prepared = PreparedPress(config)
        whole = config if prepared.layout is None else as_segment(config, prepared.layout)
        self.config, self.stated, self._mesh = config, with_factors(whole), prepared.solved_mesh
        self._load: FullLoad | None = None

    def moved_mesh(self, moved: Config) -> TetMesh:
        """The mesh, moved to the sizes of a changed configuration."""
        if moved is self.stated:
            return self._mesh
        return morphed_mesh(self._mesh, model_of(self.stated).segment, model_of(moved).segment)

    def at_full_load(self, moved: Config, keys: Sequence[str]) -> PressAnswer:
        """The answer of a changed configuration. ValueError, LinearSolveError, StoppedShortError."""
        if moved is not self.stated and keys:
            load = FullLoad(model_of(moved), self.moved_mesh(moved))
            try:
                return _answer_of(load.answer, load.derivatives(variations_of(moved, keys)))
            finally:
                load.close()
        if self._load is None:
            self._load = FullLoad(model_of(self.stated), self._mesh)
        if moved is not self.stated:
            return _answer_of(self._load.similar_answer(model_of(moved)), {})
        return _answer_of(self._load.answer, self._load.derivatives(variations_of(moved, keys)))


_LAST_PRESS: list[_Pressed] = []
"""The last press of this process, at most one: a changed press begins from it. More would waste memory."""


def _last_press(config: Config) -> _Pressed:
    """The press that was asked for last in this process, or a new one."""
    if not _LAST_PRESS or _LAST_PRESS[0].config != config:
        _LAST_PRESS[:] = [_Pressed(config)]
    return _LAST_PRESS[0]


def _answer_of(full: FullResponse, by_key: Mapping[str, FullResponse]) -> PressAnswer:
    electrodes = {key: tuple(map(float, one.electrode_voltages)) for key, one in {"": full, **by_key}.items()}
    slopes = {key: Response(one.force, one.voltage) for key, one in by_key.items()}
    return PressAnswer(Response(full.force, full.voltage), slopes, electrodes)


def answer_all(
    questions: Mapping[str, Question], executor: Executor, report: Callable[[int, int, str], None]
) -> dict[str, PressAnswer]:
    """The answer to each question by its name. InputError, MeshingError, LinearSolveError, StoppedShortError.

    report : called with the number of answers so far, their total, and the name of the last one.
    """
    found = {name: known for name, one in questions.items() if (known := one.stored_answer()) is not None}
    missing = {name: (one,) for name, one in questions.items() if name not in found}
    report(len(found), len(questions), "")
    for name, future in completed_calls(executor, Question.answer, missing):
        found[name] = future.result()
        questions[name].keep(found[name])
        report(len(found), len(questions), name)
    _LAST_PRESS.clear()  # where the executor is this process
    return found


def coarser_press(config: Config, factor: float) -> Config:
    """The configuration in fewer load steps on elements larger by a factor; never on the mesh of a file."""
    press = config.press.model_copy(update={"load_steps": min(config.press.load_steps, MOST_LOAD_STEPS)})
    return with_larger_elements(config, factor).model_copy(update={"press": press})


def with_larger_elements(config: Config, factor: float) -> Config:
    """The configuration on elements that are larger by a factor; never on the mesh of a file."""
    options = config.mesh.scale_sizes(factor).model_copy(update={"file": None})
    return config.model_copy(update={"mesh": options})


def path_matters(config: Config) -> bool:
    """Whether the response at full load depends on how the load came to be there."""
    case = PreparedPress(config)
    return case.model.follows_time or case.is_amplified


def answer_along(config: Config, keys: Sequence[str], tet_mesh: TetMesh) -> PressAnswer:
    """The response of a whole press on a given mesh, and its derivatives. InputError, StoppedShortError."""
    if not keys:
        return PressAnswer(_response(config, PreparedPress(config).solve(tet_mesh=tet_mesh)), {})
    result, found = press_with_derivatives(config, keys, tet_mesh)
    response, step = _response(config, result), _deepest_step(result)
    at = int(np.argmin(np.abs(found[0].time_s - result.steps[step].time_s)))
    by_key = {}
    for one in found:
        voltage = one.open_circuit_voltage_V if one.readout_voltage_V is None else one.readout_voltage_V
        by_key[one.key] = Response(float(one.reaction_force_N[at]), float(voltage[at]))
    return PressAnswer(response, by_key)


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


def kept_on_disk(config: Config, what: str, make: Callable[[], Any]) -> Any:
    """Plain numbers from the cache on disk, or from make, then kept there under configuration, program and label."""
    name = _stored_name(config, what)
    known = recall(name)
    if known is None:
        known = make()
        remember(name, plain(known))
    return known


def _stored_name(config: Config, what: Any) -> str:
    return f"response-{data_hash([what, input_hash(config), source_hash(__name__)])}"
