"""Temporary folders, of which those of processes that were killed are removed by the next one.

A process holds a scratch folder by an advisory lock on it (flock), which the kernel gives up when the process ends,
however it ends. Where a system has no such locks nothing is held and nothing is swept.
"""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import gettempdir

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None  # type: ignore[assignment]

PREFIX = "softdot-scratch-"


def hold(folder: Path) -> int | None:
    """Lock an existing folder until release; a file descriptor, or None while another process holds it.

    -1 where the file system has no locks. FileNotFoundError when the folder has been swept away.
    """
    if fcntl is None:
        return -1
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    except OSError:
        os.close(descriptor)
        return -1
    try:
        there = folder.stat()
        if (there.st_ino, there.st_dev) == (os.fstat(descriptor).st_ino, os.fstat(descriptor).st_dev):
            return descriptor
    except FileNotFoundError:
        pass
    os.close(descriptor)  # it was swept between opening and locking
    raise FileNotFoundError(folder)


def release(held: int | None) -> None:
    """Give up what hold has returned."""
    if held is not None and held >= 0:
        os.close(held)


def sweep(folder: Path) -> None:
    """Remove a folder that no process holds."""
    with suppress(OSError):
        held = hold(folder)
        if held is not None and held >= 0:
            shutil.rmtree(folder, ignore_errors=True)
        release(held)


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """A temporary folder of this process alone; those of processes that were killed are removed first."""
    sweep_scratch()
    folder, held = _made()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        release(held)


def sweep_scratch() -> None:
    """Remove the temporary folders of processes that were killed."""
    for left in Path(gettempdir()).glob(f"{PREFIX}*"):
        sweep(left)


def _made() -> tuple[Path, int | None]:
    """A new folder and the lock on it; made again where another process swept it before the lock."""
    while True:
        folder = Path(gettempdir()) / f"{PREFIX}{os.urandom(6).hex()}"
        folder.mkdir(mode=0o700)
        with suppress(FileNotFoundError):
            return folder, hold(folder)
