"""Messages with arrays as binary frames, which a browser reads without decoding texts.

A frame is the length of its head (4 bytes, little-endian), the head (JSON), then the arrays, each at a multiple of four
bytes. In the head an array is {"at": offset behind the head, "bytes": length}.
"""

import base64
import json
import struct
from typing import Any

ARRAYS = frozenset(
    {
        "points", "displacement", "region", "outer", "section", "film", "stress", "strain", "charge", "pressure",
        "dotPoints", "dotCut", "colourMap", "diverging",
    }
)  # fmt: skip
"""Keys of a view whose values are base64 (export.viewer_data)."""


def packed(message: dict[str, Any]) -> bytes:
    """The frame of a message with a view."""
    parts: list[bytes] = []
    length = 0
    view = dict(message["view"] or {})
    for name in ARRAYS & view.keys():
        content = base64.b64decode(view[name])
        view[name] = {"at": length, "bytes": len(content)}
        parts.append(content + bytes(-len(content) % 4))
        length += len(parts[-1])
    head = json.dumps({**message, "view": view if message["view"] else None}).encode()
    head += b" " * (-len(head) % 4)
    return struct.pack("<I", len(head)) + head + b"".join(parts)
