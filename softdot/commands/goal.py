"""softdot goal: the design of a family that gives enough of one quantity for the least of another."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Find, press and write the design into chosen.output; 0, or 3 where no design meets the goal. InputError."""
    from mesh.types import MeshingError
    from softdot.families.goal import Goal
    from softdot.families.goal_folder import run_goal
    from softdot.progress import progress_of
    from solve.solution.full_load import StoppedShortError
    from solve.solution.linear import LinearSolveError

    enough, target = chosen.reach
    goal = Goal(enough, target, chosen.least, tuple(chosen.batch), chosen.probability)
    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_goal(Path(chosen.family), goal, Path(chosen.output), progress)
    except (MeshingError, LinearSolveError, StoppedShortError) as error:
        complain(f"the design that was found could not be pressed: {error}; nothing was written")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD if summary["reached"] else NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The design, what it gives, and what a full press says."""
    goal = summary["goal"]
    lines = [f"{key} = {value:.5g}" for key, value in summary["design"].items()]
    for name in (goal["enough"], goal["least"]):
        low, middle, high = summary[name].values()
        batches = f", nine batches in ten {low:.4g} to {high:.4g}" if goal["batch"] else ""
        lines.append(f"{name}: {middle:.4g}{batches}")
    lines.append(
        f"{goal['enough']} >= {goal['target']:g} with a probability of {summary['probability']:.3g}, "
        f"{summary['probability_at_the_low_end_of_the_interval']:.3g} at the low end of the family's interval"
    )
    for name, one in summary["in_the_middle"].items():
        lines.append(f"a full press: {name} = {one['pressed']:.4g}, answered {one['answered']:.4g}")
    if summary["at_an_end"]:
        lines.append(f"at the end of its range: {', '.join(summary['at_an_end'])}")
    return "\n".join([*lines, f"{output}/design.toml"])
