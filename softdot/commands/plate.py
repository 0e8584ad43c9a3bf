"""softdot plate: a printable Braille plate from a text."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from geometry.braille_standards import QUANTITIES
from softdot.console import GOOD, only_the_summary_on_stdout, show
from softdot.plate.folder import make_plate
from softdot.plate.options import PlateRequest


def command(chosen: Namespace) -> int:
    """Write the requested plate into chosen.output. InputError."""
    from softdot.progress import progress_of

    request = request_of(chosen)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = make_plate(request, Path(chosen.output), progress)
    show(summary, chosen, short_text)
    return GOOD


def request_of(chosen: Namespace) -> PlateRequest:
    """The request that the command line states. InputError for a list of heights with anything but numbers."""
    given = {name: value for name in QUANTITIES if (value := getattr(chosen, name)) is not None}
    return PlateRequest(
        standard=chosen.standard,
        kind=chosen.kind,
        text=chosen.text,
        given=given,
        table=chosen.table,
        width_cells=chosen.width_cells,
        heights_mm=None if chosen.heights_mm is None else _heights(chosen.heights_mm),
        thickness_mm=chosen.thickness_mm,
        margin_mm=chosen.margin_mm,
        thread=chosen.thread,
    )


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: cells, size, advice on printers, and the path of the solid."""
    size = " x ".join(f"{value:.4g}" for value in summary["size_mm"])
    advice = [f"{answer['profile']}: {answer['advice']}" for answer in summary["printability"]]
    return "\n".join([*summary.get("cells", []), f"{size} mm", *advice, f"{output}/plate.stl"])


def _heights(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(value) for value in text.split(","))
    except ValueError:
        raise InputError(f"--heights-mm = '{text}': must be numbers in mm separated by commas") from None
