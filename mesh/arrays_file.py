"""Named arrays in one .npz file, without pickle, that several processes may write and read at once."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar
from zipfile import BadZipFile

import numpy as np

from geometry.whole_file import whole_file

Content = TypeVar("Content")


def write_arrays(path: Path, arrays: Mapping[str, Any], compressed: bool = False) -> None:
    """Write the file whole, in a folder that is made where it is missing. OSError when it cannot be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside, beside.open("xb") as file:
        (np.savez_compressed if compressed else np.savez)(file, **arrays)


def read_arrays(path: Path, decoded: Callable[[Mapping[str, Any]], Content]) -> Content | None:
    """What decoded makes of the arrays; None when there is no file, it is damaged or decoded finds it wrong.

    decoded : says so by KeyError, TypeError or ValueError.
    """
    try:
        with np.load(path, allow_pickle=False) as data:
            return decoded(data)
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile):
        return None
