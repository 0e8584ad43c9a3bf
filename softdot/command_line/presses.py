"""The arguments of the commands that press: run, sweep, family, array, verify and studio."""

from argparse import ArgumentTypeError
from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_config, add_output, add_scheduler, add_set


def add_run(commands: Any) -> None:
    """Add the command softdot run."""
    run = commands.add_parser(
        "run",
        help="build, mesh, press and export one segment",
        description="Build, mesh and press one segment; write CAD, ParaView results, pictures and a report.",
        epilog="'softdot schema' explains every key of CONFIG.toml; examples/ has files to start from. " + EXIT_STATUS,
    )
    add_config(run)
    run.add_argument(
        "--mesh-format",
        action="append",
        default=[],
        metavar="FORMAT",
        help="write the mesh for other codes too: msh (Gmsh), inp (Abaqus, CalculiX) or xdmf; may be repeated",
    )
    add_output(run)


def add_sweep(commands: Any) -> None:
    """Add the command softdot sweep."""
    sweep = commands.add_parser(
        "sweep",
        help="press many designs over any keys of the configuration",
        description="Solve every point of a design space on all cores, or on a Dask cluster, into one table. "
        "A sweep that was stopped resumes where it was.",
        epilog="examples/ has a SPACE.toml to start from. " + EXIT_STATUS,
    )
    sweep.add_argument("space", metavar="SPACE.toml", help="a configuration and its axes")
    sweep.add_argument(
        "--family", metavar="FAM", help="answer the points by this folder of softdot family instead of presses"
    )
    add_set(sweep)
    add_scheduler(sweep)
    add_output(sweep)


def add_family(commands: Any) -> None:
    """Add the command softdot family."""
    family = commands.add_parser(
        "family",
        help="press a few designs of a space so that all others are answered in milliseconds",
        description="Press designs of a space, each with its derivatives, until presses that took no part are answered "
        "within the asked accuracy; softdot.load_family answers all others. A stopped command goes on where it was.",
        epilog="docs/family.md explains SPACE.toml and the answers. " + EXIT_STATUS,
    )
    family.add_argument("space", metavar="SPACE.toml", help="a configuration and its axes, as of softdot sweep")
    family.add_argument(
        "--accuracy", type=percent, nargs=2, default=(1.0, 1.5), metavar=("FORCE", "VOLTAGE"),
        help="errors in percent that 95 %% of the designs stay below; default: 1 1.5",
    )  # fmt: skip
    family.add_argument("--presses", type=count_of_presses, default=80, metavar="N", help="most presses; default: 80")
    add_set(family)
    add_scheduler(family)
    add_output(family)


def add_goal(commands: Any) -> None:
    """Add the command softdot goal."""
    goal = commands.add_parser(
        "goal",
        help="find the design of a family that gives enough for the least force",
        description="Find the design of a family that gives enough of one quantity for the least of another, whatever "
        "the batch, press it in full, and write it as a configuration.",
        epilog="docs/family.md explains goals. Exit status 3 also where no design meets the goal. " + EXIT_STATUS,
    )
    goal.add_argument("family", metavar="FAM", help="folder of softdot family")
    goal.add_argument(
        "--reach", type=target, required=True, metavar="QUANTITY=VALUE",
        help="what is to be reached at full load, without sign, such as open_circuit_voltage_V=10",
    )  # fmt: skip
    goal.add_argument(
        "--least", default="reaction_force_N", metavar="QUANTITY", help="what is to be small; default: reaction_force_N"
    )
    goal.add_argument(
        "--batch", action="append", default=[], metavar="KEY", help="drawn over its range, not chosen; may be repeated"
    )
    goal.add_argument(
        "--probability", type=probability, default=0.95, metavar="P", help="with which it is reached; default: 0.95"
    )
    add_output(goal)


def target(text: str) -> tuple[str, float]:
    """QUANTITY=VALUE with a value above 0. ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        found = float(value)
    except ValueError:
        found = float("nan")
    if not 0.0 < found < float("inf"):
        raise ArgumentTypeError(f"'{text}' is not QUANTITY=VALUE with a number above 0")
    return name.strip(), found


def probability(text: str) -> float:
    """A probability of 0.5 to 0.999. ArgumentTypeError."""
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0.5 <= value <= 0.999:
        raise ArgumentTypeError(f"'{text}' is not between 0.5 and 0.999")
    return value


def percent(text: str) -> float:
    """A percentage between 0.01 and 50. ArgumentTypeError."""
    try:
        value = float(text)
    except ValueError:
        raise ArgumentTypeError(f"'{text}' is no number") from None
    if not 0.01 <= value <= 50.0:
        raise ArgumentTypeError(f"{text} is not between 0.01 and 50 percent")
    return value


def count_of_presses(text: str) -> int:
    """A whole number between 8 and 1000. ArgumentTypeError."""
    if not text.isdecimal() or not 8 <= int(text) <= 1000:
        raise ArgumentTypeError(f"'{text}' is no whole number between 8 and 1000")
    return int(text)


def add_array(commands: Any) -> None:
    """Add the command softdot array."""
    array = commands.add_parser(
        "array",
        help="press several segments under shared layers: their crosstalk",
        description="Press each segment of an array alone: charge and voltage of every segment, and the lone segment "
        "that stands for one of them. Presses that were solved are kept, so that a second run goes on.",
        epilog="docs/array.md explains the table [array] and the results. " + EXIT_STATUS,
    )
    add_config(array)
    array.add_argument(
        "--variants",
        dest="parts",
        action="append_const",
        const="variants",
        default=[],
        help="press the same segments joined in other ways too, for comparison",
    )
    array.add_argument(
        "--kernel", dest="parts", action="append_const", const="kernel",
        help="write the kernel: charge of every segment against place and depth of a dot, as softdot read needs it",
    )  # fmt: skip
    add_scheduler(array)
    add_output(array)


def add_verify(commands: Any) -> None:
    """Add the command softdot verify."""
    verify = commands.add_parser(
        "verify",
        help="solve problems with known answers: is it right on this machine?",
        description="Solve named verification problems on this machine and compare them with closed forms, published "
        "benchmarks and other codes, each within a bound: a table, a page and verify.json.",
        epilog="docs/verification.md says what is verified, what is validated, and what is neither. Exit status: 0 all "
        "passed, 2 bad input, 3 a problem failed, 130 interrupted.",
    )
    verify.add_argument(
        "--only", action="append", default=[], metavar="NAME", help="this problem alone; may be repeated"
    )
    add_output(verify)


def add_studio(commands: Any) -> None:
    """Add the command softdot studio."""
    studio = commands.add_parser(
        "studio",
        help="design a segment in the browser, on this machine",
        description="Open a page in the browser in which a design is changed by hand and pressed at once. It answers "
        "on this machine only, and only to the address that it prints.",
        epilog="Needs pip install 'softdot[studio]'; docs/studio.md explains the page. " + EXIT_STATUS,
    )
    studio.add_argument("config", nargs="?", metavar="CONFIG.toml", help="default: the final design of the paper")
    studio.add_argument("--port", type=int, default=0, metavar="N", help="port of the page; default: a free one")
    studio.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS", help="address of this machine; other than loopback it is open"
    )
    studio.add_argument("--no-browser", action="store_true", help="only print the address of the page")
    studio.add_argument(
        "--family", metavar="FAM", help="folder of softdot family: its designs are estimated and sought by it"
    )
