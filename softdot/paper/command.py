"""softdot paper: what it prints and how it exits."""

import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.numbers import json_text
from softdot.run_command import GOOD, NOT_CONVERGED, only_the_summary_on_stdout


def command(chosen: Namespace) -> int:
    """Make the whole study in chosen.output; 0, or 3 when a press gave no result. InputError."""
    from softdot.paper.presses import NotSolvedError
    from softdot.paper.study import run_paper
    from softdot.progress import progress_on_terminal

    try:
        with only_the_summary_on_stdout(), progress_on_terminal() as progress:
            summary = run_paper(Path(chosen.output), progress)
    except NotSolvedError as error:
        print(f"softdot: paper, {error}; nothing was written, solved presses are remembered", file=sys.stderr)
        return NOT_CONVERGED
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif sys.stdout.isatty():
        print(short_text(summary, chosen.output))
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The findings and where to look."""
    return "\n".join([*(f"- {finding}" for finding in summary["findings"]), f"{output}/paper.html"])
