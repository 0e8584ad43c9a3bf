"""The parser of the whole command line."""

import argparse
from typing import Any, NoReturn

from softdot.command_line.braille_reading import add_read
from softdot.command_line.configurations import add_check, add_list, add_new, add_schema
from softdot.command_line.exports import add_export
from softdot.command_line.fabrication import add_kit, add_plate
from softdot.command_line.presses import add_array, add_family, add_goal, add_run, add_studio, add_sweep, add_verify
from softdot.command_line.recordings import add_convert, add_diagnose, add_fit, add_material, add_scan
from softdot.command_line.studies import add_paper, add_prove
from softdot.console import BAD_INPUT, GOOD


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, without the usage."""

    def error(self, message: str) -> NoReturn:
        """Print a sentence and exit with status 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


class _Version(argparse.Action):
    """An action that looks the version up only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_args: Any) -> None:
        from softdot.version import installed_version

        print(f"softdot {installed_version()}")
        parser.exit(GOOD)


class _Completion(argparse.Action):
    """An action that prints the completion which shtab makes of the parser."""

    def __call__(self, parser: argparse.ArgumentParser, _namespace: Any, values: Any, _option: Any = None) -> None:
        import shtab

        print(shtab.complete(parser, values))
        parser.exit(GOOD)


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    top = _Parser(
        prog="softdot",
        description="Design, simulate and fabricate a soft piezoelectric segment over a Braille dot.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    top.add_argument(
        "--print-completion",
        action=_Completion,
        choices=("bash", "zsh"),
        help="print the completion of this command line for a shell and exit",
    )
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    add_run(commands)
    add_paper(commands)
    add_sweep(commands)
    add_family(commands)
    add_goal(commands)
    add_material(commands)
    add_scan(commands)
    add_convert(commands)
    add_diagnose(commands)
    add_fit(commands)
    add_prove(commands)
    add_kit(commands)
    add_plate(commands)
    add_export(commands)
    add_array(commands)
    add_read(commands)
    add_verify(commands)
    add_studio(commands)
    add_check(commands)
    add_new(commands)
    add_list(commands)
    add_schema(commands)
    return top
