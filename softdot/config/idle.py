"""Keys that no longer act beside a newly set value are removed from its table, so that modes can be exchanged."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from softdot.config.errors import tables_at
from softdot.config.schema import Config


def take_out_idle(tables: Any, way: Sequence[str | int]) -> None:
    """Remove from the table of a value, in place, the keys that do not act beside it; the value itself stays.

    tables : those of a configuration, as read. way : names and numbers that lead to the value.
    """
    with suppress(LookupError, TypeError):  # the table of the value may be gone, or be none
        for part in way[:-1]:
            tables = tables[part]
        for kind in tables_at(way[:-1], Config):
            if any(way[-1] in acts.tags for _, acts in kind.conditional_keys()):
                kept = kind.override_keys(tables, {str(way[-1]): tables[way[-1]]} if way[-1] in tables else {})
                for name in [name for name in tables if name not in kept]:
                    del tables[name]


def has_value(tables: Any, way: Sequence[str | int]) -> bool:
    """Whether nested tables hold a value at a path of names and numbers."""
    with suppress(LookupError, TypeError):
        for part in way:
            tables = tables[part]
        return True
    return False
