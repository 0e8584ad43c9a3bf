"""Read a TOML file, or say in one sentence why not."""

import tomllib
from pathlib import Path
from typing import Any

from geometry.errors import InputError


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. InputError when it is missing, unreadable, not UTF-8 or not TOML."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"configuration '{path}': there is no such file") from None
    except IsADirectoryError:
        raise InputError(f"configuration '{path}': this is a folder, a TOML file is needed") from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"configuration '{path}': not UTF-8 text (byte {error.start}), save it as UTF-8"
        ) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"configuration '{path}': cannot be read ({reason})") from None
    return parse_toml(text, str(path))


def parse_toml(text: str, name: str) -> dict[str, Any]:
    """The tables of a TOML text. InputError with line and column when it is none."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"configuration '{name}': not valid TOML, {error}") from None
