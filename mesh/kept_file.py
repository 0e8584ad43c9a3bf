"""Files that softdot keeps for itself: each ends with a SHA-256 of its content, so that damage is never believed."""

import hashlib
import logging
from pathlib import Path

from geometry.whole_file import whole_file

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
