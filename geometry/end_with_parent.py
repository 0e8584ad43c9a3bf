"""Child processes that end with the process that started them, also when that one is killed."""

import os
import sys
import threading
import time

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
