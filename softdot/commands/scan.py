"""softdot scan: a dot for the configuration from a scanned surface."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from softdot.console import GOOD, only_the_summary_on_stdout, show


def command(chosen: Namespace) -> int:
    """Fit a profile to the surface in chosen.scan and write it into chosen.output. InputError."""
    from softdot.progress import progress_of
    from softdot.scanned_dot.folder import write_scan

    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = write_scan(Path(chosen.scan), Path(chosen.output), progress)
    show(summary, chosen, _short_text)
    return GOOD


def _short_text(summary: dict[str, Any], output: str) -> str:
    """Sizes, deviations, and the lines that a configuration needs."""
    return "\n".join(
        [
            f"height {summary['height_mm']:.4g} mm, base radius {summary['base_radius_mm']:.4g} mm",
            f"from a surface of revolution {1e3 * summary['deviation_rms_mm']:.2g} µm (root mean square), "
            f"95 % within {1e3 * summary['deviation_95_mm']:.2g} µm; "
            f"the plate is rough by {1e3 * summary['plate_roughness_mm']:.2g} µm",
            f'[dot]\nshape = "profile"\nprofile_csv = "{output}/profile.csv"',
        ]
    )
