"""JSON kept beside the meshes under a name that holds the hash of all that it depends on."""

import json
from typing import Any

from geometry.whole_file import whole_file
from mesh.cache import folder
from softdot.numbers import json_text


def recall(name: str) -> Any | None:
    """What was remembered under a name, None when nothing was or the file is damaged."""
    try:
        return json.loads((folder() / f"{name}.json").read_text("utf-8"))
    except (OSError, ValueError):
        return None


def remember(name: str, value: Any) -> None:
    """Keep a value; a cache that cannot be written is no cache."""
    try:
        folder().mkdir(parents=True, exist_ok=True)
        with whole_file(folder() / f"{name}.json", shared=True) as beside:
            beside.write_text(json_text(value), "utf-8")
    except OSError:
        return
