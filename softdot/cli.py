"""The command line. Only light modules load before a command begins, so that help is instant."""

import argparse
import errno
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, NoReturn

from geometry.errors import InputError

GOOD, BAD_INPUT, NOT_CONVERGED, INTERRUPTED = 0, 2, 3, 130
NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM}


class _Parser(argparse.ArgumentParser):
    """Says one sentence instead of the usage and a sentence."""

    def error(self, message: str) -> NoReturn:
        """Exit 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


class _Version(argparse.Action):
    """Looks the version up only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_args: Any) -> None:
        from softdot.version import installed_version

        print(f"softdot {installed_version()}")
        parser.exit(GOOD)


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = _Parser(
        prog="softdot",
        description="Design, simulate and fabricate a soft piezoelectric segment over a Braille dot.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    run = commands.add_parser(
        "run",
        help="geometry, mesh, solve and export from one configuration",
        description="Build, mesh and press one segment; write CAD, ParaView results, pictures and a report.",
        epilog="'softdot schema' explains every key of CONFIG.toml; examples/ has files to start from. "
        "Exit status: 0 good, 2 bad input, 3 a computation did not converge, 130 interrupted.",
    )
    run.add_argument(
        "config", nargs="?", metavar="CONFIG.toml", help="without it: the final design of the paper"
    )
    run.add_argument(
        "-o", "--output", required=True, metavar="OUT", help="folder to write; an earlier run is replaced"
    )
    run.add_argument(
        "--json", action="store_true", help="print the summary, and nothing else, to standard output"
    )
    schema = commands.add_parser(
        "schema",
        help="JSON Schema of the configuration",
        description="Print the JSON Schema of the configuration: each key, its meaning, bounds and default.",
    )
    schema.add_argument("--json", action="store_true", help="no difference: the schema is JSON")
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    chosen = parser().parse_args(arguments)
    with suppress(ValueError):  # outside the main thread
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        status = _command(chosen)
        sys.stdout.flush()
    except InputError as error:
        return _say(str(error), BAD_INPUT)
    except KeyboardInterrupt:
        return _say("interrupted, nothing was written", INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return GOOD
    except OSError as error:
        if error.errno not in NO_ROOM:
            raise
        return _say(f"'{error.filename or 'output'}' cannot be written ({error.strerror})", BAD_INPUT)
    return status


def _command(chosen: argparse.Namespace) -> int:
    if chosen.command == "schema":
        from softdot.numbers import json_text
        from softdot.schema import config_schema

        sys.stdout.write(json_text(config_schema()))
        return GOOD
    from softdot.run_command import run_command

    return run_command(chosen.config, chosen.output, chosen.json)


def _say(text: str, status: int) -> int:
    """One sentence on one line of standard error."""
    print("softdot:", " ".join(text.split()), file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
