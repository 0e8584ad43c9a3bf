"""softdot paper: what it prints and how it exits."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.command_output import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Make the whole study in chosen.output; 0, or 3 when a press gave no result. InputError."""
    from softdot.paper.presses import NotSolvedError
    from softdot.paper.study import run_paper
    from softdot.progress import progress_of

    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_paper(Path(chosen.output), progress)
    except NotSolvedError as error:
        complain(f"paper, {error}; nothing was written, solved presses are cached")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The findings and where to look."""
    return "\n".join([*(f"- {finding}" for finding in summary["findings"]), f"{output}/paper.html"])
