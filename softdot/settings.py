"""--set key=value: one value of the configuration from the command line."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from geometry.base import InputError
from softdot.dotted_keys import with_value

BARE_WORD = re.compile(r"[A-Za-z][\w-]*")


def with_settings(tables: Mapping[str, Any], settings: Sequence[str]) -> dict[str, Any]:
    """The tables with each 'dotted.key=value' put in its place, the value as TOML writes it.

    A bare word that is no TOML value counts as a text: quotes would need quotes of their own in a shell.
    InputError naming the flag.
    """
    changed = dict(tables)
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise InputError(f"--set {setting}: must be key=value, such as press.indentation_mm=0.2")
        try:
            changed = with_value(changed, key.strip(), _value(text.strip()))
        except (InputError, ValueError) as error:
            raise InputError(f"--set {setting}: {error}") from None
    return changed


@contextmanager
def naming_the_flag(settings: Sequence[str]) -> Iterator[None]:
    """A refusal of a key that --set gave names the flag."""
    try:
        yield
    except InputError as error:
        for setting in settings:
            if str(error).startswith(setting.partition("=")[0].strip()):
                raise InputError(f"--set {setting}: {error}") from None
        raise


def _value(text: str) -> Any:
    try:
        read = tomllib.loads(f"value = {text}\n")
    except (ValueError, RecursionError):
        if BARE_WORD.fullmatch(text):
            return text
        raise ValueError("the value is not TOML; a text needs quotes, a list square brackets") from None
    if set(read) != {"value"}:
        raise ValueError("must be a single value")
    return read["value"]
