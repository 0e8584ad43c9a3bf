"""Files that softdot keeps for itself: each ends with a SHA-256 of its content, so that damage is never believed.

Named arrays go into one .npz file without pickle; several processes may write and read it at once.
"""

import hashlib
import logging
from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from geometry.files import whole_file

MARK = b"\nsoftdot sha256 "
TRAILER = len(MARK) + 64 + 1


def write_kept(path: Path, content: bytes) -> None:
    """Write the file whole, in a folder that is made where it is missing. OSError when it cannot be written.

    Several processes may write and read it at once.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside:
        beside.write_bytes(content + _trailer(content))


def read_kept(path: Path) -> bytes | None:
    """What was written. None when there is no file, or when it is damaged: then a warning says so and it is deleted."""
    try:
        whole = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        logging.getLogger("softdot").warning("'%s' cannot be read (%s); it is made again", path, error.strerror)
        return None
    content = whole[:-TRAILER]
    if whole[-TRAILER:] == _trailer(content):
        return content
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and made again", path)
    _delete(path)
    return None


def _trailer(content: bytes) -> bytes:
    return MARK + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _delete(path: Path) -> None:
    """Remove the file; where that is not allowed, its checksum still keeps it from being believed."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return


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
