"""What softdot keeps on disk for itself.

Each file ends with a SHA-256 of its content, so that damage is never believed: a damaged file is deleted and made
again. Arrays go into one .npz file without pickle; several processes may write and read it at once. What a kept thing
depends on in the program says foundation.source_hash.
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

MARK = b"\nsoftdot sha256 "
TRAILER = len(MARK) + 64 + 1


def folder() -> Path:
    """Where meshes are kept: SOFTDOT_CACHE, or the user's cache folder of this platform."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_CACHE") or user_cache_dir("softdot", appauthor=False))


def check_folder() -> None:
    """InputError where SOFTDOT_CACHE names a folder that cannot be made or written.

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


def data_hash(content: Any) -> str:
    """Of what JSON can hold, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def recall(name: str) -> Any | None:
    """The plain data remembered under a name, None when nothing was or the file is damaged."""
    content = read_kept(folder() / f"{name}.json")
    return None if content is None else json.loads(content)


def remember(name: str, value: Any) -> None:
    """Keep plain data, to the last digit; a cache that cannot be written is no cache."""
    text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
    with suppress(OSError):
        write_kept(folder() / f"{name}.json", text.encode())
