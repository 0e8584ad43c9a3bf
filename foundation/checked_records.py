"""Records of results in JSON files, with a checksum of their own."""

import json
import logging
from contextlib import suppress
from pathlib import Path
from typing import Any

from foundation.cache import data_hash
from foundation.files import whole_file

CHECKSUM_KEY = "sha256"
"""Key of the SHA-256 of all the others, as canonical JSON."""


def write_checked(path: Path, record: dict[str, Any]) -> None:
    """Write a record of plain data and its checksum to the last digit, whole or not at all."""
    text = json.dumps({**record, CHECKSUM_KEY: data_hash(record)}, indent=2, allow_nan=False, ensure_ascii=False)
    with whole_file(path) as beside:
        beside.write_text(text + "\n", "utf-8")


def read_checked(path: Path, consequence: str) -> dict[str, Any] | None:
    """Return the record in a file without its checksum, or None where there is no file or it is damaged.

    A damaged file is deleted, and a warning says so. consequence : the end of that warning, what follows from it.
    """
    try:
        record = json.loads(path.read_bytes())
        if record.pop(CHECKSUM_KEY, None) == data_hash(record):
            return dict(record)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, AttributeError, TypeError, RecursionError):
        pass
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and %s", path, consequence)
    with suppress(OSError):
        path.unlink()
    return None
