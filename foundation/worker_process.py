"""A worker process that does one call after another, on a core that this process leaves free.

Calls and answers are pickled through its standard input and output. It is started with one argument, the process number
of its parent, and ends with its parent, however that ends.
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path
from threading import Event, Timer
from typing import IO, Any, Self

from foundation.child_processes import child_python_path, end_with_parent, python_command
from foundation.scratch_folders import sweep_scratch

Tell = Callable[[Any], None]
DONE, RAISED, TOLD = "done", "raised", "told"
"""Kinds of what a worker sends: the result of a call, an error, or a message of a call on its way."""
OOM_SCORE_FILE = Path("/proc/self/oom_score_adj")
LONGEST_END_S = 5.0


class ProcessDiedError(RuntimeError):
    """A worker process that ended before it had answered."""


class WorkerProcess:
    """A worker process for the time of a block.

    Calls are done in the order in which they were submitted; what a process that dies leaves undone is done here. At
    the end of the block, or when it is interrupted, the process is ended and calls that are not done yet are given up.
    An inner block may end it earlier.
    """

    def __init__(self, variables: Mapping[str, str] | None = None, log: IO[bytes] | None = None) -> None:
        """variables : environment variables of the worker beside those of this process. log : file that takes what
        libraries print there, else the standard error of this process does.
        """
        command = python_command("-m", __name__, str(os.getpid()))
        own = {**os.environ, **(variables or {}), **child_python_path()}
        pipe = subprocess.PIPE
        # in a session of its own: Ctrl-C in the terminal reaches this process alone, which ends it
        self._process = subprocess.Popen(command, env=own, stdin=pipe, stdout=pipe, stderr=log, start_new_session=True)
        self._over, self._pool = Event(), ThreadPoolExecutor(1)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    @property
    def is_alive(self) -> bool:
        """Whether it can do another call."""
        return self._process.poll() is None

    def end(self) -> None:
        """End the process at once, with what it has started, and give up the calls that are not done."""
        self._over.set()
        self.kill()
        self._pool.shutdown(cancel_futures=True)
        sweep_scratch()

    def interrupt(self) -> bool:
        """Send SIGINT, on which a call may stop if it listens to it; whether this platform can."""
        if os.name != "posix" or not self.is_alive:
            return False
        self._process.send_signal(signal.SIGINT)
        return True

    def kill(self) -> None:
        """Kill the process at once: a library could hold up one that is asked to end for seconds."""
        self._process.kill()
        self._process.wait()

    def exit_status(self) -> int:
        """Return the exit status of a process that died, negative for a signal; one that still ends is waited for."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(LONGEST_END_S)
        self.kill()
        return int(self._process.returncode)

    def __call__(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Return the future of a call. function : one that a module holds under its name."""
        return self._pool.submit(self._call_or_do_here, function, *arguments)

    def _call_or_do_here(self, function: Callable[..., Any], *arguments: Any) -> Any:
        try:
            return self.call(function, *arguments)
        except ProcessDiedError:
            return None if self._over.is_set() else function(*arguments)

    def begin(self, function: Callable[..., Any], *arguments: Any, tell: Tell | None = None) -> "Future[Any]":
        """Return the future of a call, which raises ProcessDiedError where the worker ends before. See call."""
        return self._pool.submit(self.call, function, *arguments, tell=tell)

    def call(self, function: Callable[..., Any], *arguments: Any, tell: Tell | None = None) -> Any:
        """Do a call in the worker and return what the function returns, or raise what it raises.

        tell : given to the function by this name where it is stated; what the function calls it with, it is called with
        here. ProcessDiedError where the worker ends before. Only one thread may call at a time.
        """
        asked, answered = self._process.stdin, self._process.stdout
        assert asked is not None
        assert answered is not None
        call = pickle.dumps((function, arguments, tell is not None))
        try:
            asked.write(call)
            asked.flush()
            kind, value = pickle.load(answered)
            while kind == TOLD and tell is not None:
                tell(value)
                kind, value = pickle.load(answered)
        except (OSError, ValueError, EOFError, pickle.UnpicklingError):
            raise ProcessDiedError from None
        if kind == RAISED:
            raise value
        return value

    def call_within(self, timeout_s: float, function: Callable[..., Any], *arguments: Any) -> Any:
        """Do a call as call does, but kill the worker after a time in s. TimeoutError."""
        over = Event()

        def stop() -> None:
            over.set()
            self._process.kill()

        limit = Timer(timeout_s, stop)
        limit.start()
        try:
            return self.call(function, *arguments)
        except ProcessDiedError:
            if over.is_set():
                raise TimeoutError(f"a call took longer than {timeout_s:g} s") from None
            raise
        finally:
            limit.cancel()


def serve_calls() -> None:
    """Do the calls that come on standard input until it ends. What libraries print goes to standard error."""
    end_with_parent(int(sys.argv[1]))
    with suppress(OSError):  # where memory runs out, Linux ends this process rather than its parent
        OOM_SCORE_FILE.write_text("500", "ascii")
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())

    def send(kind: str, value: Any) -> None:
        answers.write(pickle.dumps((kind, value)))
        answers.flush()

    while True:
        try:
            function, arguments, is_told = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            send(DONE, function(*arguments, **({"tell": partial(send, TOLD)} if is_told else {})))
        except Exception as error:
            send(RAISED, picklable_error(error))


def picklable_error(error: Exception) -> Exception:
    """Return the error, or a RuntimeError with the same message where it cannot be pickled or rebuilt from it."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


if __name__ == "__main__":
    serve_calls()
