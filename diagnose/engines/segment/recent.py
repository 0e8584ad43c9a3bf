"""The last answers to questions that have no hash, as arrays and settings have none."""

from collections.abc import Callable
from typing import Generic, TypeVar

Question = TypeVar("Question")
Answer = TypeVar("Answer")


class Recent(Generic[Question, Answer]):
    """As many answers as count; the one that was asked for longest ago goes first."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._kept: list[tuple[Question, Answer]] = []

    def find(self, same: Callable[[Question], bool], make: Callable[[], tuple[Question, Answer]]) -> Answer:
        """The answer to the same question, or else the one that is made, which is kept."""
        for number, (question, answer) in enumerate(self._kept):
            if same(question):
                self._kept.append(self._kept.pop(number))
                return answer
        made = make()
        self._kept = [*self._kept, made][-self._count :]
        return made[1]

    def clear(self) -> None:
        """Keep nothing."""
        self._kept = []
