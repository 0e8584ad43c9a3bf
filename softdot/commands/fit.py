"""softdot fit: named parts of a rig, fitted to a recording in seconds, without a diagnosis."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Fit chosen.only to chosen.recording into chosen.output; 0, or 3 where the baseline did not converge.

    InputError.
    """
    from mesh.types import MeshingError
    from softdot.progress import progress_of
    from softdot.quick_fit.folder import run_fit
    from solve.solution.errors import NoEquilibriumError

    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_fit(Path(chosen.recording), Path(chosen.output), progress)
    except (NoEquilibriumError, MeshingError) as error:
        complain(f"fit, {error}; nothing was written")
        return NOT_CONVERGED
    show(summary, chosen, _short_text)
    return GOOD


def _short_text(summary: dict[str, Any], output: str) -> str:
    """The table, and the path of the picture."""
    return f"{summary['text']}\n{output}/residuals.png"
