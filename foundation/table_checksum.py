"""The checksum of tables and of what is said of them."""

import json
from collections.abc import Mapping
from hashlib import sha256
from typing import Any

import numpy as np


def table_checksum(tables: Mapping[str, Any], about: Mapping[str, Any]) -> str:
    """Return the SHA-256, in hexadecimal, of data that JSON can hold and of tables in their order: names, types, shapes
    and numbers.
    """
    sha = sha256(json.dumps(about, sort_keys=True).encode())
    for name, table in tables.items():
        sha.update(f"{name} {table.dtype} {table.shape} ".encode())
        sha.update(np.ascontiguousarray(table).tobytes())
    return sha.hexdigest()
