"""Progress on a terminal; nothing in a pipe."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from rich.progress import Progress as Bars
    from rich.progress import TaskID


class Progress(Protocol):
    """What the pipeline tells whoever watches."""

    def stage(self, name: str) -> None:
        """A stage begins."""

    def step(self, number: int, count: int, text: str) -> None:
        """A step of the running stage, a load step that has converged say."""


class Silent:
    """Nobody watches."""

    def stage(self, name: str) -> None:
        """Say nothing."""

    def step(self, number: int, count: int, text: str) -> None:
        """Say nothing."""


@contextmanager
def progress_on_terminal() -> Iterator[Progress]:
    """Bars on standard error when it is a terminal, else nothing."""
    if not sys.stderr.isatty():
        yield Silent()
        return
    from rich.console import Console
    from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Bars(*columns, console=Console(stderr=True)) as bars:
        watcher = _OnTerminal(bars)
        yield watcher
        watcher.finish()


class _OnTerminal:
    """One bar per stage."""

    def __init__(self, bars: "Bars") -> None:
        self._bars = bars
        self._task: TaskID | None = None
        self._name = ""

    def stage(self, name: str) -> None:
        """Finish the bar of the stage before and begin the next, of unknown length."""
        self.finish()
        self._name = name
        self._task = self._bars.add_task(f"{name:<10}", total=None)

    def step(self, number: int, count: int, text: str) -> None:
        """Fill the bar of the running stage and write the state beside it."""
        if self._task is not None:
            self._bars.update(self._task, total=count, completed=number, description=f"{self._name:<10} {text}")

    def finish(self) -> None:
        """Fill the running bar."""
        if self._task is not None:
            self._bars.update(self._task, total=1, completed=1)
            self._bars.stop_task(self._task)
