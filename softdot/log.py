"""Readers of the log: lines on standard error, and the file log.txt.

Every package logs by Python's logging under its own name: INFO its progress, DEBUG its details (Newton iterations,
attempts of the mesher), WARNING what a user has to know. Nothing but this module attaches handlers.
"""

import logging
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

LOG_FILE = "log.txt"
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")


@contextmanager
def lines_on_stderr(quiet: bool = False, verbose: bool = False) -> Iterator[None]:
    """Print one plain line per record, with the time since the start, for the time of a block; a warning only once.

    quiet : warnings only. verbose : details too. On a terminal bars show the progress, and lines only the rest.
    """
    handler = _OnStderr(logging.WARNING if quiet else logging.DEBUG if verbose else logging.INFO)
    handler.shows_steps = not sys.stderr.isatty()
    with _attach(handler):
        yield


@contextmanager
def lines_when_interactive() -> Iterator[None]:
    """Print lines on standard error in a notebook or at the prompt of Python, and nothing in a script."""
    if hasattr(sys, "ps1"):
        with _attach(_OnStderr(logging.INFO)):
            yield
    else:
        yield


@contextmanager
def log_file(path: Path) -> Iterator[None]:
    """Append every record, details too, to a file with the time of day, for the time of a block."""
    handler = _QuietFile(path, "a", "utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)-7s %(message)s"))
    try:
        with _attach(handler):
            logging.getLogger(__name__).debug("command: %s", " ".join(sys.argv))
            yield
    finally:
        handler.close()


def warn(warnings: list[str]) -> None:
    """Log warnings; standard error shows the same sentence only once."""
    for warning in warnings:
        logging.getLogger(__name__).warning("%s", warning)


@contextmanager
def _attach(handler: logging.Handler) -> Iterator[None]:
    """Attach a handler to the loggers of all packages for the time of a block."""
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
    """A handler that writes to the standard error of the moment: bars and notebooks exchange it."""

    def __init__(self, level: int) -> None:
        super().__init__(level)
        self.shows_steps = True
        self._start = time.time()
        self._shown_warnings: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Write one record as a line."""
        text = " ".join(record.getMessage().split())
        if record.levelno >= logging.WARNING:
            if text not in self._shown_warnings:
                print(f"softdot: warning: {text}", file=sys.stderr)
            self._shown_warnings.add(text)
        elif record.levelno != logging.INFO or self.shows_steps:
            print(f"{record.created - self._start:7.1f} s  {text}", file=sys.stderr, flush=True)


class _QuietFile(logging.FileHandler):
    """A log file without tracebacks when the disk is full: that is reported by whoever writes the results."""

    def handleError(self, record: logging.LogRecord) -> None:
        """Ignore the error."""
