"""Numbers that no laboratory has: refused, because their squares and ratios leave the range of a computer's."""

from collections.abc import Iterator
from typing import Any

from geometry.errors import InputError
from softdot.config_errors import dotted, shown

LARGEST = 1e12


def refuse_absurd_numbers(tables: Any) -> None:
    """InputError for a finite number above 1e12 in size, or below 1e-12 but not zero."""
    for path, number in _numbers(tables, ()):
        size = abs(number)
        if LARGEST < size < float("inf") or 0.0 < size < 1.0 / LARGEST:
            allowed = f"between {1 / LARGEST:.0e} and {LARGEST:.0e} in size, or zero"
            raise InputError(f"{dotted(path)} = {shown(number)}: must be {allowed}")


def _numbers(value: Any, path: tuple[str | int, ...]) -> Iterator[tuple[tuple[str | int, ...], float]]:
    """Every number of the tables with its path."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _numbers(item, (*path, str(key)))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from _numbers(item, (*path, index))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path, value
