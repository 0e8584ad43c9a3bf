"""softdot family: from a space of designs to answers in milliseconds."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.sweeps.progress import progress_of_points


def command(chosen: Namespace) -> int:
    """Press the family of chosen.space into chosen.output; 0, 3 when too few designs could be pressed. InputError."""
    from mesh.types import MeshingError
    from softdot.families.build import Asked, FamilyFailedError, build_family
    from softdot.families.fit import FORCE, VOLTAGE
    from softdot.families.space import load_family_space

    space = load_family_space(Path(chosen.space), chosen.set)
    force, voltage = chosen.accuracy
    asked = Asked({FORCE: force / 100.0, VOLTAGE: voltage / 100.0}, chosen.presses, space.sweep.seed)
    try:
        with only_the_summary_on_stdout(), progress_of_points(chosen) as progress:
            summary = build_family(space, Path(chosen.output), asked, chosen.scheduler, progress)
    except (FamilyFailedError, MeshingError) as error:
        complain(f"{error}; nothing was written, presses that were solved are kept in the cache")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: presses, accuracy, and the path of the page."""
    from softdot.families.fit import FORCE, VOLTAGE

    expected, error = summary["expected_error_percent"], summary["discretisation_error_percent"]
    pressed = summary["presses"]
    shown = "shown by presses that took no part" if summary["reached"] else "not shown to be what was asked"
    lines = [
        f"{pressed['solved']} presses, {pressed['from_cache']} of them from the cache, in {summary['seconds']:.0f} s",
        f"95 % of the designs within {expected[FORCE]:.2g} % in force and {expected[VOLTAGE]:.2g} % in voltage,"
        f" {shown}",
    ]
    if error is not None:
        lines.append(f"the mesh is off by about {error[FORCE]:.2g} % in force and {error[VOLTAGE]:.2g} % in voltage")
    return "\n".join([*lines, f"{output}/family.html"])
