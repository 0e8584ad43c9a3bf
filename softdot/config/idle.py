"""What no longer acts beside a value that was put into its table is taken out, so that modes can be exchanged."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from softdot.config.errors import tables_at
from softdot.config.schema import Config


def take_out_idle(tables: Any, way: Sequence[str | int]) -> None:
    """Take what does not act beside the value at a place out of its table; the value itself stays.

    tables : of a configuration, as read; changed in place. way : names and numbers that lead to the value.
    """
    with suppress(LookupError, TypeError):  # the table of the value may be gone, or be none
        for part in way[:-1]:
            tables = tables[part]
        for kind in tables_at(way[:-1], Config):
            if any(way[-1] in acts.tags for _, acts in kind.conditional_keys()):
                kept = kind.override_keys(tables, {str(way[-1]): tables[way[-1]]} if way[-1] in tables else {})
                for name in [name for name in tables if name not in kept]:
                    del tables[name]


def stated(tables: Any, way: Sequence[str | int]) -> bool:
    """Whether there is a value at a place."""
    with suppress(LookupError, TypeError):
        for part in way:
            tables = tables[part]
        return True
    return False
