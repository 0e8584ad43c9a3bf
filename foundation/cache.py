"""Files that softdot keeps on disk for itself.

Each file ends with a SHA-256 of its content, so that damage is never believed: a damaged file is deleted and made
again. Arrays go into one .npz file without pickle; several processes may write and read it at once.
foundation.source_hash says on which sources of the program such a file depends.
"""

import hashlib
import json
import logging
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, TypeVar

import numpy as np

from foundation.errors import InputError
from foundation.files import whole_file

CHECKSUM_MARK = b"\nsoftdot sha256 "
TRAILER_BYTES = len(CHECKSUM_MARK) + 64 + 1


def cache_folder() -> Path:
    """Return the folder in which files are kept: SOFTDOT_CACHE, or the user's cache folder of this platform."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_CACHE") or user_cache_dir("softdot", appauthor=False))


def check_cache_folder() -> None:
    """Raise InputError where SOFTDOT_CACHE names a folder that cannot be made or written.

    The platform's own folder may be closed to this process; then nothing is kept.
    """
    stated = os.environ.get("SOFTDOT_CACHE")
    if not stated:
        return
    try:
        Path(stated).mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=stated):
            pass
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(
            f"SOFTDOT_CACHE = '{stated}': cannot be used as the folder of the cache ({reason}); name a folder that can "
            "be written, or unset it"
        ) from None


def write_with_checksum(path: Path, content: bytes) -> None:
    """Write bytes and their checksum into a file, whole, and make its folder. OSError when it cannot be written.

    Several processes may write and read it at once.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside:
        beside.write_bytes(content + _checksum_trailer(content))


def read_with_checksum(path: Path) -> bytes | None:
    """Return the bytes that write_with_checksum wrote, or None when there is no file or it is damaged.

    A damaged file is deleted, and a warning says so.
    """
    try:
        whole = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        logging.getLogger("softdot").warning("'%s' cannot be read (%s); it is made again", path, error.strerror)
        return None
    content = whole[:-TRAILER_BYTES]
    if whole[-TRAILER_BYTES:] == _checksum_trailer(content):
        return content
    logging.getLogger("softdot").warning("'%s' is damaged; it is deleted and made again", path)
    _delete(path)
    return None


def _checksum_trailer(content: bytes) -> bytes:
    """Return the end of a file with this content."""
    return CHECKSUM_MARK + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _delete(path: Path) -> None:
    """Remove a file where that is allowed; elsewhere its wrong checksum still keeps it from being believed."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return


Content = TypeVar("Content")


def write_arrays(path: Path, arrays: Mapping[str, Any], compressed: bool = False) -> None:
    """Write named arrays into a .npz file with a checksum, and make its folder. OSError when it cannot be written."""
    buffer = BytesIO()
    (np.savez_compressed if compressed else np.savez)(buffer, **arrays)
    write_with_checksum(path, buffer.getvalue())


def read_arrays(path: Path, decode: Callable[[Mapping[str, Any]], Content]) -> Content | None:
    """Return what decode makes of the arrays in a file; None when there is no file, or it is damaged or refused.

    decode : refuses arrays by KeyError, TypeError or ValueError; as the checksum is right, another program wrote them.
    """
    content = read_with_checksum(path)
    if content is None:
        return None
    try:
        with np.load(BytesIO(content), allow_pickle=False) as data:
            return decode(data)
    except (ValueError, KeyError, TypeError):
        return None


def data_hash(content: Any) -> str:
    """Return the SHA-256, in hexadecimal, of data that JSON can hold, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def recall(name: str) -> Any | None:
    """Return the plain data remembered under a name, or None when there are none or the file is damaged."""
    content = read_with_checksum(cache_folder() / f"{name}.json")
    return None if content is None else json.loads(content)


def remember(name: str, value: Any) -> None:
    """Keep plain data under a name, numbers to the last digit. Nothing happens where the cache cannot be written."""
    text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
    with suppress(OSError):
        write_with_checksum(cache_folder() / f"{name}.json", text.encode())
