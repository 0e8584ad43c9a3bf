"""JSON kept beside the meshes under a name that holds the hash of all that it depends on."""

import json
from contextlib import suppress
from typing import Any

from geometry.cache import read_kept, write_kept
from mesh.cache import folder
from softdot.numbers import json_text


def recall(name: str) -> Any | None:
    """What was remembered under a name, None when nothing was or the file is damaged."""
    content = read_kept(folder() / f"{name}.json")
    return None if content is None else json.loads(content)


def remember(name: str, value: Any) -> None:
    """Keep a value; a cache that cannot be written is no cache."""
    with suppress(OSError):
        write_kept(folder() / f"{name}.json", json_text(value).encode())
