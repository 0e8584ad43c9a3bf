"""Data in the types of JSON, and files of them that never exist half-written."""

import json
import math
from pathlib import Path
from typing import Any

from foundation.files import whole_file


def plain(value: Any) -> Any:
    """The data in Python's own types, floats to twelve digits; NaN and infinity, which JSON lacks, become None."""
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
    """The data as indented, valid JSON with a final newline."""
    return json.dumps(plain(value), indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def write_json(path: Path, value: Any) -> None:
    """Write data as JSON, whole or not at all."""
    with whole_file(path) as beside:
        beside.write_text(json_text(value), "utf-8")
