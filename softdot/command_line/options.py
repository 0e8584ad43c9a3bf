"""Options that several commands share."""

import argparse

EXIT_STATUS = "Exit status: 0 good, 2 bad input, 3 a computation did not converge, 130 interrupted."


def add_config(command: argparse.ArgumentParser) -> None:
    """Add the argument CONFIG.toml, by default the default design, and the option --set."""
    command.add_argument("config", nargs="?", metavar="CONFIG.toml", help="default: the final design of the paper")
    add_set(command)


def add_set(command: argparse.ArgumentParser) -> None:
    """Add the option --set KEY=VALUE."""
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="a value instead of that in the file, such as press.indentation_mm=0.2; may be repeated",
    )


def add_scheduler(command: argparse.ArgumentParser, of_what: str = "") -> None:
    """Add the option --scheduler ADDRESS. of_what : words behind "presses" in its help."""
    command.add_argument(
        "--scheduler", metavar="ADDRESS", help=f"presses{of_what} on this Dask cluster, such as tcp://host:8786"
    )


def add_output(command: argparse.ArgumentParser) -> None:
    """Add the options -o OUT and --json, and those for more and less output."""
    command.add_argument(
        "-o", "--output", required=True, metavar="OUT", help="folder to write; an earlier result is replaced"
    )
    command.add_argument("--json", action="store_true", help="print the summary, and nothing else, to standard output")
    told = command.add_mutually_exclusive_group()
    told.add_argument("-q", "--quiet", action="store_true", help="print only warnings and errors")
    told.add_argument(
        "-v", "--verbose", action="store_true", help="print details too, such as every iteration of the solver"
    )
