"""Recordings of a rig: their signals and phases to look at, and the diagnosis with its verdict."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np

from foundation.worker_process import Tell
from softdot.json_files import plain
from softdot.studio.work.press import TaskProgress

SHOWN = 600
"""Samples of a signal in the page, of each two the smallest and largest of a stretch."""


def read(folder: str) -> dict[str, Any]:
    """Name, drive, signals (decimated) and phases of every run. InputError."""
    from diagnose.signals.phases import PHASES
    from softdot.config.rig import load_rig
    from softdot.studio.work.design import refuse_files_outside

    rig = load_rig(folder)
    if rig.config is not None:
        refuse_files_outside(rig.config)
    runs = []
    for run, phases in zip(rig.recording.runs, rig.recording.phases, strict=True):
        chosen = _extremes(run.drive_values)
        runs.append(
            {
                "label": run.label, "drive": run.drive, "samples": len(run.time_s), "time_s": run.time_s[chosen],
                "channels": {name: values[chosen] for name, values in run.channels.items()},
                "phases": [
                    {"name": PHASES[kind], "from_s": run.time_s[first], "to_s": run.time_s[last - 1]}
                    for press in phases.presses
                    for kind, (first, last) in enumerate(zip(press.bounds[:-1], press.bounds[1:], strict=True))
                    if last > first
                ],
            }
        )  # fmt: skip
    kind = "a segment" if rig.config is not None else "a coupon" if rig.recording.specimen else "an unknown geometry"
    return dict(plain({"runs": runs, "of": kind, "warnings": list(rig.recording.warnings)}))


def _extremes(values: Any) -> Any:
    """Indices of the least and largest sample of each of SHOWN / 2 stretches, in order."""
    if len(values) <= SHOWN:
        return np.arange(len(values))
    pieces = np.array_split(np.arange(len(values)), SHOWN // 2)
    filled = np.nan_to_num(values)
    found = {int(at) for piece in pieces for at in (piece[filled[piece].argmin()], piece[filled[piece].argmax()])}
    return np.array(sorted(found | {0, len(values) - 1}))


def diagnose(folder: str, out: str, quick: bool, tell: Tell) -> dict[str, Any]:
    """As `softdot diagnose`; quick : without runs by the full model. The verdict, its pictures and improved.toml."""
    from softdot.diagnosis.folder import Options, run_diagnosis

    place = Path(out) / "diagnosis"
    found = run_diagnosis(Path(folder), place, Options(full_model_s=0.0) if quick else Options(), TaskProgress(tell))
    improved = place / "improved.toml"
    archive = shutil.make_archive(str(Path(out) / "diagnosis"), "zip", out, "diagnosis")
    return {
        "said": found["summary"], "grade": found["grade"], "warnings": found["warnings"],
        "improved": improved.read_text("utf-8") if improved.exists() else None,
        "plots": {path.stem: str(path) for path in sorted((place / "plots").glob("*.png"))},
        "file": archive, "page": str(place / "report.html"),
    }  # fmt: skip
