"""The text files that a user names, read whole: regular files of a bounded size in UTF-8, with or without a BOM."""

import stat
from pathlib import Path

from geometry.errors import InputError

LARGEST_MB = 50
"""More than any configuration or table of a waveform holds; recordings have a bound of their own."""


def regular_file(path: Path, what: str) -> int:
    """The size in bytes of the file that a symbolic link or name leads to.

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
    """The text of a file. what : how a message calls it. InputError with one sentence for what cannot be read."""
    size = regular_file(path, what)
    if size > 1e6 * LARGEST_MB:
        raise InputError(f"{what}: has {size / 1e6:.0f} MB, at most {LARGEST_MB} MB are read")
    try:
        return path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{what}: not UTF-8 text (byte {error.start}), save it as UTF-8") from None
    except OSError as error:
        raise InputError(f"{what}: cannot be read ({error.strerror})") from None
