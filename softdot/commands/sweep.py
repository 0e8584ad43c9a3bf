"""softdot sweep: from a space of designs to a table."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import (
    GOOD,
    INTERRUPTED,
    NOT_CONVERGED,
    complain,
    only_the_summary_on_stdout,
    show,
)
from softdot.sweeps.progress import progress_of_points
from softdot.sweeps.run import run_sweep


def command(chosen: Namespace) -> int:
    """Sweep chosen.space into chosen.output; 0, 3 when no point could be solved, 130 when interrupted. InputError."""
    from softdot.families.folder import load_family
    from softdot.sweeps.folder import POINTS
    from softdot.sweeps.space import load_space

    space = load_space(chosen.space, chosen.set)
    family = None if chosen.family is None else load_family(chosen.family)
    try:
        with only_the_summary_on_stdout(), progress_of_points(chosen) as progress:
            summary = run_sweep(space, Path(chosen.output), chosen.scheduler, progress, family)
    except KeyboardInterrupt:
        if not (Path(chosen.output) / POINTS).exists():
            raise
        kept = f"finished points are kept in '{chosen.output}', the same command continues with the others"
        complain(f"interrupted; {kept}")
        return INTERRUPTED
    show(summary, chosen, short_text)
    if summary["ended"]["solved"]:
        return GOOD
    complain(f"not one of {summary['points']} points could be solved; the reasons are in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: how the points ended, how fast, and the path of the page."""
    ended = ", ".join(f"{count} {status}" for status, count in summary["ended"].items() if count)
    lines = [f"{summary['points']} points: {ended}"]
    if summary["answered_from_presses"] is not None:
        lines.append(f"answered by a family of {summary['answered_from_presses']} presses")
    elif summary["solved_now"]:
        rate = f"{summary['points_per_minute']:.3g} points per minute on {summary['workers']} workers"
        lines.append(f"{summary['solved_now']} solved now, {rate}; {summary['reused']} were there")
    return "\n".join([*lines, f"{output}/report.html"])
