"""softdot diagnose: from a folder of recordings to a verdict."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.diagnosis.folder import FULL_MODEL_S, Options, run_diagnosis
from solve.solution.errors import NoEquilibriumError


def command(chosen: Namespace) -> int:
    """Diagnose chosen.recording into chosen.output; 0, or 3 when a press did not converge. InputError."""
    from mesh.types import MeshingError
    from softdot.progress import progress_of

    if chosen.seed is not None and chosen.seed < 0:
        raise InputError(f"--seed = {chosen.seed}: must be at least 0")
    limit_s = None if chosen.all_presses else 0.0 if chosen.fast_model_only else FULL_MODEL_S
    options = Options(limit_s, chosen.seed, tuple(chosen.without), tuple(chosen.hold_out))
    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_diagnosis(Path(chosen.recording), Path(chosen.output), options, progress, chosen.scheduler)
    except (NoEquilibriumError, MeshingError) as error:
        complain(f"diagnose, {error}; nothing was written")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    if summary["fit"]["failure"] is None:
        return GOOD
    complain(f"not converged, {summary['fit']['failure']}; the verdict without it is in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The sentences of the verdict, and the path of the report."""
    return "\n".join([*summary["summary"], f"{output}/report.html"])
