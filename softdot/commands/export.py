"""softdot export: the sensor for a circuit simulator, or for a robot simulator."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Write what chosen.what names into chosen.output; 0, or 3 where the press did not converge. InputError."""
    with only_the_summary_on_stdout():
        summary = _spice(chosen) if chosen.what == "spice" else _robot(chosen)
    if "failure" in summary:
        complain(f"not converged, {summary['failure']}; nothing was written")
        return NOT_CONVERGED
    show(summary, chosen, _short_text)
    return GOOD


def _spice(chosen: Namespace) -> dict[str, Any]:
    from softdot.spice_folder import write_spice

    return write_spice(Path(chosen.source), Path(chosen.output), chosen.set)


def _robot(chosen: Namespace) -> dict[str, Any]:
    from softdot.robot_folder import write_robot

    return write_robot(Path(chosen.source), Path(chosen.output))


def _short_text(summary: dict[str, Any], output: str) -> str:
    """What was written, and how it is used."""
    if "nodes" in summary:
        nodes = ", ".join(f"v({node}) of '{name}'" for name, node in summary["nodes"].items())
        return f"{nodes}; expected.csv has what softdot calculates\nngspice -b -r out.raw {output}/sensor.cir"
    return f"{summary['readings_per_s']:.0f} readings per second on one core\npython {output}/slide.py"
