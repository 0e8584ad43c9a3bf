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
from softdot.config.errors import dotted, tables_at
from softdot.config.schema import Config
from softdot.config.toml import parsed

MOST = 100
DECIDES = {"model", "name", "component"}
"""What these say decides what else a table may hold: without it the table cannot be judged."""
KEY = re.compile(r'(?:[\w-]+|"[^"]+")(?:\.[\w-]+|\."[^"]+"|\[\d+\])*')
Checked = TypeVar("Checked")
Way = tuple[str | int, ...]


def mistakes(
    tables: Mapping[str, Any], check: Callable[[Mapping[str, Any]], Checked]
) -> tuple[list[str], Checked | None]:
    """Every sentence with which check refuses the tables, and what it returns when there is none."""
    found: list[str] = []
    rest = _Rest(tables)
    while len(found) < MOST:
        try:
            checked = check(rest.tables)
        except InputError as error:
            said = rest.as_in_the_file(str(error))
            if said not in found and not rest.was_told(said):
                found.append(said)
            if not rest.set_aside(str(error)):
                return found, None
        else:
            return found, None if found else checked
    return found, None


class _Rest:
    """tables : what has not been set aside. gone : list, as the file names it -> its elements that have been.

    told : keys, as the file names them, that have been set aside, and what mistyped ones were probably meant to be.
    """

    def __init__(self, tables: Mapping[str, Any]) -> None:
        self.tables: dict[str, Any] = copy.deepcopy(dict(tables))
        self.gone: dict[str, list[int]] = {}
        self.told: set[str] = set()

    def was_told(self, sentence: str) -> bool:
        """Whether a sentence asks for a key that is missing only because another sentence was about it."""
        key = KEY.match(sentence)
        if key and key[0].endswith("]") and key[0].rpartition("[")[0] in self.gone and "] is missing" in sentence:
            return True
        return any("." in key and key in self.told for key in KEY.findall(sentence))

    def as_in_the_file(self, sentence: str) -> str:
        """A sentence on the rest with the indices of the file."""
        return KEY.sub(lambda key: self._renamed(key[0]), sentence) if self.gone else sentence

    def _renamed(self, key: str) -> str:
        if "[" not in key:
            return key
        with suppress(ValueError):
            return dotted(self._in_the_file(parsed(key)))
        return key

    def _in_the_file(self, way: Way) -> Way:
        there: list[str | int] = []
        for part in way:
            if isinstance(part, int):
                for gone in sorted(self.gone.get(dotted(there), [])):
                    part += gone <= part
            there.append(part)
        return tuple(there)

    def set_aside(self, sentence: str) -> bool:
        """Remove the key that a sentence begins with, or the nearest table above it; whether there was one."""
        match = KEY.match(sentence)
        if match is None:
            return False
        with suppress(ValueError):
            way = parsed(match[0])
            meant = re.search(r"did you mean '([\w.]+)'", sentence)
            if meant is not None:
                self.told.add(dotted((*self._in_the_file(way)[:-1], meant[1])))
            if way[-1] in DECIDES and len(way) > 1:
                way = way[:-1]
            while way:
                if self._remove(way) or self._remove_tags_of(way):
                    return True
                way = way[:-1]
        return False

    def _remove_tags_of(self, way: Way) -> bool:
        """A key is missing that others ask for: those are what can be set aside."""
        keys = [key for table in tables_at(way[:-1], Config) for key in table.conditional_keys()]
        tags = {tag for name, acts in keys if name == way[-1] for tag in acts.tags}
        removed = [self._remove((*way[:-1], tag)) for tag in sorted(tags)]
        return any(removed)

    def _remove(self, way: Way) -> bool:
        *above, last = way
        table = self._at(above)
        try:
            removed = table[last]
            del table[last]
        except (KeyError, IndexError, TypeError):
            return False
        *there, index = self._in_the_file(way)
        self.told.add(dotted([*there, index]))
        if isinstance(last, int):
            self.gone.setdefault(dotted(there), []).append(int(index))
        for other in list(self._dependent(way, removed)):
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

    def _dependent(self, way: Way, removed: Any) -> Iterator[Way]:
        """What can only be judged together with what stood there, the last element of a list first."""
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
            yield from (("segment", "bonds", n) for n in self._numbers(["segment", "bonds"], "between", "effector"))
        for part in _components(way, removed):
            yield from (("mechanisms", n) for n in self._numbers(["mechanisms"], "component", part))

    def _numbers(self, way: Sequence[str], key: str, part: str) -> list[int]:
        """Elements of a list of tables whose key holds something."""
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
