"""softdot prove: from the plan of concealed cases to the table of rates."""

from argparse import Namespace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from softdot.console import GOOD, INTERRUPTED, NOT_CONVERGED, complain, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Prove chosen.cases cases into chosen.output; 0, 3 when none was scored, or 130 when interrupted. InputError."""
    if find_spec("skfem") is None:
        raise InputError("prove needs scikit-fem, the other finite-element code: pip install 'softdot[prove]'")
    from softdot.studies.proof.proof_folder import CASES
    from softdot.studies.proof.run import RIGS, Request, run_proof
    from softdot.studies.proof.world.cases import KINDS
    from softdot.sweeps.progress import progress_of_points

    rigs = tuple(chosen.rigs.split(",")) if chosen.rigs else RIGS
    kinds = tuple(chosen.kinds.split(",")) if chosen.kinds else KINDS
    mechanisms = tuple(chosen.mechanisms.split(",")) if chosen.mechanisms else ()
    request = Request(
        chosen.cases, chosen.seed, rigs, chosen.staged, chosen.workers, kinds, chosen.scheduler,
        details=chosen.details, mechanisms=mechanisms,
    )  # fmt: skip
    try:
        with only_the_summary_on_stdout(), progress_of_points(chosen) as progress:
            summary = run_proof(request, Path(chosen.output), progress)
    except KeyboardInterrupt:
        if not (Path(chosen.output) / CASES).exists():
            raise
        complain(f"interrupted; finished cases are kept in '{chosen.output}', the same command continues")
        return INTERRUPTED
    show(summary, chosen, short_text)
    if summary["ended"].get("scored"):
        return GOOD
    complain(f"not one of {summary['cases']} cases has a verdict; the reasons are in '{chosen.output}/proof.json'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: how the cases ended, the first rates, and the path of the table."""
    from softdot.studies.proof.proof_page import HEAD, percent

    ended = ", ".join(f"{count} {status}" for status, count in summary["ended"].items())
    lines = [f"{summary['cases']} cases: {ended}"]
    lines += [f"{words}: {percent(summary['rates'][name])}" for name, words in HEAD.items()]
    return "\n".join([*lines, f"{output}/proof.md"])
