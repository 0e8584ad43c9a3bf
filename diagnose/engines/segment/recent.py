"""The last answers to questions that have no hash, as arrays and settings have none."""

from collections.abc import Callable
from operator import eq
from typing import Generic, TypeVar

Question = TypeVar("Question")
Answer = TypeVar("Answer")


class Recent(Generic[Question, Answer]):
    """As many answers as count; the one that was asked for longest ago goes first."""

    def __init__(self, count: int, same: Callable[[Question, Question], bool] = eq) -> None:
        self._count, self._same = count, same
        self._kept: list[tuple[Question, Answer]] = []

    def of(self, question: Question, make: Callable[[], Answer]) -> Answer:
        """The answer to the same question, or else the one that is made, which is kept."""
        for number, (before, answer) in enumerate(self._kept):
            if self._same(before, question):
                self._kept.append(self._kept.pop(number))
                return answer
        made = make()
        self._kept = [*self._kept, (question, made)][-self._count :]
        return made

    def clear(self) -> None:
        """Keep nothing."""
        self._kept = []
