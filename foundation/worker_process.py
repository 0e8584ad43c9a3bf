"""A process beside this one that does one call after another, on a core that this one leaves free.

Calls and answers are pickled through its standard input and output. Started with one argument: the process number of
its parent. It ends with its parent, however that ends.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from threading import Event
from typing import Any, Self

from foundation.child_processes import end_with_parent, own_path, own_python
from foundation.scratch_folders import sweep_scratch

OOM_SCORE = Path("/proc/self/oom_score_adj")


class ProcessDiedError(RuntimeError):
    """The process ended before it had answered."""


class Beside:
    """A process for the time of a block, with these environment variables beside those of this process.

    Calls are done in the order in which they were asked for; what a process that dies leaves undone is done here. At
    the end of the block, or when it is interrupted, the process is ended and calls that are not done yet are given up.
    An inner block may end it earlier.
    """

    def __init__(self, variables: Mapping[str, str] | None = None) -> None:
        command = own_python("-m", __name__, str(os.getpid()))
        own = {**os.environ, **(variables or {}), **own_path()}
        pipe = subprocess.PIPE
        # in a session of its own: Ctrl-C in the terminal reaches this process alone, which ends it
        self._process = subprocess.Popen(command, env=own, stdin=pipe, stdout=pipe, start_new_session=True)
        self._over, self._pool = Event(), ThreadPoolExecutor(1)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self.kill()
        self._pool.shutdown(cancel_futures=True)
        sweep_scratch()

    def kill(self) -> None:
        """End the process: asked to end, it could be held up by a library for seconds."""
        self._process.kill()
        self._process.wait()

    def __call__(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """What a function returns or raises, later; function : one that a module holds under its name."""
        return self._pool.submit(self._answer, function, *arguments)

    def _answer(self, function: Callable[..., Any], *arguments: Any) -> Any:
        try:
            return self.answer(function, *arguments)
        except ProcessDiedError:
            return None if self._over.is_set() else function(*arguments)

    def answer(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """What a function returns or raises, waited for. ProcessDiedError; by one thread at a time."""
        asked, answered = self._process.stdin, self._process.stdout
        assert asked is not None
        assert answered is not None
        call = pickle.dumps((function, arguments))
        try:
            asked.write(call)
            asked.flush()
            done, value = pickle.load(answered)
        except (OSError, ValueError, EOFError, pickle.UnpicklingError):
            raise ProcessDiedError from None
        if not done:
            raise value
        return value


def work() -> None:
    """Do what standard input asks for until it ends. What libraries print goes to standard error."""
    end_with_parent(int(sys.argv[1]))
    with suppress(OSError):  # where memory runs out, Linux ends this process rather than its parent
        OOM_SCORE.write_text("500", "ascii")
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    while True:
        try:
            function, arguments = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            answer = pickle.dumps((True, function(*arguments)))
        except Exception as error:
            answer = pickle.dumps((False, sendable(error)))
        answers.write(answer)
        answers.flush()


def sendable(error: Exception) -> Exception:
    """The error, or another one that says the same where it cannot be pickled or made again from its sentence."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


if __name__ == "__main__":
    work()
