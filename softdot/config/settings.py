"""--set key=value: one value of the configuration from the command line."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from foundation.errors import InputError
from softdot.config.idle import take_out_idle
from softdot.config.toml import key_path, with_value

BARE_WORD = re.compile(r"[A-Za-z][\w-]*")


def with_settings(tables: Mapping[str, Any], settings: Sequence[str]) -> dict[str, Any]:
    """The tables with each 'dotted.key=value' put in its place, the value as TOML writes it.

    A bare word that is no TOML value counts as a text: quotes would need quotes of their own in a shell. What no longer
    acts beside a value is left out, unless it is set as well. InputError naming the flag.
    """
    changed, given = _with_each(tables, settings)
    for way in given:
        take_out_idle(changed, way)
    return _with_each(changed, settings)[0]


def _with_each(
    tables: Mapping[str, Any], settings: Sequence[str]
) -> tuple[dict[str, Any], list[tuple[str | int, ...]]]:
    """The tables with each setting in its place, and the places."""
    changed = dict(tables)
    given: list[tuple[str | int, ...]] = []
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise InputError(f"--set {setting}: must be key=value, such as press.indentation_mm=0.2")
        try:
            way = key_path(key.strip())
            if any(way == earlier[: len(way)] for earlier in given):
                raise ValueError("this key, or one inside it, is given before; state each once")
            given.append(way)
            changed = with_value(changed, key.strip(), _value(text.strip()))
        except (InputError, ValueError) as error:
            raise InputError(f"--set {setting}: {error}") from None
    return changed, given


@contextmanager
def naming_the_flag(settings: Sequence[str]) -> Iterator[None]:
    """Make a refusal within the block, of a key that --set gave, name the flag."""
    try:
        yield
    except InputError as error:
        for setting in settings:
            if str(error).startswith(setting.partition("=")[0].strip()):
                raise InputError(f"--set {setting}: {error}") from None
        raise


def _value(text: str) -> Any:
    """A value as TOML writes it, or a bare word. ValueError."""
    try:
        read = tomllib.loads(f"value = {text}\n")
    except (ValueError, RecursionError):
        if BARE_WORD.fullmatch(text):
            return text
        raise ValueError("the value is not TOML; a text needs quotes, a list square brackets") from None
    if set(read) != {"value"}:
        raise ValueError("must be a single value")
    return read["value"]
