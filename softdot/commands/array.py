"""softdot array: crosstalk of several segments, the lone segment that stands for one of them, and the press of a
cell.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdot.arrays.folder import run_array
from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show

if TYPE_CHECKING:
    from argparse import Namespace


def command(chosen: Namespace) -> int:
    """Study chosen.config into chosen.output; 0, or 3 when a press did not converge. InputError."""
    from mesh.types import MeshingError
    from softdot.arrays.presses import StoppedPressError
    from softdot.config.loading import load_config
    from softdot.progress import progress_of

    config = load_config(chosen.config, chosen.set)
    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_array(config, Path(chosen.output), progress, frozenset(chosen.parts), chosen.scheduler)
    except (StoppedPressError, MeshingError) as error:
        complain(f"{error}; nothing was written, presses that were solved are kept in the cache")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: crosstalk, the lone segment that stands for others, and the path of the report."""
    lines = [
        f"{len(summary['segments'])} segments, {summary['solver']['presses']} presses solved: largest crosstalk "
        f"{summary['largest_crosstalk_percent']:.3g} %"
    ]
    for role, sides in summary["effective_sides"].items():
        best = sides["best"]
        answer = "depth" if best["force_percent"] is None else "force"
        lines.append(
            f"{role} segment: sides of {sides['stiffness_N_per_mm3']:.3g} N/mm3, off by "
            f"{best[f'{answer}_percent']:+.1f} % in {answer} and {best['voltage_percent']:+.1f} % in voltage"
        )
    if summary["kernel_error"]:
        error = summary["kernel_error"]
        lines.append(
            f"kernel: charges within {error['charge_percent']:.2g} %, force within {error['force_percent']:.2g} %"
        )
    return "\n".join([*lines, f"{output}/report.html"])
