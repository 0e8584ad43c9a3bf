"""Where a press stands, on disk, so that a run that was killed goes on where it was: dataclasses, tuples and arrays
in one .npz file without pickle, a JSON tree whose leaves may be arrays.
"""

import json
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.cache import read_arrays, write_arrays
from solve.recorder import Recorder
from solve.result import Fields, Record, Step
from solve.system import Load, State


def write_archive(path: Path, content: Any) -> None:
    """Write the file whole. TypeError for what is neither dataclass, list, tuple, array, number, text nor None."""
    arrays: list[Floats] = []
    tree = _encoded(content, arrays)
    named = {f"a{n}": array for n, array in enumerate(arrays)}
    write_arrays(path, {"tree": np.array(json.dumps(tree)), **named})


def read_archive(path: Path, types: Mapping[str, type]) -> Any:
    """What was written, None when there is no file or it is damaged; types : dataclasses by name."""
    return read_arrays(path, lambda data: _decoded(json.loads(str(data["tree"])), data, types))


def _encoded(value: Any, arrays: list[Floats]) -> Any:
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {"array": len(arrays) - 1}
    if is_dataclass(value) and not isinstance(value, type):
        inner = {field.name: _encoded(getattr(value, field.name), arrays) for field in fields(value)}
        return {"type": type(value).__name__, "fields": inner}
    if isinstance(value, list | tuple):
        return {type(value).__name__: [_encoded(item, arrays) for item in value]}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"an archive holds no {type(value).__name__}")


def _decoded(tree: Any, data: Any, types: Mapping[str, type]) -> Any:
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return data[f"a{tree['array']}"]
    if "type" in tree:
        inner = {name: _decoded(value, data, types) for name, value in tree["fields"].items()}
        return types[tree["type"]](**inner)
    ((kind, items),) = tree.items()
    decoded = [_decoded(item, data, types) for item in items]
    return tuple(decoded) if kind == "tuple" else decoded


EVERY_S = 15.0  # between two writings; a short press writes none
TYPES = {kind.__name__: kind for kind in (State, Load, Step, Fields, Record)}


@dataclass
class Checkpoint:
    """One file. key : a hash of all that the press depends on; a file of another key counts as none."""

    path: Path
    key: str
    written: float = 0.0

    def load(self, recorder: Recorder, unknowns: int) -> list[State]:
        """The last converged states, and the recorder filled with what was recorded; nothing when there is none."""
        self.written = time.monotonic()
        found = read_archive(self.path, TYPES)
        if not isinstance(found, list) or found[0] != self.key:
            return []
        past: list[State] = found[1]
        if any(state.x.shape != (unknowns,) for state in past):
            return []
        recorder.restore(found[2])
        return past

    def save(self, past: list[State], recorder: Recorder) -> bool:
        """Write, unless the last writing was a moment ago; returns whether it was written now.

        A disk that cannot be written is no fault of the press.
        """
        if time.monotonic() - self.written < EVERY_S:
            return False
        try:
            write_archive(self.path, [self.key, past, recorder.memory()])
        except OSError:
            return False
        self.written = time.monotonic()
        return True

    def discard(self) -> None:
        """The press has ended."""
        with suppress(OSError):  # a file that stays is found to be of no use by its key
            self.path.unlink(missing_ok=True)
