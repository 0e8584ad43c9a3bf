"""Temporary folders; those of processes that were killed are removed by the next process.

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

SCRATCH_PREFIX = "softdot-scratch-"


def lock_folder(folder: Path) -> int | None:
    """Lock an existing folder and return a file descriptor, or None while another process holds it.

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


def unlock_folder(held: int | None) -> None:
    """Give up a lock that lock_folder has returned."""
    if held is not None and held >= 0:
        os.close(held)


def sweep_folder(folder: Path) -> None:
    """Remove a folder that no process holds."""
    with suppress(OSError):
        held = lock_folder(folder)
        if held is not None and held >= 0:
            shutil.rmtree(folder, ignore_errors=True)
        unlock_folder(held)


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Yield a temporary folder of this process alone; those of processes that were killed are removed first."""
    sweep_scratch()
    folder, held = _new_locked_folder()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        unlock_folder(held)


def sweep_scratch() -> None:
    """Remove the temporary folders of processes that were killed."""
    for left in Path(gettempdir()).glob(f"{SCRATCH_PREFIX}*"):
        sweep_folder(left)


def _new_locked_folder() -> tuple[Path, int | None]:
    """Return a new folder and its lock; another one where a process swept it before it was locked."""
    while True:
        folder = Path(gettempdir()) / f"{SCRATCH_PREFIX}{os.urandom(6).hex()}"
        folder.mkdir(mode=0o700)
        with suppress(FileNotFoundError):
            return folder, lock_folder(folder)
