"""softdot run: what it prints and how it exits."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.command_output import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.default_design import told


def command(chosen: Namespace) -> int:
    """Run chosen.config into chosen.output; 0, or 3 when a computation did not converge. InputError."""
    from softdot.config import load_config
    from softdot.progress import progress_of
    from softdot.run import run_config

    config = load_config(chosen.config, chosen.set)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = run_config(config, Path(chosen.output), progress)
    show(summary, chosen, short_text)
    if summary["solver"]["converged"]:
        return GOOD
    complain(f"not converged, {summary['solver']['failure']}; what converged is in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """The deepest step and where to look, in a few lines."""
    from export.report import plus_minus

    lines = []
    if summary.get("indentation_mm"):
        force, voltage = (plus_minus(summary, name) for name in ("force_percent", "voltage_percent"))
        lines.append(
            f"{summary['indentation_mm'][-1]:.3g} mm: force {summary['reaction_force_N'][-1]:.4g} N{force}, "
            f"charge {summary['film_charge_pC'][-1]:.4g} pC, "
            f"open-circuit voltage {summary['open_circuit_voltage_V'][-1]:.4g} V{voltage}"
        )
    if summary.get("from_default"):
        lines.append(told(summary["from_default"], summary["config"]))
    return "\n".join([*lines, f"{output}/report.html"])
