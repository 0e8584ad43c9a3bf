"""The arguments of the commands on configurations: check, new, list and schema."""

from typing import Any

from softdot.command_line.options import add_set

LISTED = ("materials", "standards", "mechanisms", "amplifiers")
TEMPLATES = ("default", "slice", "dome", "circuit", "time-dependent")


def add_check(commands: Any) -> None:
    """Add the command softdot check."""
    check = commands.add_parser(
        "check",
        help="find all mistakes of a configuration, or what its run will cost",
        description="Check a configuration and solve nothing: all its mistakes in one answer, or the expected size "
        "of the mesh, time and memory of a run, and the warnings of the design.",
        epilog="Exit status: 0 no mistake, 2 at least one.",
    )
    check.add_argument("config", metavar="CONFIG.toml", help="the configuration to check")
    add_set(check)
    check.add_argument("--kit", action="store_true", help="find what softdot kit would refuse, too")
    check.add_argument("--json", action="store_true", help="print the answer as JSON to standard output")
    check.add_argument("-q", "--quiet", action="store_true", help="print only mistakes")


def add_new(commands: Any) -> None:
    """Add the command softdot new."""
    new = commands.add_parser(
        "new",
        help="print a configuration to start from, with every key explained",
        description="Print a configuration that lists each key with its meaning, unit, default and bounds. "
        "What the template does not need is commented out.",
        epilog="softdot new --template dome > mine.toml",
    )
    new.add_argument("--template", choices=TEMPLATES, default="default", help="what to start from")
    new.add_argument("--short", action="store_true", help="only the keys that the template states")


def add_list(commands: Any) -> None:
    """Add the command softdot list."""
    listing = commands.add_parser(
        "list",
        help="list built-in materials, Braille standards or mechanisms",
        description="Print what is built in, with its numbers, sources and how far to trust them.",
    )
    listing.add_argument("what", choices=LISTED, help="which list")
    listing.add_argument("--json", action="store_true", help="print the list as JSON")


def add_schema(commands: Any) -> None:
    """Add the command softdot schema."""
    schema = commands.add_parser(
        "schema",
        help="print the JSON Schema of the configuration",
        description="Print the JSON Schema of the configuration: each key, its meaning, bounds and default.",
    )
    schema.add_argument("--json", action="store_true", help="has no effect, as the schema is JSON")
