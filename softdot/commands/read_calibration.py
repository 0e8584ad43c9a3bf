"""softdot read --calibrate: what the voltages of a known line tell of a real sensor, in calibration.json."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.errors import InputError
from softdot.console import GOOD, only_the_summary_on_stdout, show
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.reading.learned_kernel.kernel_file import is_learned_kernel
from softdot.version import installed_version

if TYPE_CHECKING:
    from argparse import Namespace

    from softdot.config.schema import Config

CALIBRATION = Product("softdot-calibration/1", "calibration.json", frozenset({"calibration.json"}))


def run_calibrate(
    recording: Path,
    text: str,
    kernel_folder: Path,
    out: Path,
    config: Config | None = None,
    table: str | None = None,
    standard: str | None = None,
) -> dict[str, Any]:
    """Calibrate the sensor of a kernel by a recording of a known text into the folder out, and return what
    calibration.json says. InputError, before anything is written, where they do not fit together.
    """
    from softdot.reading.calibration import calibrate
    from softdot.reading.cells import cells_of
    from softdot.reading.conditions import standard_of
    from softdot.reading.kernels import electronics_of, open_kernel, readout_of
    from softdot.reading.recorded_file import read_voltages
    from softdot.reading.voltages import Reader

    cells = cells_of(text, table)
    kernel = open_kernel(kernel_folder, config)
    heard = read_voltages(recording, len(kernel.centres_mm))
    with staged_folder(out, CALIBRATION) as folder:
        behind, physics = electronics_of(kernel, readout_of(kernel, config))
        reader = Reader(kernel, standard_of(kernel, standard), behind, None, physics)
        found = calibrate(reader, heard, cells)
        summary: dict[str, Any] = plain(
            {
                "format": CALIBRATION.format,
                "softdot_version": installed_version(),
                "recording": str(recording),
                "text": text,
                "labels": kernel.about["labels"],
                **found.model_dump(mode="json"),
            }
        )
        write_json(folder / CALIBRATION.summary, summary)
    return summary


def refuse_idle_options(chosen: Namespace) -> None:
    """InputError for a calibration beside what it does not act on."""
    if chosen.calibration is not None:
        if chosen.recording is None:
            raise InputError(f"--calibration = '{chosen.calibration}': acts only with --recording")
        if chosen.learn is not None or is_learned_kernel(chosen.kernel):
            raise InputError(f"--calibration = '{chosen.calibration}': acts only on the kernel of a design")
    if chosen.calibrate is not None:
        for name in ("recording", "study", "conditions", "design", "learn", "preset", "decoders"):
            if getattr(chosen, name):
                raise InputError(f"--{name}: has no part in --calibrate; leave it out")


def command(chosen: Namespace, config: Config | None) -> int:
    """Calibrate by chosen.calibrate into chosen.output. InputError."""
    with only_the_summary_on_stdout():
        summary = run_calibrate(
            Path(chosen.calibrate), chosen.text or "", Path(chosen.kernel), Path(chosen.output), config, chosen.table,
            chosen.standard,
        )  # fmt: skip
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The calibration, a line for each segment, and the path of its file."""
    scale = summary["scale"]
    lines = [
        f"{100.0 * summary['explained_share']:.1f} % of the charges explained; charges {scale['value']:.3f} of the "
        f"kernel's ({scale['low']:.3f} to {scale['high']:.3f}), {summary['width']:.3f} as wide"
    ]
    rows = zip(summary["labels"], summary["order"], summary["polarity"], summary["gain"], strict=True)
    for number, (label, lead, sign, gain) in enumerate(rows, 1):
        told = "dead" if number in summary["dead"] else (
            f"gain {gain['value']:.3f} ({gain['low']:.3f} to {gain['high']:.3f})"
            f"{', polarity turned' if sign < 0 else ''}"
        )  # fmt: skip
        lines.append(f"{label}: lead {lead}, {told}")
    return "\n".join([*lines, f"{output}/{CALIBRATION.summary}"])
