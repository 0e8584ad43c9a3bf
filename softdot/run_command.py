"""softdot run: what it prints and how it exits."""

import os
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from softdot.numbers import json_text

GOOD, NOT_CONVERGED = 0, 3


def command(chosen: Namespace) -> int:
    """Run chosen.config into chosen.output; 0, or 3 when a computation did not converge. InputError."""
    from softdot.config import load_config
    from softdot.progress import progress_on_terminal
    from softdot.run import run_config

    config = load_config(chosen.config)
    with only_the_summary_on_stdout(), progress_on_terminal() as progress:
        summary = run_config(config, Path(chosen.output), progress)
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif sys.stdout.isatty():
        print(short_text(summary, chosen.output))
    if summary["solver"]["converged"]:
        return GOOD
    failure = " ".join(summary["solver"]["failure"].split())
    print(f"softdot: not converged, {failure}; what converged is in '{chosen.output}'", file=sys.stderr)
    return NOT_CONVERGED


@contextmanager
def only_the_summary_on_stdout() -> Iterator[None]:
    """Send what compiled libraries print to standard error while the pipeline runs."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


def short_text(summary: dict[str, Any], output: str) -> str:
    """The deepest step and where to look, in a few lines."""
    lines = []
    if summary.get("indentation_mm"):
        lines.append(
            f"{summary['indentation_mm'][-1]:.3g} mm: force {summary['reaction_force_N'][-1]:.4g} N, "
            f"charge {summary['film_charge_pC'][-1]:.4g} pC, "
            f"open-circuit voltage {summary['open_circuit_voltage_V'][-1]:.4g} V"
        )
    lines += [f"warning: {warning}" for warning in summary["warnings"]]
    return "\n".join([*lines, f"{output}/report.html"])
