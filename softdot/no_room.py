"""Errors caused by a full disk or memory, each reported in one sentence."""

import errno
import os
import shutil
import tempfile
from pathlib import Path

from foundation.executor import LostError
from softdot.console import BAD_INPUT, NOT_CONVERGED

READ_ONLY_ERRORS = {errno.EROFS, errno.EACCES, errno.EPERM}
"""Error numbers of a place that cannot be written."""
FULL_DISK_ERRORS = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the quota of the disk is used up",
    errno.EFBIG: "a limit of the size of files (ulimit -f) is reached",
}
"""Error number of a disk without room -> its words."""
OUT_OF_MEMORY_WORDS = ("bad_alloc", "out of memory", "cannot allocate memory", "unable to allocate")
"""Parts of the messages by which libraries report a lack of memory."""
ADVICE = "use larger element sizes, or a machine or a job with more memory"
"""The remedy for a lack of memory."""

LEAST_FREE_B = 65536  # a disk with less than this has had no room for the last block of a file
PROBE_FILE_B = 2**22
"""Size of the file that is written to test a disk."""


def refuse_cut_files(folder: Path) -> None:
    """OSError where the disk under a folder is full, or a file in it has reached the limit of the size of files.

    Some libraries then cut a file short and report nothing.
    """
    if shutil.disk_usage(folder).free < LEAST_FREE_B:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))
    limit = _largest_file_B()
    if limit is None:
        return
    for path in folder.rglob("*"):
        if path.is_file() and path.stat().st_size >= limit - 4096:
            raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))


def refuse_full_disk(folder: Path) -> None:
    """OSError where a file of some megabytes cannot be written into a folder: asked after a library has failed."""
    refuse_cut_files(folder)
    probe = folder / ".probe"
    try:
        probe.write_bytes(bytes(PROBE_FILE_B))
    finally:
        probe.unlink(missing_ok=True)


def _largest_file_B() -> int | None:
    """The limit of the size of files (ulimit -f), None without one."""
    try:
        import resource
    except ImportError:  # not on Windows
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_FSIZE)
    return None if soft == resource.RLIM_INFINITY else soft


def no_room_sentence(error: BaseException) -> tuple[str, int] | None:
    """Sentence and exit status for an error caused by a full disk or memory; None for any other.

    The causes of an error are looked at too, since libraries raise their own in place of the system's.
    """
    one: BaseException | None = error
    while one is not None:
        if isinstance(one, OSError) and one.errno in FULL_DISK_ERRORS:
            return (
                f"'{one.filename or tempfile.gettempdir()}' cannot be written: {FULL_DISK_ERRORS[one.errno]}",
                BAD_INPUT,
            )
        if isinstance(one, OSError) and one.errno in READ_ONLY_ERRORS:
            return f"'{one.filename or 'output'}' cannot be written ({one.strerror})", BAD_INPUT
        if isinstance(one, MemoryError) or (isinstance(one, OSError) and one.errno == errno.ENOMEM):
            return f"out of memory: {ADVICE}", NOT_CONVERGED
        if isinstance(one, LostError):
            return f"a press was given up, {one}; what was solved is kept: {ADVICE}", NOT_CONVERGED
        if any(text in str(one).lower() for text in OUT_OF_MEMORY_WORDS):
            return f"out of memory: {ADVICE}", NOT_CONVERGED
        one = one.__cause__ or one.__context__
    return None
