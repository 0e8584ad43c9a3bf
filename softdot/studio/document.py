"""The text of a design: edits that keep its comments, undo and redo."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Array, InlineTable

from foundation.errors import InputError

MOST_KEPT = 200
LARGEST = 200_000
"""Characters of a design; the largest example has some thousands."""
Key = Sequence[str | int]


class Document:
    """A TOML text and those before and after it. Every change is a new text; comments and order stay."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.start = text
        self._before: list[str] = []
        self._after: list[str] = []
        self._tree: tuple[str, tomlkit.TOMLDocument] | None = None

    @property
    def can_undo(self) -> bool:
        """Whether there is a text before this one."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Whether one was undone."""
        return bool(self._after)

    def write(self, text: str, joined: bool = False) -> None:
        """Exchange the whole text. joined : it goes on with the last change, as a slider does that is still held.

        InputError for a text that is too long.
        """
        if len(text) > LARGEST:
            raise InputError(f"the design has {len(text)} characters, at most {LARGEST} are allowed")
        if text == self.text:
            return
        if not (joined and self._before):
            self._before = [*self._before[1 - MOST_KEPT :], self.text]
        self.text, self._after = text, []

    def undo(self) -> None:
        """Back to the text before."""
        if self._before:
            self._after.append(self.text)
            self.text = self._before.pop()

    def redo(self) -> None:
        """Forward again."""
        if self._after:
            self._before.append(self.text)
            self.text = self._after.pop()

    def set(self, key: Key, value: Any, joined: bool = False) -> None:
        """Put a value in its place; missing tables on the way are made; None takes the key out. InputError.

        Keys of its table that no longer act beside it are taken out too.
        """
        from softdot.config.idle import take_out_idle

        document = self._parsed()
        place: Any = document
        try:
            for part, following in pairwise(key):
                if isinstance(part, str) and part not in place:
                    if value is None:
                        return
                    place[part] = tomlkit.aot() if isinstance(following, int) else tomlkit.table()
                if isinstance(part, int) and part == len(place):
                    place.append(tomlkit.table())
                place = place[part]
            _put(place, key[-1], value)
            take_out_idle(document, key)
        except (KeyError, IndexError, TypeError, ValueError, AttributeError, TOMLKitError):
            raise InputError(f"{dotted_key(key)}: there is no such place in this design") from None
        text = tomlkit.dumps(document)
        self.write(text, joined)
        self._tree = text, document

    def _parsed(self) -> tomlkit.TOMLDocument:
        """The tree of the text, to be changed: that which the last change left, as parsing takes 8 ms."""
        left, self._tree = self._tree, None
        if left is not None and left[0] == self.text:
            return left[1]
        try:
            return tomlkit.parse(self.text)
        except (TOMLKitError, RecursionError) as error:
            raise InputError(f"the text is not valid TOML, {error}; mend it, or undo") from None


def _put(place: Any, last: str | int, value: Any) -> None:
    """One value of a table or list; None takes it out."""
    if value is None:
        if isinstance(last, int) or last in place:
            del place[last]
        return
    if isinstance(value, dict):
        value = _filled(tomlkit.inline_table() if isinstance(place, Array | InlineTable) else tomlkit.table(), value)
    if isinstance(last, int) and last == len(place):
        place.append(value)
    else:
        place[last] = value


def _filled(made: Any, values: dict[str, Any]) -> Any:
    """A table of tomlkit with these values, its inner tables in braces on one line."""
    for name, value in values.items():
        made[name] = _filled(tomlkit.inline_table(), value) if isinstance(value, dict) else value
    return made


def dotted_key(key: Key) -> str:
    """Such as segment.film.electrodes[0].name."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in key).removeprefix(".")
