"""The folder of a scanned dot: its profile as CSV, a picture of what the profile leaves, and scan.json."""

from pathlib import Path
from typing import Any

import numpy as np

from geometry.dot_scan import ScannedDot, scanned_dot
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.scanned_dot.picture import draw_scan

SCAN = Product("softdot-scan/1", "scan.json", frozenset({"scan.json", "profile.csv", "scan.png"}))
DOUBTED_PERCENT = 5.0
"""Of the height: deviation of one point in twenty above which the dot is hardly a surface of revolution."""


def write_scan(scan: Path, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Fit a dot to the surface in a file and write its profile into the folder out; the content of scan.json.

    InputError.
    """
    progress = progress or Logged()
    with staged_folder(out, SCAN) as folder:
        progress.stage("fit")
        found = scanned_dot(scan)
        progress.stage("write")
        rows = zip(found.profile.radius_mm, found.profile.height_mm - np.array(found.profile.depth_mm), strict=True)
        lines = ["radius_mm,height_mm", *(f"{radius:.6f},{height:.6f}" for radius, height in rows)]
        (folder / "profile.csv").write_text("\n".join(lines) + "\n", "utf-8")
        draw_scan(found, folder / "scan.png")
        summary: dict[str, Any] = plain({"format": SCAN.format, "scan": scan.name, **_numbers(found)})
        write_json(folder / SCAN.summary, summary)
    return summary


def _numbers(found: ScannedDot) -> dict[str, Any]:
    return {
        "height_mm": found.profile.height_mm,
        "base_radius_mm": found.profile.radius_mm[-1],
        "tip_radius_mm": found.profile.tip_radius_mm,
        "deviation_rms_mm": found.deviation_rms_mm,
        "deviation_95_mm": found.deviation_95_mm,
        "out_of_round_mm": found.out_of_round_mm,
        "plate_roughness_mm": found.plate_roughness_mm,
        "plate_tilt_deg": found.tilt_deg,
        "warnings": _warnings(found),
    }


def _warnings(found: ScannedDot) -> list[str]:
    """What is to be doubted, a sentence each."""
    percent = 100.0 * found.deviation_95_mm / found.profile.height_mm
    if percent <= DOUBTED_PERCENT:
        return []
    return [
        f"one point in twenty lies more than {1e3 * found.deviation_95_mm:.2g} µm ({percent:.2g} % of the height) from "
        f"the surface of revolution; its heights along two axes differ by {2e3 * found.out_of_round_mm:.2g} µm, so the "
        "press will be of a rounder dot than this one"
    ]
