"""How far a command is: records of the log, bars on a terminal."""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from rich.progress import Progress as Bars
    from rich.progress import TaskID


LOG = logging.getLogger(__name__)
MANY = 100
"""Of more steps than this one line is written for each hundredth."""


class Progress(Protocol):
    """What the pipeline tells whoever watches."""

    def stage(self, name: str) -> None:
        """A stage begins."""

    def step(self, number: int, count: int, text: str) -> None:
        """A step of the running stage, a load step that has converged say."""


class Logged:
    """Every stage and step is a record of the log; softdot.log says who sees it."""

    def __init__(self) -> None:
        self._name = ""

    def stage(self, name: str) -> None:
        """Tell that a stage begins."""
        self._name = name
        LOG.info("%s", name)

    def step(self, number: int, count: int, text: str) -> None:
        """Tell how far the running stage is."""
        told = count <= MANY or number == count or MANY * number // count != MANY * (number - 1) // count
        if told:
            LOG.info("%s %d of %d%s", self._name, number, count, f": {text}" if text else "")


class Untold(Logged):
    """Tells nothing: of many jobs one tells how many are done."""

    def stage(self, name: str) -> None:
        """Nothing."""

    def step(self, number: int, count: int, text: str) -> None:
        """Nothing."""


@contextmanager
def progress_of(chosen: Namespace) -> Iterator[Progress]:
    """Bars where standard error is a terminal and --quiet was not given, else lines alone."""
    if chosen.quiet or not sys.stderr.isatty():
        yield Logged()
        return
    from rich.console import Console
    from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Bars(*columns, console=Console(stderr=True)) as bars:
        watcher = _OnTerminal(bars)
        yield watcher
        watcher.finish()


class _OnTerminal(Logged):
    """One bar per stage."""

    def __init__(self, bars: "Bars") -> None:
        super().__init__()
        self._bars = bars
        self._task: TaskID | None = None

    def stage(self, name: str) -> None:
        """Finish the bar of the stage before and begin the next, of unknown length."""
        super().stage(name)
        self.finish()
        self._task = self._bars.add_task(f"{name:<10}", total=None)

    def step(self, number: int, count: int, text: str) -> None:
        """Fill the bar of the running stage and write the state beside it."""
        super().step(number, count, text)
        if self._task is not None:
            self._bars.update(self._task, total=count, completed=number, description=f"{self._name:<10} {text}")

    def finish(self) -> None:
        """Fill the running bar."""
        if self._task is not None:
            self._bars.update(self._task, total=1, completed=1)
            self._bars.stop_task(self._task)
