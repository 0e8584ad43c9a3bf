"""Named arrays in one .npz file with a checksum, without pickle, that several processes may write and read at once."""

from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mesh.kept_file import read_kept, write_kept

Content = TypeVar("Content")


def write_arrays(path: Path, arrays: Mapping[str, Any], compressed: bool = False) -> None:
    """Write the file whole, in a folder that is made where it is missing. OSError when it cannot be written."""
    buffer = BytesIO()
    (np.savez_compressed if compressed else np.savez)(buffer, **arrays)
    write_kept(path, buffer.getvalue())


def read_arrays(path: Path, decoded: Callable[[Mapping[str, Any]], Content]) -> Content | None:
    """What decoded makes of the arrays; None when there is no file, it is damaged or decoded finds it wrong.

    decoded : says so by KeyError, TypeError or ValueError; the checksum leaves only another program's file for that.
    """
    content = read_kept(path)
    if content is None:
        return None
    try:
        with np.load(BytesIO(content), allow_pickle=False) as data:
            return decoded(data)
    except (ValueError, KeyError, TypeError):
        return None
