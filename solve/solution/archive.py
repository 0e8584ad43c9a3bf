"""Dataclasses, tuples and arrays in one .npz file without pickle: a JSON tree whose leaves may be arrays."""

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.cache import read_arrays, write_arrays


def write_archive(path: Path, content: Any) -> None:
    """Write the file whole. TypeError for what is neither dataclass, list, tuple, array, number, text nor None."""
    arrays: list[Floats] = []
    tree = _encode(content, arrays)
    named = {f"a{n}": array for n, array in enumerate(arrays)}
    write_arrays(path, {"tree": np.array(json.dumps(tree)), **named})


def read_archive(path: Path, types: Mapping[str, type]) -> Any:
    """Content of a file of write_archive, None when there is none or it is damaged; types : dataclasses by name."""
    return read_arrays(path, lambda data: _decode(json.loads(str(data["tree"])), data, types))


def _encode(value: Any, arrays: list[Floats]) -> Any:
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {"array": len(arrays) - 1}
    if is_dataclass(value) and not isinstance(value, type):
        inner = {field.name: _encode(getattr(value, field.name), arrays) for field in fields(value)}
        return {"type": type(value).__name__, "fields": inner}
    if isinstance(value, list | tuple):
        return {type(value).__name__: [_encode(item, arrays) for item in value]}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"an archive holds no {type(value).__name__}")


def _decode(tree: Any, data: Any, types: Mapping[str, type]) -> Any:
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return data[f"a{tree['array']}"]
    if "type" in tree:
        inner = {name: _decode(value, data, types) for name, value in tree["fields"].items()}
        return types[tree["type"]](**inner)
    ((kind, items),) = tree.items()
    decoded = [_decode(item, data, types) for item in items]
    return tuple(decoded) if kind == "tuple" else decoded
