"""Verdicts on recordings that this project did not make: python -m benchmarks.verdicts JSON FOLDER… [--stability].

Each FOLDER holds recordings (folders with rig.toml), and truth.json where what they hide is known: the diagnosis never
sees it. With --stability each is diagnosed again as nothing of the physics changes: of every second, third and sixth
row, averaged over two and four samples, with half and twice the stated noise where a noise is stated, and with its runs
in another order, so that other presses are held out. Rows that the file has are not measured again.
"""

import json
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks.timing import Table, file_argument
from diagnose.findings import Findings
from diagnose.inference.diagnose import diagnose
from diagnose.signals.reading import average_blocks, thin_recording
from diagnose.signals.recording import Recording, Run
from diagnose.signals.run_checks import FEWEST_SAMPLES
from diagnose.verdict.names import short_name
from foundation.errors import InputError
from softdot.config.rig import RIG_FILE, load_rig
from softdot.diagnosis.engine import engine_for

AS_IT_IS = "as it is"


def averaged_over(factor: int) -> Callable[[Recording], Recording | None]:
    """Means over so many samples in a row; None where too few would stay."""

    def change(recording: Recording) -> Recording | None:
        if min(len(run.time_s) for run in recording.runs) < factor * FEWEST_SAMPLES:
            return None
        return replace(recording, runs=tuple(average_blocks(run, factor) for run in recording.runs))

    return change


def every_row(factor: int) -> Callable[[Recording], Recording | None]:
    """One of so many rows, as a slower logger takes them; None where too few would stay."""

    def thinned(run: Run) -> Run:
        of_channels = {
            name: {channel: values[::factor] for channel, values in getattr(run, name).items()}
            for name in ("channels", "valid", "saturated", "covariates")
        }
        return replace(run, time_s=run.time_s[::factor], **of_channels)

    def change(recording: Recording) -> Recording | None:
        if min(len(run.time_s) for run in recording.runs) < factor * FEWEST_SAMPLES:
            return None
        return replace(recording, runs=tuple(map(thinned, recording.runs)))

    return change


def with_noise(factor: float) -> Callable[[Recording], Recording | None]:
    """The stated noise times a factor; None where none is stated."""

    def change(recording: Recording) -> Recording | None:
        if not any(run.noise for run in recording.runs):
            return None
        louder = [{name: factor * sigma for name, sigma in run.noise.items()} for run in recording.runs]
        return replace(
            recording, runs=tuple(replace(run, noise=own) for run, own in zip(recording.runs, louder, strict=True))
        )

    return change


def reordered(recording: Recording) -> Recording | None:
    """The first run last; None for a single run."""
    return replace(recording, runs=(*recording.runs[1:], recording.runs[0])) if len(recording.runs) > 1 else None


VARIANTS: Mapping[str, Callable[[Recording], Recording | None]] = {
    AS_IT_IS: lambda recording: recording,
    "every second row": every_row(2),
    "every third row": every_row(3),
    "every sixth row": every_row(6),
    "averaged over 2": averaged_over(2),
    "averaged over 4": averaged_over(4),
    "half the stated noise": with_noise(0.5),
    "twice the stated noise": with_noise(2.0),
    "runs in another order": reordered,
}


def row_of(findings: Findings, seconds: float) -> dict[str, Any]:
    """What a reader of the verdict learns."""
    words = [short_name([setting.candidate for setting in model.settings]) for model in findings.models]
    group = findings.groups[0] if findings.best is not None and findings.groups else ()
    fit = findings.held_out if findings.best is not None else findings.unnamed
    return {
        "grade": str(findings.grade),
        "named": words[0] if findings.best is not None else "",
        "group": [words[n] for n in group[1:]],
        "first": words[0] if words else "",
        "before": fit.nrmse_before if fit else None,
        "after": fit.nrmse_after if fit else None,
        "noise": fit.noise_floor_nrmse if fit else None,
        "share": findings.remainder.share if findings.remainder else None,
        "seconds": round(seconds, 1),
    }


def truth_of(folder: Path) -> str | None:
    """mechanism (component) of a recording, "none", or None where it is not known."""
    path = folder.parent / "truth.json"
    if not path.exists():
        return None
    hidden = json.loads(path.read_text("utf-8"))[folder.name]
    return " + ".join(f"{one['mechanism']} ({one['component']})" for one in hidden["truths"]) or "none"


def diagnosed(folder: Path, change: Callable[[Recording], Recording | None]) -> dict[str, Any] | None:
    """The row of one recording that is changed, with the sentence by which it is refused if it is; None where the
    change says nothing new.
    """
    rig = load_rig(folder)
    changed = change(rig.recording)
    if changed is None:
        return None
    rig = replace(rig, recording=thin_recording(changed))
    start = time.perf_counter()
    try:
        findings = diagnose(rig.recording, engine_for(rig, silent), rig.bench.seed, silent)
    except InputError as error:
        return {"grade": "refused", "named": "", "said": str(error)}
    return row_of(findings, time.perf_counter() - start)


def silent(*_: object) -> None:
    """Reports to nobody."""


def main(path: Path, folders: list[Path], variants: list[str]) -> None:
    """Diagnose what the file has not."""
    table = Table(path, "verdicts")
    for folder in sorted(place.parent for root in folders for place in root.rglob(RIG_FILE)):
        for variant in variants:
            if table.has(recording=folder.name, variant=variant):
                continue
            found = diagnosed(folder, VARIANTS[variant])
            if found is not None:
                table.add({"recording": folder.name, "variant": variant, "truth": truth_of(folder), **found})


if __name__ == "__main__":
    given = [Path(word) for word in sys.argv[2:] if not word.startswith("--")]
    main(file_argument(), given, list(VARIANTS) if "--stability" in sys.argv else [AS_IT_IS])
