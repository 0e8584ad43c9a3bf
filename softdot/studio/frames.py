"""Messages to the page: JSON, and binary frames for those that hold arrays."""

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

ALIGNED = 8
"""Arrays begin at multiples of so many bytes, so that the page looks at them where they lie."""
KINDS = {"float32": "f4", "int16": "i2", "uint8": "u1", "uint32": "u4"}


def packed(message: Mapping[str, Any]) -> str | bytes:
    """JSON of a message. With arrays in it: bytes, four of which state the length of the JSON that follows.

    The JSON names an array {"array": KIND, "at": FIRST BYTE, "count": NUMBERS}; the bytes are counted from the end of
    the JSON, which blanks fill up to a multiple of ALIGNED. All numbers are little-endian.
    """
    pieces: list[bytes] = []
    length = 0

    def named(value: Any) -> Any:
        nonlocal length
        if isinstance(value, Mapping):
            return {key: named(one) for key, one in value.items()}
        if not isinstance(value, np.ndarray):
            return value
        content = np.ascontiguousarray(value, f"<{KINDS[value.dtype.name]}").tobytes()
        told = {"array": value.dtype.name, "at": length, "count": value.size}
        pieces.append(content + bytes(-len(content) % ALIGNED))
        length += len(pieces[-1])
        return told

    text = json.dumps(named(message))
    if not pieces:
        return text
    head = text.encode()
    head += b" " * (-(4 + len(head)) % ALIGNED)
    return b"".join([struct.pack("<I", len(head)), head, *pieces])
