"""Responses and derivatives that other processes calculate, one press each."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

from foundation.cache import recall, remember
from foundation.executor import Executor, completed_calls
from softdot.config.schema import Config
from softdot.json_files import plain
from softdot.tolerances.factors import with_factors
from softdot.tolerances.responses import KitPress, Response, moved_label, response_name, slopes_label


class StoredQuestion(Protocol):
    """A question whose answer another process may give, and which is kept on disk."""

    def answer(self) -> Any:
        """The answer, calculated."""

    def stored_answer(self) -> Any | None:
        """The answer to an earlier equal question, None where there was none."""

    def keep(self, answer: Any) -> None:
        """Store an answer that another process gave."""


class Question(NamedTuple):
    """A question about the press of a configuration: for derivatives by keys, for the response of a moved one, or for
    derivatives by keys of a moved one that has the factors.
    """

    config: Config
    keys: tuple[str, ...] = ()
    moved: Config | None = None

    def answer(self) -> Any:
        """The result of KitPress.slopes, value or slopes_at, by the last press of this process where that fits."""
        press = kept_press(self.config)
        if self.moved is None:
            return press.slopes(self.keys)
        return press.slopes_at(self.moved, self.keys) if self.keys else press.value(self.moved)

    def stored_answer(self) -> Any | None:
        """The answer to an earlier equal question, None where there was none."""
        known = recall(self._name)
        if known is None:
            return None
        if not self.keys:
            return Response(*known)
        return Response(*known[0]), {key: Response(*pair) for key, pair in known[1].items()}

    def keep(self, answer: Any) -> None:
        """Store an answer that another process gave, unless it is stored."""
        if recall(self._name) is None:
            remember(self._name, plain(answer))

    @property
    def _name(self) -> str:
        if self.moved is None:
            return response_name(with_factors(self.config), slopes_label(self.keys))
        label = moved_label(self.config)
        return response_name(self.moved, f"{label}, {slopes_label(self.keys)}" if self.keys else label)


_LAST_PRESS: list[KitPress] = []
"""The last press of this process, at most one: a moved configuration begins from it. More would waste memory."""


def kept_press(config: Config) -> KitPress:
    """The press that was asked for last in this process, or a new one."""
    if not _LAST_PRESS or _LAST_PRESS[0].config != config:
        _LAST_PRESS[:] = [KitPress(config)]
    return _LAST_PRESS[0]


def answer_all(
    questions: Mapping[str, StoredQuestion], executor: Executor, report: Callable[[int, int, str], None]
) -> dict[str, Any]:
    """The answer to each question by its name. InputError, MeshingError, LinearSolveError, StoppedShortError.

    report : called with the number of answers so far, their total, and the name of the last one.
    """
    found = {name: known for name, one in questions.items() if (known := one.stored_answer()) is not None}
    missing = {name: (one,) for name, one in questions.items() if name not in found}
    report(len(found), len(questions), "")
    for name, future in completed_calls(executor, _answer, missing):
        found[name] = future.result()
        questions[name].keep(found[name])
        report(len(found), len(questions), name)
    _LAST_PRESS.clear()  # where the executor is this process
    return found


def _answer(question: StoredQuestion) -> Any:
    return question.answer()
