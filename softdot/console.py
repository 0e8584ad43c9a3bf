"""What commands print: summaries, warnings, lines on standard error, progress bars; numbers as JSON knows them.

Every package logs by Python's logging under its own name: INFO what goes on, DEBUG its details (Newton iterations,
attempts of the mesher), WARNING what a user has to know. Nothing but this module attaches handlers.
"""

import json
import logging
import math
import os
import sys
import time
from argparse import Namespace
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from geometry.files import whole_file

if TYPE_CHECKING:
    from rich.progress import Progress as Bars
    from rich.progress import TaskID


def plain(value: Any) -> Any:
    """The data in Python's own types; NaN and infinity, which JSON lacks, become None."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):  # numpy arrays and scalars
        return plain(value.tolist())
    if isinstance(value, float):
        return float(f"{value:.12g}") + 0.0 if math.isfinite(value) else None  # -0.0 + 0.0 = 0.0
    return value


def json_text(value: Any) -> str:
    """Indented, valid JSON with a final newline."""
    return json.dumps(plain(value), indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def write_json(path: Path, value: Any) -> None:
    """Write JSON that never exists half-written."""
    with whole_file(path) as beside:
        beside.write_text(json_text(value), "utf-8")


def installed_version() -> str:
    """Version of the installed distribution, "unknown" for a bare copy of the sources."""
    try:
        return version("softdot")
    except PackageNotFoundError:
        return "unknown"


LOG_FILE = "log.txt"
PACKAGES = ("geometry", "mesh", "solve", "export", "diagnose", "softdot")


@contextmanager
def lines_on_stderr(quiet: bool = False, verbose: bool = False) -> Iterator[None]:
    """One plain line per record, with the time since the start; a warning only once.

    quiet : warnings only. verbose : details too. On a terminal bars show what goes on, and lines only the rest.
    """
    handler = _OnStderr(logging.WARNING if quiet else logging.DEBUG if verbose else logging.INFO)
    handler.shows_steps = not sys.stderr.isatty()
    with _attached(handler):
        yield


@contextmanager
def lines_when_interactive() -> Iterator[None]:
    """Lines on standard error in a notebook or at the prompt of Python; nothing in a script."""
    if hasattr(sys, "ps1"):
        with _attached(_OnStderr(logging.INFO)):
            yield
    else:
        yield


@contextmanager
def log_file(path: Path) -> Iterator[None]:
    """Everything, details too, into a file with the time of day; added to what is there."""
    handler = _QuietFile(path, "a", "utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)-7s %(message)s"))
    try:
        with _attached(handler):
            logging.getLogger(__name__).debug("command: %s", " ".join(sys.argv))
            yield
    finally:
        handler.close()


def warn(warnings: list[str]) -> None:
    """Tell warnings at once; standard error shows the same sentence only once."""
    for warning in warnings:
        logging.getLogger(__name__).warning("%s", warning)


@contextmanager
def _attached(handler: logging.Handler) -> Iterator[None]:
    loggers = [logging.getLogger(name) for name in PACKAGES]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.addHandler(handler)
        logger.setLevel(logging.DEBUG)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.removeHandler(handler)
            logger.setLevel(level)


class _OnStderr(logging.Handler):
    """Writes to what standard error is at that moment: bars and notebooks exchange it."""

    def __init__(self, level: int) -> None:
        super().__init__(level)
        self.shows_steps = True
        self._start = time.time()
        self._told: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Write one line."""
        text = " ".join(record.getMessage().split())
        if record.levelno >= logging.WARNING:
            if text not in self._told:
                print(f"softdot: warning: {text}", file=sys.stderr)
            self._told.add(text)
        elif record.levelno != logging.INFO or self.shows_steps:
            print(f"{record.created - self._start:7.1f} s  {text}", file=sys.stderr, flush=True)


class _QuietFile(logging.FileHandler):
    """A disk that is full is told by what writes the results, not by a traceback for each line of the log."""

    def handleError(self, record: logging.LogRecord) -> None:
        """Go on."""


LONGEST = 2000  # characters of a sentence; a path may have some
GOOD, BAD_INPUT, NOT_CONVERGED, INTERRUPTED = 0, 2, 3, 130


def show(summary: dict[str, Any], chosen: Namespace, short_text: Callable[[dict[str, Any], str], str]) -> None:
    """The summary as JSON when asked for, else in short, in a pipe too; its warnings always on standard error."""
    warn(summary.get("warnings", []))
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif not chosen.quiet:
        print(short_text(summary, chosen.output))


def complain(text: str) -> None:
    """One sentence on standard error, of a bounded length whatever the text that it quotes."""
    line = " ".join(text.split())
    print("softdot:", line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}...", file=sys.stderr)


@contextmanager
def only_the_summary_on_stdout() -> Iterator[None]:
    """Send what compiled libraries print to standard error while the pipeline runs."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


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
    """Every stage and step is a record of the log; softdot.console says who sees it."""

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
