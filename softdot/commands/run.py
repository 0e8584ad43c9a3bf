"""softdot run: one press of one configuration, with all its files."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any
from warnings import catch_warnings, simplefilter

from foundation.errors import InputError
from foundation.library_loading import without_garbage_collection
from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.memory import refuse_no_room_for_libraries
from softdot.run_folder import run_case
from softdot.second_process import SecondProcess

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence


def command(chosen: Namespace) -> int:
    """Run chosen.config into chosen.output; 0, or 3 when a computation did not converge. InputError."""
    refuse_no_room_for_libraries()
    with SecondProcess() as ask:  # at once: it loads its libraries while this one does
        with without_garbage_collection():
            Thread(target=_try_to_draw, daemon=True).start()
            from softdot.case import Case
            from softdot.config.loading import load_config
            from softdot.pressed import ResultWarning
            from softdot.progress import progress_of
            from softdot.tolerances.uncertainty import uncertainty  # noqa: F401 - loads the solver

        config = load_config(chosen.config, chosen.set)
        with catch_warnings(), only_the_summary_on_stdout(), progress_of(chosen) as progress:
            simplefilter("ignore", ResultWarning)  # told as its other warnings are, and by the exit code
            summary = run_case(Case(config), Path(chosen.output), progress, chosen.mesh_format, ask)
    show(summary, chosen, short_text)
    if summary["solver"]["converged"]:
        return GOOD
    complain(f"not converged, {summary['solver']['failure']}; what converged is in '{chosen.output}'")
    return NOT_CONVERGED


def _try_to_draw() -> None:
    """Test whether pictures can be drawn, for half a second beside other work; run_case reports a failure."""
    from export.rendering import ensure_rendering

    with suppress(InputError):
        ensure_rendering()


PART_WORDS = {1: "a half", 2: "a quarter"}
"""Number of planes of symmetry -> the part that is solved, in words."""


def _symmetry_lines(planes: Sequence[str]) -> list[str]:
    """A line that names the planes of symmetry, where only a part was solved."""
    if not planes:
        return []
    return [
        f"symmetric about {' and '.join(planes)}: solved on {PART_WORDS[len(planes)]}, all results are of the whole"
    ]


def short_text(summary: dict[str, Any], output: str) -> str:
    """The deepest step in a few lines, and the path of the report."""
    from export.report import plus_minus
    from softdot.config.default_design import default_design_line

    lines = []
    if summary.get("indentation_mm"):
        force, voltage = (plus_minus(summary, name) for name in ("force_percent", "voltage_percent"))
        lines += _symmetry_lines(summary["mesh"]["symmetry_planes"])
        lines.append(
            f"{summary['indentation_mm'][-1]:.3g} mm: force {summary['reaction_force_N'][-1]:.4g} N{force}, "
            f"charge {summary['film_charge_pC'][-1]:.4g} pC, "
            f"open-circuit voltage {summary['open_circuit_voltage_V'][-1]:.4g} V{voltage}"
        )
    if summary.get("from_default"):
        lines.append(default_design_line(summary["from_default"], summary["config"]))
    return "\n".join([*lines, f"{output}/report.html"])
