"""Numbers that no laboratory has: their squares and ratios leave the range of a computer's numbers."""

from collections.abc import Iterator
from typing import Any

from geometry.base import InputError
from softdot.config_errors import dotted, shown

LARGEST = 1e12


def refuse_absurd_numbers(tables: Any) -> None:
    """InputError for a finite number above 1e12 in size."""
    for path, number in _numbers(tables, ()):
        if LARGEST < abs(number) < float("inf"):
            raise InputError(f"{dotted(path)} = {shown(number)}: must be at most {LARGEST:.0e} in size")


def without_round_off(value: Any) -> Any:
    """The same tables with zero for every number below 1e-12 in size: a script that subtracts leaves -1.1e-16."""
    if isinstance(value, dict):
        return {key: without_round_off(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [without_round_off(item) for item in value]
    return 0.0 if isinstance(value, float) and abs(value) < 1.0 / LARGEST else value


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
