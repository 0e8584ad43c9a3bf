"""Processes that work for the page: one task at a time, told of on the way, ended at any moment.

A task is a function below softdot.studio.work with plain arguments, and tell where it takes long: called with how far
it is. It is named ("press:coarse_press"), so that the process of the page loads no solver, and runs in a process of
its own, so that the page answers meanwhile, a crash costs that task alone, and cancelling is ending the
process: a library in the middle of a factorisation asks nobody.
"""

import asyncio
import logging
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from inspect import signature
from multiprocessing.connection import Connection
from typing import Any

from foundation.child_processes import end_with_parent, without_working_folder
from foundation.errors import InputError
from foundation.library_loading import without_garbage_collection

LOG = logging.getLogger(__name__)
WORK = "softdot.studio.work"
Tell = Callable[[dict[str, Any]], None]
WAITING, MOST_WAITING = 1, 2
"""Processes that wait with everything loaded, so that a press after a cancelled one begins at once."""


class TaskRefused(Exception):
    """Bad input, or a computation that has no result: one sentence for the page."""


class ProcessLost(Exception):
    """The process of a task ended by itself."""


class Worker:
    """One process. Created in the thread of the event loop, which alone calls it."""

    def __init__(self, warm_up: str) -> None:
        """warm_up : done before the first task, so that that is quick."""
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe()
        self.process = context.Process(target=serve_tasks, args=(theirs, os.getpid(), warm_up), daemon=True)
        with _deaf(), without_working_folder():
            self.process.start()
        theirs.close()
        self._loop = asyncio.get_running_loop()
        self._answer: asyncio.Future[Any] | None = None
        self._tell: Tell = lambda _: None
        threading.Thread(target=self._listen, daemon=True).start()

    async def run(self, task: str, *arguments: Any, tell: Tell = lambda _: None) -> Any:
        """What the task returns. TaskRefused, ProcessLost; where the waiting is cancelled, the process ends."""
        self._answer, self._tell = self._loop.create_future(), tell
        try:
            self._connection.send((task, arguments))
            return await self._answer
        except OSError:
            raise ProcessLost from None
        except asyncio.CancelledError:
            self.end()
            raise

    @property
    def alive(self) -> bool:
        """Whether it can do another task."""
        return self.process.is_alive()

    def end(self) -> None:
        """At once; what it has started ends with it."""
        self.process.kill()
        self.process.join()
        self._connection.close()

    def _listen(self) -> None:
        """In a thread: pass on what the process says until it ends."""
        with suppress(OSError, EOFError, RuntimeError):
            while True:
                kind, value = self._connection.recv()
                self._loop.call_soon_threadsafe(self._heard, kind, value)
        with suppress(RuntimeError):  # the loop is closed
            self._loop.call_soon_threadsafe(self._heard, "lost", None)

    def _heard(self, kind: str, value: Any) -> None:
        if kind == "told":
            self._tell(value)
        elif self._answer is not None and not self._answer.done():
            if kind == "done":
                self._answer.set_result(value)
            else:
                self._answer.set_exception(TaskRefused(value) if kind == "refused" else ProcessLost())


class InTurn:
    """One process for short tasks of everybody, one after the other; another one takes its place where it is lost."""

    def __init__(self, warm_up: str, longest_s: float) -> None:
        self._warm_up, self._longest_s = warm_up, longest_s
        self._worker: Worker | None = None
        self._lock = asyncio.Lock()

    def prepare(self) -> None:
        """Start the process."""
        if self._worker is None or not self._worker.alive:
            self._worker = Worker(self._warm_up)

    async def run(self, task: str, *arguments: Any) -> Any:
        """As Worker.run; where the waiting is cancelled, the process goes on. TimeoutError after longest_s."""
        running = asyncio.create_task(self._run(task, *arguments))
        running.add_done_callback(lambda done: done.cancelled() or done.exception())  # nobody may wait any more
        return await asyncio.shield(running)

    async def _run(self, task: str, *arguments: Any) -> Any:
        async with self._lock:
            self.prepare()
            assert self._worker is not None
            return await asyncio.wait_for(self._worker.run(task, *arguments), self._longest_s)

    def end(self) -> None:
        """At once."""
        if self._worker is not None:
            self._worker.end()


class Pool:
    """Processes that are alike. Each task has one to itself; one more waits, or two, and the others are ended."""

    def __init__(self, warm_up: str) -> None:
        self._warm_up = warm_up
        self._idle: list[Worker] = []
        self._busy: list[Worker] = []

    def prepare(self) -> None:
        """Start a process that waits for a task, where there is none."""
        self._idle = [worker for worker in self._idle if worker.alive]
        while len(self._idle) < WAITING:
            self._idle.append(Worker(self._warm_up))

    async def run(self, task: str, *arguments: Any, tell: Tell = lambda _: None) -> Any:
        """As Worker.run, in a process that is free, or in a new one."""
        self.prepare()
        worker = self._idle.pop(0)
        self._busy.append(worker)
        self.prepare()
        try:
            return await worker.run(task, *arguments, tell=tell)
        finally:
            self._busy.remove(worker)
            if worker.alive and len(self._idle) < MOST_WAITING:
                self._idle.append(worker)
            else:
                worker.end()

    def end(self) -> None:
        """All of them."""
        for worker in [*self._idle, *self._busy]:
            worker.end()


@contextmanager
def _deaf() -> Iterator[None]:
    """Processes that are started in this block do not hear Ctrl-C in the terminal: who started them ends them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def serve_tasks(connection: Connection, parent: int, warm_up: str) -> None:
    """In the process: do one task after another until the other end is gone."""
    end_with_parent(parent)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no answer
    with without_garbage_collection(), suppress(Exception):
        named(warm_up)()
    with suppress(EOFError, OSError):
        while True:
            task, arguments = connection.recv()
            connection.send(_outcome(task, arguments, lambda told: connection.send(("told", told))))


def named(task: str) -> Callable[..., Any]:
    """The function of a task."""
    module, _, name = task.partition(":")
    found: Callable[..., Any] = getattr(import_module(f"{WORK}.{module}"), name)
    return found


def _outcome(task: str, arguments: Sequence[Any], tell: Tell) -> tuple[str, Any]:
    """The kind of answer and its content; what went wrong is one sentence, and its traceback a line of the log."""
    from mesh.types import MeshingError
    from softdot.arrays.presses import StoppedPressError
    from softdot.no_room import no_room_sentence
    from solve.solution.errors import NoEquilibriumError
    from solve.solution.full_load import StoppedShortError
    from solve.solution.linear import LinearSolveError

    try:
        function = named(task)
        told = {"tell": tell} if "tell" in signature(function).parameters else {}
        return "done", function(*arguments, **told)
    except InputError as error:
        return "refused", str(error)
    except MeshingError as error:
        return "refused", f"the mesher failed: {error}"
    except (LinearSolveError, NoEquilibriumError, StoppedPressError, StoppedShortError) as error:
        return "refused", f"not converged: {error}"
    except Exception as error:
        LOG.debug("%s failed", task, exc_info=True)
        said = no_room_sentence(error)
        return "refused", said[0] if said else f"this failed inside softdot ({type(error).__name__}): please report it"
