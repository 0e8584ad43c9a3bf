"""A process beside this one that does one call after another, on a core that this one leaves free; and several of them.

Calls and answers are pickled through its standard input and output. Started with one argument: the process number of
its parent. It ends with its parent, however that ends.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from queue import Empty, SimpleQueue
from threading import Event, Thread
from typing import Any

from geometry.environment import ONE_THREAD
from geometry.files import end_with_parent, sweep_scratch


class Beside:
    """A process for the time of a block, with these environment variables beside those of this process.

    Calls are done in the order in which they were asked for; what a process that dies leaves undone is done here. At
    the end of the block, or when it is interrupted, the process is ended and calls that are not done yet are given up.
    An inner block may end it earlier.
    """

    def __init__(self, variables: Mapping[str, str] | None = None) -> None:
        command = [sys.executable, "-m", __name__, str(os.getpid())]
        own = {**os.environ, **(variables or {}), "PYTHONPATH": os.pathsep.join(sys.path)}
        pipe = subprocess.PIPE
        # in a session of its own: Ctrl-C in the terminal reaches this process alone, which ends it
        self._process = subprocess.Popen(command, env=own, stdin=pipe, stdout=pipe, start_new_session=True)
        self._over, self._pool = Event(), ThreadPoolExecutor(1)

    def __enter__(self) -> "Beside":
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._process.kill()  # asked to end, it could be held up by a library for seconds
        self._process.wait()
        self._pool.shutdown(cancel_futures=True)
        sweep_scratch()

    def __call__(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """What a function returns or raises, later; function : one that a module holds under its name."""
        return self._pool.submit(self._answer, function, *arguments)

    def _answer(self, function: Callable[..., Any], *arguments: Any) -> Any:
        asked, answered = self._process.stdin, self._process.stdout
        assert asked is not None
        assert answered is not None
        try:
            pickle.dump((function, arguments), asked)
            asked.flush()
            done, value = pickle.load(answered)
        except (OSError, EOFError, pickle.UnpicklingError):
            return None if self._over.is_set() else function(*arguments)
        if not done:
            raise value
        return value


def each_beside(function: Callable[[Any], Any], items: Mapping[str, Any], count: int) -> Iterator[tuple[str, Any]]:
    """Name and answer of each item as it is done by one of this many processes of one thread each, in the order given.

    What the function raises is raised here.
    """
    waiting: SimpleQueue[tuple[str, Any]] = SimpleQueue()
    done: SimpleQueue[tuple[str, Future[Any]]] = SimpleQueue()
    for item in items.items():
        waiting.put(item)
    over = Event()
    with ExitStack() as processes:
        try:
            for _ in range(count):
                ask = processes.enter_context(Beside(ONE_THREAD))
                Thread(target=_feed, args=(ask, function, waiting, done, over), daemon=True).start()
            for _ in items:
                name, future = done.get()
                yield name, future.result()
        finally:
            over.set()


def _feed(
    ask: Beside,
    function: Callable[[Any], Any],
    waiting: "SimpleQueue[tuple[str, Any]]",
    done: "SimpleQueue[tuple[str, Future[Any]]]",
    over: Event,
) -> None:
    """One process's share of the items."""
    while not over.is_set():
        try:
            name, item = waiting.get_nowait()
        except Empty:
            return
        future = ask(function, item)
        wait((future,))
        done.put((name, future))


def work() -> None:
    """Do what standard input asks for until it ends. What libraries print goes to standard error."""
    end_with_parent(int(sys.argv[1]))
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
            answer = pickle.dumps((False, error))
        answers.write(answer)
        answers.flush()


if __name__ == "__main__":
    work()
