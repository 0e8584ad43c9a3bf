"""The progress of a command: records of the log, bars on a terminal."""

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
MOST_LINES = 100
"""With more steps than this, one line is written for each hundredth of them."""


class Progress(Protocol):
    """Receives the progress of the pipeline."""

    def stage(self, name: str) -> None:
        """Announce that a stage begins."""

    def step(self, number: int, count: int, text: str) -> None:
        """Announce a step of the running stage, such as a load step that has converged."""

    def note(self, text: str) -> None:
        """Tell what is already known while the work goes on."""


class Logged:
    """Logs every stage and step; softdot.log says who reads them."""

    def __init__(self) -> None:
        self._name = ""

    def stage(self, name: str) -> None:
        """Log that a stage begins."""
        self._name = name
        LOG.info("%s", name)

    def step(self, number: int, count: int, text: str) -> None:
        """Log the progress of the running stage."""
        told = (
            count <= MOST_LINES or number == count or MOST_LINES * number // count != MOST_LINES * (number - 1) // count
        )
        if told:
            LOG.info("%s %d of %d%s", self._name, number, count, f": {text}" if text else "")

    def note(self, text: str) -> None:
        """Log what is already known."""
        LOG.info("%s", text)


class Untold(Logged):
    """Reports nothing: used for single jobs where the number of finished ones is reported."""

    def stage(self, name: str) -> None:
        """Ignore the stage."""

    def step(self, number: int, count: int, text: str) -> None:
        """Ignore the step."""

    def note(self, text: str) -> None:
        """Ignore what is known."""


class LaterSteps:
    """Steps of a stage that runs beside others: the last one is kept, and all are reported once its turn comes."""

    def __init__(self, progress: Progress) -> None:
        self._progress, self._shown = progress, False
        self._last: tuple[int, int, str] | None = None

    def __call__(self, number: int, count: int, text: str) -> None:
        """Report a step, or keep it."""
        self._last = (number, count, text)
        if self._shown:
            self._progress.step(number, count, text)

    def show(self) -> None:
        """Report the last step so far, and each that follows."""
        self._shown = True
        if self._last is not None:
            self._progress.step(*self._last)


@contextmanager
def progress_of(chosen: Namespace) -> Iterator[Progress]:
    """Bars where standard error is a terminal and --quiet was not given, else records of the log alone."""
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

    def note(self, text: str) -> None:
        """Print what is already known above the bars."""
        super().note(text)
        self._bars.console.print(text)

    def finish(self) -> None:
        """Fill the running bar."""
        if self._task is not None:
            self._bars.update(self._task, total=1, completed=1)
            self._bars.stop_task(self._task)
