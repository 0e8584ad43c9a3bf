"""The command line. Only light modules load before a command begins, so that help is instant."""

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from io import TextIOWrapper
from threading import Timer
from types import FrameType

from foundation.errors import InputError
from softdot.command_line.parser import parser
from softdot.console import BAD_INPUT, GOOD, INTERRUPTED, complain
from softdot.log import lines_on_stderr
from softdot.no_room import no_room_sentence

INTERRUPTED_SENTENCE = "interrupted, nothing was written"
UNINTERRUPTIBLE_FILES = "<frozen importlib", "llvmlite"  # in the file names of their code
RETRY_INTERRUPT_S = 0.05
"""Time after which an interrupt that could not be handled is sent again."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    _write_utf8()
    chosen = parser().parse_args(arguments)
    interrupt = _Interrupt()
    with suppress(ValueError):  # outside the main thread
        signal.signal(signal.SIGTERM, interrupt)
        if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # a shell's background job does not hear Ctrl-C
            signal.signal(signal.SIGINT, interrupt)
    try:
        _refuse_unprintable(chosen)
        status = _run_command(chosen)
        sys.stdout.flush()
    except InputError as error:
        return _status_after_complaint(str(error), BAD_INPUT)
    except KeyboardInterrupt:
        return _status_after_complaint(INTERRUPTED_SENTENCE, INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return GOOD
    except Exception as error:
        if interrupt.received:  # an import of a library, say, turns it into an error of its own
            return _status_after_complaint(INTERRUPTED_SENTENCE, INTERRUPTED)
        said = no_room_sentence(error)
        if said is None:
            raise
        return _status_after_complaint(*said)
    return status


class _Interrupt:
    """The handler of Ctrl-C and SIGTERM: raises KeyboardInterrupt, which some libraries turn into another error.

    It waits for the end of an import and of a compilation: VTK, whose libraries import each other, crashes where one of
    them fails to, and LLVM prints and forgets errors that are raised in its callbacks.
    """

    def __init__(self) -> None:
        self.received = False

    def __call__(self, signum: int, frame: FrameType | None) -> None:
        self.received = True
        if not _in_uninterruptible_code(frame):
            raise KeyboardInterrupt
        later = Timer(RETRY_INTERRUPT_S, os.kill, (os.getpid(), signum))
        later.daemon = True
        later.start()


def _in_uninterruptible_code(frame: FrameType | None) -> bool:
    """Whether a frame was called by code that must not be interrupted."""
    while frame is not None:
        if any(name in frame.f_code.co_filename for name in UNINTERRUPTIBLE_FILES):
            return True
        frame = frame.f_back
    return False


def _write_utf8() -> None:
    """Write standard output and error in UTF-8 in every locale: units need it, and TOML knows no other encoding."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8")


def _refuse_unprintable(chosen: argparse.Namespace) -> None:
    """InputError for an argument that no file name and no report can hold: with a NUL, or a byte that is not UTF-8."""
    for name, value in vars(chosen).items():
        if isinstance(value, str) and ("\0" in value or value.encode(errors="ignore").decode() != value):
            raise InputError(f"{name} = {value[:60]!a}: must be text in UTF-8 without NUL characters")


def _run_command(chosen: argparse.Namespace) -> int:
    if chosen.command == "schema":
        from softdot.config.schema import config_schema
        from softdot.json_files import json_text

        sys.stdout.write(json_text(config_schema()))
        return GOOD
    body = import_module(f"softdot.commands.{chosen.command}")
    with lines_on_stderr(getattr(chosen, "quiet", False), getattr(chosen, "verbose", False)):
        status: int = body.command(chosen)
    return status


def _status_after_complaint(text: str, status: int) -> int:
    complain(text)
    return status


if __name__ == "__main__":
    sys.exit(main())
