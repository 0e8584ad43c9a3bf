"""Executors of heavy calls: in this process, in warm processes of this computer, or on a cluster.

A command makes one executor and hands it down; whatever presses asks that one. So the same presses run on the cores of
one machine and on a cluster, and their processes are started once for a command, when the first call needs them.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from queue import SimpleQueue
from threading import Lock
from typing import Any, Protocol, Self, TypeVar

from foundation.scratch_folders import sweep_scratch
from foundation.thread_pools import ONE_THREAD_VARIABLES
from foundation.worker_process import ProcessDiedError, WorkerProcess

MOST_DEATHS = 1
"""A call whose process has died more often than this is given up."""
Name = TypeVar("Name", bound=Hashable)


class LostError(RuntimeError):
    """A call that was given up, since its worker died each time or the work was stopped."""

    def __init__(self, reason: str = "its worker died each time, perhaps for lack of memory") -> None:
        super().__init__(reason)


class Executor(Protocol):
    """Executes calls of functions that a module holds under their name."""

    @property
    def places(self) -> int:
        """Number of calls that run at a time."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> "Future[Any]":
        """Return the future of a call, which raises what the function raises, or LostError where it was given up."""


def completed_calls(
    executor: Executor, function: Callable[..., Any], calls: Mapping[Name, tuple[Any, ...]]
) -> Iterator[tuple[Name, "Future[Any]"]]:
    """Yield name and future of each call as it ends. calls : name -> arguments, begun in this order.

    No more calls run at a time than there are places, so that few are lost where the caller stops.
    """
    waiting, under_way = iter(calls.items()), dict["Future[Any]", Name]()
    ended: SimpleQueue[Future[Any]] = SimpleQueue()

    def fill() -> None:
        while len(under_way) < executor.places and (following := next(waiting, None)) is not None:
            name, arguments = following
            future = executor.submit(function, *arguments)
            under_way[future] = name
            future.add_done_callback(ended.put)

    fill()
    while under_way:
        future = ended.get()
        yield under_way.pop(future), future
        fill()


class Here:
    """Executor that does each call in this process as soon as it is submitted."""

    places = 1

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> "Future[Any]":
        """Do a call here and return its future, which is done already."""
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


HERE = Here()


class LocalProcesses:
    """Executor with worker processes of one thread each, for the time of a block.

    A process is started when a call finds none that is free, and kept. One that dies is replaced, and its call is tried
    again. Ctrl-C does not reach them: all have ended when the block ends.
    """

    def __init__(self, places: int, prepare: Callable[[Executor], object] | None = None) -> None:
        """places : most processes. prepare : called before the first call, to compile once what all need."""
        self.places, self._prepare = places, prepare
        self._threads, self._lock, self._over = ThreadPoolExecutor(places), Lock(), False
        self._free, self._alive = list[WorkerProcess](), list[WorkerProcess]()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._over = True
            for process in self._alive:
                process.kill()
        self._threads.shutdown(cancel_futures=True)
        sweep_scratch()

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> "Future[Any]":
        """Return the future of a call, which the next free worker does. See Executor."""
        if self._prepare is not None:
            prepare, self._prepare = self._prepare, None
            prepare(self)
        return self._threads.submit(self._call_worker, function, arguments)

    def _call_worker(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        """Do a call in a worker, and once more in another one where the first dies. LostError."""
        for _ in range(1 + MOST_DEATHS):
            process = self._idle_process()
            try:
                return process.call(function, *arguments)
            except ProcessDiedError:
                self._discard(process)
            finally:
                if process in self._alive:
                    self._free.append(process)
        raise LostError

    def _idle_process(self) -> WorkerProcess:
        """Return a process without work, or a new one. LostError after the end of the block."""
        with self._lock:
            if self._over:
                raise LostError("the work was stopped")
            if self._free:
                return self._free.pop()
            process = WorkerProcess(ONE_THREAD_VARIABLES)
            self._alive.append(process)
            return process

    def _discard(self, process: WorkerProcess) -> None:
        """Forget a worker process that died, after its end."""
        with self._lock:
            process.kill()
            self._alive.remove(process)
