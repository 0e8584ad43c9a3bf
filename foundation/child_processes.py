"""Python processes that this one starts: their modules are this program's, and they end with their parent."""

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SAFE_PATH = "PYTHONSAFEPATH"


def own_python(*arguments: str) -> list[str]:
    """A command that runs this Python, to be started with own_path: the working folder holds no modules of ours."""
    return [sys.executable, "-P", *arguments]


def own_path() -> dict[str, str]:
    """The variable by which a child process finds the modules of this one, and none in its working folder."""
    program = str(Path(__file__).resolve().parents[1])
    folders = [folder for folder in sys.path if folder]
    return {"PYTHONPATH": os.pathsep.join([*folders, *({program} - set(folders))])}


@contextmanager
def without_working_folder() -> Iterator[None]:
    """Python processes that libraries start inside this block do not look for modules in the working folder."""
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        os.environ.pop(SAFE_PATH)
        if before is not None:
            os.environ[SAFE_PATH] = before


EVERY_S = 1.0
PR_SET_PDEATHSIG, SIGKILL = 1, 9  # linux/prctl.h


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
