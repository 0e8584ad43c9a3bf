"""softdot material: a law for a configuration from the tests of a specimen."""

import re
from argparse import Namespace
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from softdot.console import GOOD, only_the_summary_on_stdout, show
from softdot.material.characterise import MaterialRequest
from softdot.material.outcome import make_material

SIZES = "width_mm", "thickness_mm", "gauge_length_mm", "area_mm2"


def command(chosen: Namespace) -> int:
    """Fit the material of chosen.tests into chosen.output. InputError."""
    from softdot.progress import progress_of

    out = Path(chosen.output)
    name = chosen.name or re.sub(r"[^A-Za-z0-9_-]+", "-", out.resolve().name).strip("-")
    if not re.fullmatch(r"[A-Za-z0-9_-]+", name):
        raise InputError(f"--name = '{chosen.name or out.name}': must be letters, digits, - and _")
    request = MaterialRequest(
        tuple(Path(one) for one in chosen.tests),
        tuple(chosen.kind or ["tension"]),
        {size: value for size in SIZES if (value := getattr(chosen, size)) is not None},
        chosen.columns,
        0.01 * chosen.strain_range_percent,
        None if chosen.slack_percent is None else 0.01 * chosen.slack_percent,
        chosen.poisson_ratio,
        chosen.law,
        chosen.preconditioned,
    )
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = make_material(request, name, tuple(chosen.layer), out, progress)
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The summary in a few lines: range, ranking, how far it may be trusted, and the files."""
    ranking = ", ".join(f"{one['name']} {100 * one['held_out_error']:.2g} %" for one in summary["laws"][:4])
    memory = " and ".join(one["name"] for one in summary["mechanisms"])
    law = f"{summary['law']} with {memory}" if memory else summary["law"]
    whole = "the whole test" if memory else "first loading"
    reached = f"up to {100 * summary['reached_strain']:.3g} % of strain; beyond, it is an extrapolation"
    lines = [
        f"{law}: misses {100 * summary['error']:.2g} % of the stress of {whole} {reached}",
        f"without memory, on strains that were left out: {ranking}",
    ]
    return "\n".join([*lines, f"{output}/material.toml, {output}/material.html"])
