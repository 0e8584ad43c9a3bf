"""All mistakes of a configuration at once.

Each check of a run stops at the first mistake. Here that mistake is noted, its key set aside, and the rest checked
again, until nothing is refused: every sentence is the one that a run would say.
"""

import copy
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, TypeVar

from geometry.base import InputError
from softdot.dotted_keys import parsed

MOST = 100
DECIDES = {"shape", "model", "mode", "name", "component"}
"""What these say decides what else a table may hold: without it the table cannot be judged."""
KEY = re.compile(r'(?:[\w-]+|"[^"]+")(?:\.[\w-]+|\."[^"]+"|\[\d+\])*')
Checked = TypeVar("Checked")


def mistakes(
    tables: Mapping[str, Any], check: Callable[[Mapping[str, Any]], Checked]
) -> tuple[list[str], Checked | None]:
    """Every sentence with which check refuses the tables, and what it returns when there is none."""
    found: list[str] = []
    rest: dict[str, Any] = copy.deepcopy(dict(tables))
    while len(found) < MOST:
        try:
            checked = check(rest)
        except InputError as error:
            if str(error) not in found:
                found.append(str(error))
            if not _set_aside(rest, str(error)):
                return found, None
        else:
            return found, None if found else checked
    return found, None


def _set_aside(tables: dict[str, Any], sentence: str) -> bool:
    """Remove the key that a sentence begins with, or the nearest table above it; whether there was one."""
    match = KEY.match(sentence)
    if match is None:
        return False
    with suppress(ValueError):
        way = list(parsed(match[0]))
        if way[-1] in DECIDES and len(way) > 1:
            way.pop()
        while way:
            if _removed(tables, way):
                return True
            way.pop()
    return False


def _removed(tables: Any, way: list[str | int]) -> bool:
    for part in way[:-1]:
        try:
            tables = tables[part]
        except (KeyError, IndexError, TypeError):
            return False
    try:
        del tables[way[-1]]
    except (KeyError, IndexError, TypeError):
        return False
    return True
