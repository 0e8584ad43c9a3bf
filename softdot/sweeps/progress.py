"""A bar that counts points, with the time that remains."""

import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from softdot.progress import Logged, Progress

if TYPE_CHECKING:
    from rich.progress import Progress as Bars


RATE_WINDOW_S = 3600.0
"""The rate is that of the last hour: a point may take longer than the half minute of rich."""


@contextmanager
def progress_of_points(chosen: Namespace) -> Iterator[Progress]:
    """A bar of points where standard error is a terminal and --quiet was not given, else records of the log alone."""
    if chosen.quiet or not sys.stderr.isatty():
        yield Logged()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("points,"),
        TimeElapsedColumn(), TextColumn("passed,"), TimeRemainingColumn(), TextColumn("to go"),
    )  # fmt: skip
    with Bars(*columns, console=Console(stderr=True), speed_estimate_period=RATE_WINDOW_S) as bars:
        yield _Points(bars)


class _Points(Logged):
    """One bar; the points of an earlier sweep do not count for the rate."""

    def __init__(self, bars: "Bars") -> None:
        super().__init__()
        self._bars = bars
        self._failures = 0
        self._task = bars.add_task("start", total=None)

    def stage(self, name: str) -> None:
        """Begin the bar anew."""
        super().stage(name)
        self._bars.remove_task(self._task)
        self._task = self._bars.add_task(name, total=None)

    def step(self, number: int, count: int, text: str) -> None:
        """Show how many of the points are done; text is the reason of one that failed."""
        super().step(number, count, text)
        self._failures += bool(text)
        named = f"solve, {self._failures} failed" if self._failures else "solve"
        self._bars.update(self._task, total=count, completed=number, description=named)
