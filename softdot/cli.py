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
from softdot.no_room import without_room

STOPPED = "interrupted, nothing was written"
UNINTERRUPTED = "<frozen importlib", "llvmlite"  # in the file names of their code
ASKED_AGAIN_S = 0.05


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    _write_utf8()
    chosen = parser().parse_args(arguments)
    asked = _Interrupt()
    with suppress(ValueError):  # outside the main thread
        signal.signal(signal.SIGTERM, asked)
        if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # a shell's background job does not hear Ctrl-C
            signal.signal(signal.SIGINT, asked)
    try:
        _refuse_unprintable(chosen)
        status = _command(chosen)
        sys.stdout.flush()
    except InputError as error:
        return _say(str(error), BAD_INPUT)
    except KeyboardInterrupt:
        return _say(STOPPED, INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return GOOD
    except Exception as error:
        if asked.told:  # what was interrupted turned it into an error of its own, as an import of a library does
            return _say(STOPPED, INTERRUPTED)
        said = without_room(error)
        if said is None:
            raise
        return _say(*said)
    return status


class _Interrupt:
    """What Ctrl-C and SIGTERM do: KeyboardInterrupt, which some compiled libraries turn into another error.

    It waits for the end of an import and of a compilation: VTK, whose libraries import each other, crashes where one of
    them fails to, and LLVM prints and forgets what is raised in its callbacks.
    """

    def __init__(self) -> None:
        self.told = False

    def __call__(self, signum: int, frame: FrameType | None) -> None:
        self.told = True
        if not _under_way(frame):
            raise KeyboardInterrupt
        later = Timer(ASKED_AGAIN_S, os.kill, (os.getpid(), signum))
        later.daemon = True
        later.start()


def _under_way(frame: FrameType | None) -> bool:
    """Whether a frame was called by one of those that are not to be interrupted."""
    while frame is not None:
        if any(name in frame.f_code.co_filename for name in UNINTERRUPTED):
            return True
        frame = frame.f_back
    return False


def _write_utf8() -> None:
    """Units and configurations are written in UTF-8 in every locale: TOML knows no other encoding."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8")


def _refuse_unprintable(chosen: argparse.Namespace) -> None:
    """InputError for text that no file name and no report can hold: a NUL, or a byte that is not UTF-8."""
    for name, value in vars(chosen).items():
        if isinstance(value, str) and ("\0" in value or value.encode(errors="ignore").decode() != value):
            raise InputError(f"{name} = {value[:60]!a}: must be text in UTF-8 without NUL characters")


def _command(chosen: argparse.Namespace) -> int:
    if chosen.command == "schema":
        from softdot.config.schema import config_schema
        from softdot.json_files import json_text

        sys.stdout.write(json_text(config_schema()))
        return GOOD
    body = import_module(f"softdot.commands.{chosen.command}")
    with lines_on_stderr(getattr(chosen, "quiet", False), getattr(chosen, "verbose", False)):
        status: int = body.command(chosen)
    return status


def _say(text: str, status: int) -> int:
    complain(text)
    return status


if __name__ == "__main__":
    sys.exit(main())
