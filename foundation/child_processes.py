"""Python processes that this one starts: their modules are this program's, and they end with their parent."""

import os
import sys
import threading
import time
from pathlib import Path


def python_command(*arguments: str) -> list[str]:
    """Return a command that runs this Python without the working folder on its path; see child_python_path."""
    return [sys.executable, "-P", *arguments]


def child_python_path() -> dict[str, str]:
    """Return PYTHONPATH for a child process, by which it finds the modules of this one."""
    program = str(Path(__file__).resolve().parents[1])
    folders = [folder for folder in sys.path if folder]
    return {"PYTHONPATH": os.pathsep.join([*folders, *({program} - set(folders))])}


PARENT_CHECK_S = 1.0
PR_SET_PDEATHSIG, SIGKILL = 1, 9  # linux/prctl.h


def end_with_parent(parent: int) -> None:
    """Have the calling child process killed when its parent ends, however that ends.

    parent : process number, passed by the parent itself: it may have ended while the child was starting, and the child
    would then be given the number of another process.

    On Linux the kernel does it, since a mesher that holds Python's lock could not; elsewhere a thread does.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, SIGKILL)
        if os.getppid() != parent:  # it ended before
            os._exit(1)
    else:
        threading.Thread(target=_watch_parent, args=(parent,), daemon=True).start()


def _watch_parent(parent: int) -> None:
    """End this process once it belongs to another one."""
    while os.getppid() == parent:
        time.sleep(PARENT_CHECK_S)
    os._exit(1)
