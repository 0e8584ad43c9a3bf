"""All mistakes of a configuration at once, each in the sentence that a run would say.

Each check of a run stops at the first mistake. Here that mistake is noted and its key set aside, with all that depends
on it, and the rest is checked again until nothing is refused. What is said names elements of lists as the file counts
them, whatever has been set aside.
"""

import copy
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, TypeVar

from foundation.errors import InputError
from softdot.config.errors import dotted_key, tables_at
from softdot.config.schema import Config
from softdot.config.toml import key_path

MOST_MISTAKES = 100
DECIDING_KEYS = {"model", "name", "component"}
"""Keys whose value decides what else their table may hold: without it the table cannot be judged."""
DOTTED_KEY = re.compile(r'(?:[\w-]+|"[^"]+")(?:\.[\w-]+|\."[^"]+"|\[\d+\])*')
"""A dotted key at the beginning or within a sentence."""
Checked = TypeVar("Checked")
Way = tuple[str | int, ...]


def mistakes(
    tables: Mapping[str, Any], check: Callable[[Mapping[str, Any]], Checked]
) -> tuple[list[str], Checked | None]:
    """Sentences with which check refuses the tables, at most MOST_MISTAKES, and its result when there is none."""
    found: list[str] = []
    rest = _Rest(tables)
    while len(found) < MOST_MISTAKES:
        try:
            checked = check(rest.tables)
        except InputError as error:
            said = rest.with_file_indices(str(error))
            if said not in found and not rest.follows_from_earlier(said):
                found.append(said)
            if not rest.set_aside(str(error)):
                return found, None
        else:
            return found, None if found else checked
    return found, None


class _Rest:
    """The tables without the keys that have been set aside.

    gone : list, as the file names it -> numbers of its removed elements. named_keys : removed keys, as the file names
    them, and what mistyped ones were probably meant to be.
    """

    def __init__(self, tables: Mapping[str, Any]) -> None:
        self.tables: dict[str, Any] = copy.deepcopy(dict(tables))
        self.gone: dict[str, list[int]] = {}
        self.named_keys: set[str] = set()

    def follows_from_earlier(self, sentence: str) -> bool:
        """Whether a sentence asks for a key that is missing only because another sentence was about it."""
        key = DOTTED_KEY.match(sentence)
        if key and key[0].endswith("]") and key[0].rpartition("[")[0] in self.gone and "] is missing" in sentence:
            return True
        return any("." in key and key in self.named_keys for key in DOTTED_KEY.findall(sentence))

    def with_file_indices(self, sentence: str) -> str:
        """A sentence on the rest, with elements of lists counted as in the file."""
        return DOTTED_KEY.sub(lambda key: self._key_in_the_file(key[0]), sentence) if self.gone else sentence

    def _key_in_the_file(self, key: str) -> str:
        if "[" not in key:
            return key
        with suppress(ValueError):
            return dotted_key(self._in_the_file(key_path(key)))
        return key

    def _in_the_file(self, way: Way) -> Way:
        there: list[str | int] = []
        for part in way:
            if isinstance(part, int):
                for gone in sorted(self.gone.get(dotted_key(there), [])):
                    part += gone <= part
            there.append(part)
        return tuple(there)

    def set_aside(self, sentence: str) -> bool:
        """Remove the key that a sentence begins with, or the nearest table above it; False where there is neither."""
        match = DOTTED_KEY.match(sentence)
        if match is None:
            return False
        with suppress(ValueError):
            way = key_path(match[0])
            meant = re.search(r"did you mean '([\w.]+)'", sentence)
            if meant is not None:
                self.named_keys.add(dotted_key((*self._in_the_file(way)[:-1], meant[1])))
            if way[-1] in DECIDING_KEYS and len(way) > 1:
                way = way[:-1]
            while way:
                if self._remove(way) or self._remove_tags_of(way):
                    return True
                way = way[:-1]
        return False

    def _remove_tags_of(self, way: Way) -> bool:
        """Remove the keys that ask for a missing key, which itself cannot be set aside; whether there were any."""
        keys = [key for table in tables_at(way[:-1], Config) for key in table.conditional_keys()]
        tags = {tag for name, acts in keys if name == way[-1] for tag in acts.tags}
        removed = [self._remove((*way[:-1], tag)) for tag in sorted(tags)]
        return any(removed)

    def _remove(self, way: Way) -> bool:
        """Remove a value and what depends on it; False where there is none."""
        *above, last = way
        table = self._at(above)
        try:
            removed = table[last]
            del table[last]
        except (KeyError, IndexError, TypeError):
            return False
        *there, index = self._in_the_file(way)
        self.named_keys.add(dotted_key([*there, index]))
        if isinstance(last, int):
            self.gone.setdefault(dotted_key(there), []).append(int(index))
        for other in list(self._dependent_keys(way, removed)):
            self._remove(other)
        return True

    def _at(self, way: Sequence[str | int]) -> Any:
        table: Any = self.tables
        for part in way:
            try:
                table = table[part]
            except (KeyError, IndexError, TypeError):
                return None
        return table

    def _dependent_keys(self, way: Way, removed: Any) -> Iterator[Way]:
        """Paths of what can only be judged together with a removed value, the last element of a list first."""
        for table in tables_at(way[:-1], Config):
            yield from ((*way[:-1], name) for name, acts in table.conditional_keys() if way[-1] in acts.tags)
        if way[0] == "materials":
            layers = self._at(["segment"])
            named = layers.items() if isinstance(layers, dict) else ()
            for layer, inner in named:
                if isinstance(inner, dict) and inner.get("material") in way[1:2]:
                    yield ("segment", layer, "material")
        if way == ("segment", "effector"):
            yield ("segment", "held_layers")
            yield from (
                ("segment", "bonds", n) for n in self._element_numbers(["segment", "bonds"], "between", "effector")
            )
        for part in _components(way, removed):
            yield from (("mechanisms", n) for n in self._element_numbers(["mechanisms"], "component", part))

    def _element_numbers(self, way: Sequence[str], key: str, part: str) -> list[int]:
        """Numbers, from the last, of those tables in a list whose key holds a text."""
        tables = self._at(way)
        if not isinstance(tables, list):
            return []
        return [n for n, one in reversed(list(enumerate(tables))) if isinstance(one, dict) and part in one.get(key, ())]


def _components(way: Way, removed: Any) -> tuple[str, ...]:
    """Parts of the names of components that are not there without what stood there."""
    if way == ("segment", "effector"):
        return ("effector",)
    if way[:3] == ("segment", "film", "electrodes"):
        return ("channel-",)
    if way[:2] == ("segment", "bonds"):
        return ("bond-",)
    component = removed.get("component") if way[0] == "mechanisms" and isinstance(removed, dict) else None
    return (component,) if isinstance(component, str) and component.startswith("bond-") else ()
