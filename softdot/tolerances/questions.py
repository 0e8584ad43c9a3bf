"""Responses and derivatives that are asked of other processes, a press each."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from foundation.cache import recall, remember
from foundation.executor import Executor, completed_calls
from softdot.config.schema import Config
from softdot.json_files import plain
from softdot.tolerances.factors import with_factors
from softdot.tolerances.responses import KitPress, Response, name_of, on_mesh_of, slopes_by


class Question(NamedTuple):
    """What another process is asked of the press of a configuration: its derivatives by keys, or, where that is given,
    the response of a configuration that was moved.
    """

    config: Config
    keys: tuple[str, ...] = ()
    moved: Config | None = None

    def answer(self) -> Any:
        """As KitPress.slopes or KitPress.value, by the press that was asked last in this process where it fits."""
        press = kept_press(self.config)
        return press.slopes(self.keys) if self.moved is None else press.value(self.moved)

    def recalled(self) -> Any | None:
        """The answer to an earlier question."""
        known = recall(self._name)
        if known is None or self.moved is not None:
            return None if known is None else Response(*known)
        return Response(*known[0]), {key: Response(*pair) for key, pair in known[1].items()}

    def keep(self, answer: Any) -> None:
        """Have it recalled here where it was given elsewhere."""
        if recall(self._name) is None:
            remember(self._name, plain(answer))

    @property
    def _name(self) -> str:
        if self.moved is None:
            return name_of(with_factors(self.config), slopes_by(self.keys))
        return name_of(self.moved, on_mesh_of(self.config))


_LAST: list[KitPress] = []
"""Of this process: what a press beside the last one begins from. More would be memory that nobody uses."""


def kept_press(config: Config) -> KitPress:
    """The press that was asked for last in this process, or a new one."""
    if not _LAST or _LAST[0].config != config:
        _LAST[:] = [KitPress(config)]
    return _LAST[0]


def answered(
    questions: Mapping[str, Question], executor: Executor, told: Callable[[int, int, str], None]
) -> dict[str, Any]:
    """The answer to each question by its name; told : how many are there, of how many, and the name of the last one.

    InputError, MeshingError, LinearSolveError, StoppedShortError.
    """
    found = {name: known for name, one in questions.items() if (known := one.recalled()) is not None}
    missing = {name: (one,) for name, one in questions.items() if name not in found}
    told(len(found), len(questions), "")
    for name, future in completed_calls(executor, Question.answer, missing):
        found[name] = future.result()
        questions[name].keep(found[name])
        told(len(found), len(questions), name)
    _LAST.clear()  # where the executor is this process
    return found
