"""Processes that work for the page: one task at a time, told of on the way, ended at any moment.

A task is a function below softdot.studio.work with plain arguments, and tell where it takes long: called with how far
it is. It is named ("press:coarse_press"), so that the process of the page loads no solver, and runs in a process of
its own, so that the page answers meanwhile, a crash costs that task alone. A task that is cancelled is asked to
stop at its next step, so that its process stays loaded; one that does not is ended with its process.
"""

import asyncio
import logging
import signal
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from inspect import signature
from threading import Event
from typing import Any

from foundation.errors import InputError
from foundation.library_loading import without_garbage_collection
from foundation.worker_process import ProcessDiedError, Tell, WorkerProcess
from softdot.studio.admission import Admission

LOG = logging.getLogger(__name__)
WORK = "softdot.studio.work"
WAITING, MOST_WAITING = 1, 2
"""Processes that wait with everything loaded, so that a press after a cancelled one begins at once."""
LONGEST_LOAD_S = 240.0
"""For a process to load its libraries, on a machine with much else to do; 3 s on one that is idle."""
LONGEST_STOP_S = 2.0
"""For a task that is asked to stop; after it its process is ended."""
SPARE_AFTER_S = 5.0
"""After which a process takes the place of one that is at work: loading takes a core for seconds, which a coarse press
needs, and most tasks give their process back before.
"""
LOADING = {"progress": {"stage": "loading", "done": 0, "count": 0, "left_s": None}}


class TaskRefused(Exception):
    """Bad input, or a computation that has no result: one sentence for the page."""


class MachineError(Exception):
    """A task without an answer for reasons of this machine, also after it was begun again: one sentence."""


class Worker(WorkerProcess):
    """One process. Created in the thread of the event loop, which alone calls it."""

    def __init__(self, warm_up: str) -> None:
        """warm_up : done before the first task, so that that is quick."""
        super().__init__()
        self._loaded = self.begin(load, warm_up)
        self._task: asyncio.Future[Any] | None = None

    @property
    def is_warm(self) -> bool:
        """Whether a task begins at once."""
        return self.is_alive and self._loaded.done()

    async def until_warm(self) -> None:
        """Wait for its libraries. ProcessDiedError, TimeoutError."""
        loading = asyncio.wrap_future(self._loaded)
        loading.add_done_callback(lambda done: done.cancelled() or done.exception())  # nobody may wait any more
        async with asyncio.timeout(LONGEST_LOAD_S):
            await asyncio.shield(loading)

    async def run(self, task: str, *arguments: Any, tell: Tell = lambda _: None) -> Any:
        """What the task returns; it goes on where the waiting is cancelled, but tells nothing any more. TaskRefused,
        ProcessDiedError.
        """
        loop, is_over = asyncio.get_running_loop(), Event()

        def hear(value: Any) -> None:
            if not is_over.is_set():
                tell(value)

        def told(value: Any) -> None:
            loop.call_soon_threadsafe(hear, value)

        self._task = asyncio.wrap_future(self.begin(do_task, task, arguments, tell=told))
        self._task.add_done_callback(lambda done: done.cancelled() or done.exception())  # nobody may wait any more
        try:
            return await asyncio.shield(self._task)
        finally:
            is_over.set()

    async def stops(self, within_s: float) -> bool:
        """Whether the task stops in time when it is asked to, so that the process can be used again."""
        if self._task is None or self._task.done():
            return self.is_alive
        if not self.interrupt():
            return False
        await asyncio.wait([self._task], timeout=within_s)
        return self._task.done() and self.is_alive


class InTurn:
    """One process for short tasks of everybody, one after the other; another one takes its place where it is lost."""

    def __init__(self, warm_up: str, longest_s: float) -> None:
        self._warm_up, self._longest_s = warm_up, longest_s
        self._worker: Worker | None = None
        self._last: asyncio.Task[Any] | None = None
        self._lock = asyncio.Lock()

    @property
    def is_warm(self) -> bool:
        """Whether a task begins at once."""
        return self._worker is not None and self._worker.is_warm

    def prepare(self) -> Worker:
        """Start the process where there is none."""
        if self._worker is None or not self._worker.is_alive:
            self._worker = Worker(self._warm_up)
        return self._worker

    async def run(self, task: str, *arguments: Any) -> Any:
        """As Worker.run, in a process that has loaded, for longest_s; then once more in a new one. TaskRefused,
        MachineError.

        Where the waiting is cancelled, a task that has begun goes on, and one that waits is forgotten.
        """
        async with self._lock:
            if self._last is not None:
                await asyncio.wait([self._last])
            self._last = asyncio.create_task(self._twice(task, *arguments))
            self._last.add_done_callback(lambda done: done.cancelled() or done.exception())
            return await asyncio.shield(self._last)

    async def _twice(self, task: str, *arguments: Any) -> Any:
        said = ""
        for _ in range(2):
            worker = self.prepare()
            try:
                await worker.until_warm()
                async with asyncio.timeout(self._longest_s):
                    return await worker.run(task, *arguments)
            except TimeoutError:
                said = f"this machine did not answer within {self._longest_s:.0f} s, twice; it has much else to do"
            except ProcessDiedError:
                said = "the process that checks designs was ended twice by this machine; its memory may be short"
            worker.end()
        raise MachineError(said)

    def end(self) -> None:
        """At once."""
        if self._last is not None:
            self._last.cancel()
        if self._worker is not None:
            self._worker.end()


class Pool:
    """Processes that are alike. Each task has one to itself; one more waits, or two, and the others are ended."""

    def __init__(self, warm_up: str, rooms: Mapping[str, Admission]) -> None:
        """rooms : how many tasks of each kind may run at once."""
        self._warm_up, self._rooms = warm_up, rooms
        self._idle: list[Worker] = []
        self._busy: list[Worker] = []
        self._stopping: set[asyncio.Task[None]] = set()
        self._spare: asyncio.TimerHandle | None = None

    def prepare(self) -> None:
        """Start a process that waits for a task, where there is none."""
        self._idle = [worker for worker in self._idle if worker.is_alive]
        while len(self._idle) < WAITING:
            self._idle.append(Worker(self._warm_up))

    async def run(
        self,
        room: str,
        task: str,
        *arguments: Any,
        need_GB: float = 0.0,
        tell: Tell = lambda _: None,
        longest_stop_s: float = LONGEST_STOP_S,
    ) -> Any:
        """As Worker.run, in the warmest process that is free, once there is room; begun again once where its process
        dies. longest_stop_s : for its next step where it is cancelled. TaskRefused, MachineError.
        """
        async with self._rooms[room].place(need_GB, tell):
            for _ in range(2):
                with suppress(ProcessDiedError, TimeoutError):
                    return await self._run(task, arguments, tell, longest_stop_s)
        raise MachineError("its process was ended twice by this machine, whose memory may be short; it was not done")

    async def _run(self, task: str, arguments: Sequence[Any], tell: Tell, longest_stop_s: float) -> Any:
        self.prepare()
        worker = next((one for one in self._idle if one.is_warm), self._idle[0])
        self._idle.remove(worker)
        self._busy.append(worker)
        try:
            if not worker.is_warm:
                tell(LOADING)
                await worker.until_warm()
            self._prepare_later()
            found = await worker.run(task, *arguments, tell=tell)
        except asyncio.CancelledError:
            stopping = asyncio.create_task(self._stop(worker, longest_stop_s))
            self._stopping.add(stopping)
            stopping.add_done_callback(self._stopping.discard)
            raise
        except BaseException as error:
            if isinstance(error, TimeoutError | ProcessDiedError):  # the end of its pipe is heard before it is gone
                worker.end()
            self._put_back(worker)
            raise
        self._put_back(worker)
        return found

    def _prepare_later(self) -> None:
        if self._spare is not None:
            self._spare.cancel()
        self._spare = asyncio.get_running_loop().call_later(SPARE_AFTER_S, self.prepare)

    async def _stop(self, worker: Worker, longest_s: float) -> None:
        if not await worker.stops(longest_s):
            worker.end()
        self._put_back(worker)

    def _put_back(self, worker: Worker) -> None:
        """A warm process that is free again stands before those that load."""
        self._busy.remove(worker)
        if worker.is_alive and (len(self._idle) < MOST_WAITING or not all(one.is_warm for one in self._idle)):
            self._idle.insert(0, worker)
        else:
            worker.end()
        for other in self._idle[MOST_WAITING:]:
            other.end()
        del self._idle[MOST_WAITING:]

    def end(self) -> None:
        """All of them."""
        if self._spare is not None:
            self._spare.cancel()
        for worker in [*self._idle, *self._busy]:
            worker.end()


def load(warm_up: str) -> None:
    """In the process: load what its tasks need, and let tasks be asked to stop."""
    signal.signal(signal.SIGINT, lambda *_: STOP.set())
    with without_garbage_collection(), suppress(Exception):
        named(warm_up)()


def named(task: str) -> Callable[..., Any]:
    """The function of a task."""
    module, _, name = task.partition(":")
    found: Callable[..., Any] = getattr(import_module(f"{WORK}.{module}"), name)
    return found


STOP = Event()
"""In the process: its task is to stop where it next tells how far it is, between two steps, so that no library is left
in the middle of something.
"""


class StopTask(BaseException):
    """A task has been asked to stop; no handler of errors on the way is meant."""


def tell_unless_stopped(tell: Tell, value: Any) -> None:
    """Tell how far a task is, or end it there. StopTask."""
    if STOP.is_set():
        raise StopTask
    tell(value)


def do_task(task: str, arguments: Sequence[Any], tell: Tell) -> Any:
    """In the process: do a task. TaskRefused with one sentence, and the traceback of a mistake of ours in the log."""
    from mesh.types import MeshingError
    from softdot.arrays.presses import StoppedPressError
    from softdot.no_room import no_room_sentence
    from solve.solution.errors import NoEquilibriumError
    from solve.solution.full_load import StoppedShortError
    from solve.solution.linear import LinearSolveError

    STOP.clear()
    try:
        function = named(task)
        told = {"tell": partial(tell_unless_stopped, tell)} if "tell" in signature(function).parameters else {}
        return function(*arguments, **told)
    except StopTask:
        raise TaskRefused("cancelled") from None
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
