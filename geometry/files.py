"""Files written whole or not at all, text files read whole, and child processes that end with their parent.

A process holds a scratch folder by an advisory lock on it (flock), which the kernel gives up when the process ends,
however it ends. Where a system has no such locks nothing is held and nothing is swept.
"""

import os
import shutil
import stat
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import gettempdir

from geometry.base import InputError


@contextmanager
def whole_file(path: Path, shared: bool = False) -> Iterator[Path]:
    """Yield where to write; that file takes the place of path when the block ends without an exception.

    After any exception, Ctrl-C too, nothing is left beside path. A process that was killed leaves .NAME.part.
    shared : several processes may write path at once, so each one writes beside under a name of its own.
    """
    own = f".{os.urandom(8).hex()}" if shared else ""
    beside = path.with_name(f".{path.name}{own}.part")
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


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


PR_SET_PDEATHSIG, SIGKILL = 1, 9  # linux/prctl.h
EVERY_S = 1.0


def end_with_parent(parent: int) -> None:
    """Called by a child: have it killed when its parent ends, however that ends.

    parent : process number, told by the parent itself: it may have ended while the child was starting, and who asks
    then is told of another process.

    On Linux by the kernel, since a mesher that holds Python's lock could not see to it; elsewhere by a thread.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, SIGKILL)
        if os.getppid() != parent:  # it ended before
            os._exit(1)
    else:
        threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    """End this process once it belongs to another one."""
    while os.getppid() == parent:
        time.sleep(EVERY_S)
    os._exit(1)
