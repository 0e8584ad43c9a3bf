"""Processes that work for the page: one task at a time, told of on the way, ended at any moment.

A task is a function below softdot.studio.work with plain arguments, and tell where it takes long: called with how far
it is. It is named ("press:coarse_press"), so that the process of the page loads no solver, and runs in a process of
its own, so that the page answers meanwhile, a crash costs that task alone, and cancelling is ending the
process: a library in the middle of a factorisation asks nobody.
"""

import asyncio
import logging
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from inspect import signature
from typing import Any

from foundation.errors import InputError
from foundation.library_loading import without_garbage_collection
from foundation.worker_process import Tell, WorkerProcess

LOG = logging.getLogger(__name__)
WORK = "softdot.studio.work"
WAITING, MOST_WAITING = 1, 2
"""Processes that wait with everything loaded, so that a press after a cancelled one begins at once."""


class TaskRefused(Exception):
    """Bad input, or a computation that has no result: one sentence for the page."""


class Worker(WorkerProcess):
    """One process. Created in the thread of the event loop, which alone calls it."""

    def __init__(self, warm_up: str) -> None:
        """warm_up : done before the first task, so that that is quick."""
        super().__init__()
        self.begin(load, warm_up)

    async def run(self, task: str, *arguments: Any, tell: Tell = lambda _: None) -> Any:
        """What the task returns. TaskRefused, ProcessDiedError; where the waiting is cancelled, the process ends."""
        loop = asyncio.get_running_loop()

        def told(value: Any) -> None:
            loop.call_soon_threadsafe(tell, value)

        try:
            return await asyncio.wrap_future(self.begin(do_task, task, arguments, tell=told))
        except asyncio.CancelledError:
            self.end()
            raise


class InTurn:
    """One process for short tasks of everybody, one after the other; another one takes its place where it is lost."""

    def __init__(self, warm_up: str, longest_s: float) -> None:
        self._warm_up, self._longest_s = warm_up, longest_s
        self._worker: Worker | None = None
        self._lock = asyncio.Lock()

    def prepare(self) -> None:
        """Start the process."""
        if self._worker is None or not self._worker.is_alive:
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
        self._idle = [worker for worker in self._idle if worker.is_alive]
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
            if worker.is_alive and len(self._idle) < MOST_WAITING:
                self._idle.append(worker)
            else:
                worker.end()

    def end(self) -> None:
        """All of them."""
        for worker in [*self._idle, *self._busy]:
            worker.end()


def load(warm_up: str) -> None:
    """In the process: load what its tasks need."""
    with without_garbage_collection(), suppress(Exception):
        named(warm_up)()


def named(task: str) -> Callable[..., Any]:
    """The function of a task."""
    module, _, name = task.partition(":")
    found: Callable[..., Any] = getattr(import_module(f"{WORK}.{module}"), name)
    return found


def do_task(task: str, arguments: Sequence[Any], tell: Tell) -> Any:
    """In the process: do a task. TaskRefused with one sentence, and the traceback of a mistake of ours in the log."""
    from mesh.types import MeshingError
    from softdot.arrays.presses import StoppedPressError
    from softdot.no_room import no_room_sentence
    from solve.solution.errors import NoEquilibriumError
    from solve.solution.full_load import StoppedShortError
    from solve.solution.linear import LinearSolveError

    try:
        function = named(task)
        told = {"tell": tell} if "tell" in signature(function).parameters else {}
        return function(*arguments, **told)
    except InputError as error:
        raise TaskRefused(str(error)) from None
    except MeshingError as error:
        raise TaskRefused(f"the mesher failed: {error}") from None
    except (LinearSolveError, NoEquilibriumError, StoppedPressError, StoppedShortError) as error:
        raise TaskRefused(f"not converged: {error}") from None
    except Exception as error:
        LOG.debug("%s failed", task, exc_info=True)
        said = no_room_sentence(error)
        ours = f"this failed inside softdot ({type(error).__name__}): please report it"
        raise TaskRefused(said[0] if said else ours) from None
