"""The arguments of the commands that produce evidence: paper and prove."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_output, add_scheduler


def add_paper(commands: Any) -> None:
    """Add the command softdot paper."""
    paper = commands.add_parser(
        "paper",
        help="reproduce and examine every table, figure and number of the paper",
        description="Solve the whole study of the paper and continue it: its tables, figures and published "
        "numbers beside ours, the calibration factor, and a design search. A second run uses the cache.",
        epilog=EXIT_STATUS,
    )
    add_scheduler(paper)
    add_output(paper)


def add_prove(commands: Any) -> None:
    """Add the command softdot prove."""
    prove = commands.add_parser(
        "prove",
        help="count how often a diagnosis is right, with hidden effects from another code",
        description="Hide effects in recordings of another code, seal the truth, diagnose, reveal and count. "
        "A proof that was stopped resumes where it was.",
        epilog="docs/studies/prove.md explains the cases and the table. " + EXIT_STATUS,
    )
    prove.add_argument("--cases", type=int, required=True, metavar="N", help="how many recordings")
    prove.add_argument("--seed", type=int, default=0, metavar="S", help="of the cases")
    rigs = "of the hidden world, such as thick-clamped,thick-free; default: two ridges and a round dot"
    prove.add_argument("--rigs", metavar="NAME,NAME", help=rigs)
    kinds = "from none, single, pair, left-out, outside, ambiguous; default: all"
    prove.add_argument("--kinds", metavar="KIND,KIND", help=kinds)
    prove.add_argument("--mechanisms", metavar="NAME,NAME", help="known effects are of these; default: all")
    prove.add_argument("--staged", action="store_true", help="the first eight mechanisms only")
    prove.add_argument("--details", action="store_true", help="rigs with small flaws that no mechanism describes")
    prove.add_argument("--workers", type=int, metavar="N", help="number of processes; one per core by default")
    add_scheduler(prove)
    add_output(prove)
