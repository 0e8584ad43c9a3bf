"""Files and folders that are written whole or not at all, and text files that are read whole."""

import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from foundation.errors import InputError


@contextmanager
def whole_file(path: Path, shared: bool = False) -> Iterator[Path]:
    """Yield a path to write to; that file replaces path when the block ends without an exception.

    After any exception, Ctrl-C too, nothing is left beside path. A process that was killed leaves .NAME.part.
    shared : whether several processes may write path at once; each then writes under a name of its own.
    """
    own = f".{os.urandom(8).hex()}" if shared else ""
    beside = path.with_name(f".{path.name}{own}.part")
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


LARGEST_TEXT_MB = 50
"""More than any configuration or table of a waveform holds; recordings have a bound of their own."""


def regular_file_size(path: Path, what: str) -> int:
    """Return the size in bytes of a regular file, symbolic links followed.

    what : how a message calls the file, such as "configuration 'mine.toml'". InputError when there is none, or when
    it is no regular file: a pipe or a device may never end.
    """
    try:
        found = path.stat()
    except FileNotFoundError:
        raise InputError(f"{what}: there is no such file") from None
    except OSError as error:
        raise InputError(f"{what}: cannot be read ({error.strerror})") from None
    except ValueError:
        raise InputError(f"{what}: the name of a file cannot contain a NUL character") from None
    if not stat.S_ISREG(found.st_mode):
        kind = "folder" if stat.S_ISDIR(found.st_mode) else "pipe or a device"
        raise InputError(f"{what}: this is a {kind}, a regular file is needed")
    return found.st_size


def read_text(path: Path, what: str) -> str:
    """Return the text of a UTF-8 file. InputError where it cannot be read or is too large.

    what : how a message calls the file.
    """
    size = regular_file_size(path, what)
    if size > 1e6 * LARGEST_TEXT_MB:
        raise InputError(f"{what}: has {size / 1e6:.0f} MB, at most {LARGEST_TEXT_MB} MB are read")
    try:
        return path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{what}: not UTF-8 text (byte {error.start}), save it as UTF-8") from None
    except OSError as error:
        raise InputError(f"{what}: cannot be read ({error.strerror})") from None


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder beside ``folder`` that takes its place when the block ends without error.

    A folder of that name from an earlier run is replaced; after an error it is untouched.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    scratch = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        new, old = scratch / "new", scratch / "old"
        new.mkdir()
        yield new
        if folder.exists():
            folder.rename(old)
        new.rename(folder)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def write_whole_text(path: Path, text: str) -> None:
    """Write a UTF-8 text file that never exists half-written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, shared=True) as beside:
        beside.write_text(text, "utf-8")
