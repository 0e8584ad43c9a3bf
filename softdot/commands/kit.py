"""softdot kit: everything that a workshop needs to make a segment, and the effect of each tolerance."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.kit.folder import make_kit

SHOWN_TOLERANCES = 5


def command(chosen: Namespace) -> int:
    """Write the kit of chosen.config into chosen.output; 0, or 3 when its press did not converge. InputError."""
    from softdot.config.loading import load_config
    from softdot.progress import progress_of

    config = load_config(chosen.config, chosen.set)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = make_kit(config, Path(chosen.output), progress, chosen.scheduler)
    show(summary, chosen, short_text)
    if summary["failure"] is None:
        return GOOD
    complain(f"not converged, {summary['failure']}; the rest of the kit is in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: number of parts, the largest tolerances, and the path of the build sheet."""
    lines = [f"{len(summary['parts'])} parts to print, {len(summary['flat_patterns'])} to cut"]
    budget = summary["tolerance_budget"]
    if budget and summary["config"]["array"] is not None:
        lines.append(f"tolerances of {summary['tolerance_budget_of']}:")
    for row in budget["rows"][:SHOWN_TOLERANCES] if budget else []:
        change = f"{row['voltage_percent']:+.0f} % voltage, {row['force_percent']:+.0f} % force"
        lines.append(f"{row['label']} ±{row['plus_minus']:.3g} {row['unit']}: {change}")
    return "\n".join([*lines, f"{output}/kit.html"])
