"""Results as JSON: numbers that it knows, files that are whole, and records with a checksum of their own."""

import json
import logging
import math
from contextlib import suppress
from pathlib import Path
from typing import Any

from geometry.whole_file import whole_file
from mesh.fingerprint import data_hash

CHECKSUM = "sha256"
"""Key of the SHA-256 of all the others, as canonical JSON."""


def plain(value: Any) -> Any:
    """The same data in Python's own types; NaN and infinity, which JSON lacks, become None."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):  # numpy arrays and scalars
        return plain(value.tolist())
    if isinstance(value, float):
        return float(f"{value:.12g}") + 0.0 if math.isfinite(value) else None  # -0.0 + 0.0 = 0.0
    return value


def json_text(value: Any) -> str:
    """Indented, valid JSON with a final newline."""
    return json.dumps(plain(value), indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def write_json(path: Path, value: Any) -> None:
    """Write JSON that never exists half-written."""
    with whole_file(path) as beside:
        beside.write_text(json_text(value), "utf-8")


def write_checked(path: Path, record: dict[str, Any]) -> None:
    """Write a record of plain data and its checksum to the last digit, whole or not at all."""
    text = json.dumps({**record, CHECKSUM: data_hash(record)}, indent=2, allow_nan=False, ensure_ascii=False)
    with whole_file(path) as beside:
        beside.write_text(text + "\n", "utf-8")


def read_checked(path: Path, consequence: str) -> dict[str, Any] | None:
    """What was written. None without a file, and for a damaged one: then a warning says so, and it is deleted.

    consequence : what follows from that, for the warning.
    """
    try:
        record = json.loads(path.read_bytes())
        if record.pop(CHECKSUM, None) == data_hash(record):
            return dict(record)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, AttributeError, TypeError, RecursionError):
        pass
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and %s", path, consequence)
    with suppress(OSError):
        path.unlink()
    return None
