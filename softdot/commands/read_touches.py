"""softdot read of single touches: a kernel learned from labelled ones, and what it reads in others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdot.console import GOOD, NOT_CONVERGED, only_the_summary_on_stdout, show
from softdot.json_files import plain, write_json
from softdot.log import warn
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.version import installed_version

if TYPE_CHECKING:
    from argparse import Namespace

LEARNED = Product("softdot-learned-kernel/3", "kernel.json", frozenset({"kernel.json", "kernel.npz"}))
TOUCHES = Product("softdot-touches/1", "cells.json", frozenset({"cells.json", "cells.csv", "cells.npz"}))
OF_EVERY_COMMAND = {"command", "output", "json", "quiet", "verbose"}


def run_learn(
    files: list[Path], out: Path, keep_rest: bool = False, progress: Progress | None = None
) -> dict[str, Any]:
    """Learn a kernel from labelled touches into the folder out and return what kernel.json says. InputError."""
    from softdot.reading.learned_kernel.layout import layout_warnings
    from softdot.reading.learned_kernel.learning import learn_kernel
    from softdot.reading.learned_kernel.touches import join_touches, load_touches

    parts, names = [load_touches(path) for path in files], [str(path) for path in files]
    touches = join_touches(parts, names)
    with staged_folder(out, LEARNED) as folder:
        kernel = learn_kernel(touches, keep_rest, progress or Logged())
        kernel.about["warnings"] = [*layout_warnings(parts, names), *kernel.about["warnings"]]
        warn(kernel.about["warnings"])
        kernel.save(folder)
    return {"format": LEARNED.format, **kernel.about}


def run_touches(kernel_folder: Path, recording: Path, out: Path, among: str = "all") -> dict[str, Any]:
    """Read the touches of a file with a learned kernel into the folder out and return what cells.json says.

    among : the cells that may be, "all" 64, "letters" or those "learned". InputError.
    """
    import numpy as np

    from softdot.reading.learned_kernel.answers import answer_touches
    from softdot.reading.learned_kernel.kernel_file import load_learned_kernel
    from softdot.reading.learned_kernel.results import answers_content, write_csv
    from softdot.reading.learned_kernel.touches import load_touches

    kernel = load_learned_kernel(kernel_folder)
    touches = load_touches(recording)
    with staged_folder(out, TOUCHES) as folder:
        answers = answer_touches(kernel, touches, among)
        content = {
            "format": TOUCHES.format,
            "softdot_version": installed_version(),
            "recording": str(recording),
            **answers_content(kernel, touches, answers),
        }
        summary: dict[str, Any] = plain(content)
        warn(summary["warnings"])
        write_csv(folder / "cells.csv", summary["touches"])
        with (folder / "cells.npz").open("wb") as file:
            np.savez_compressed(file, probability=answers.probability, log_score=answers.log_score)
        write_json(folder / TOUCHES.summary, summary)
    return summary


def command(chosen: Namespace) -> int:
    """Learn from chosen.learn, or read chosen.recording with the learned kernel of chosen.kernel. InputError."""
    from foundation.errors import InputError
    from softdot.progress import progress_of

    if chosen.learn is not None:
        _refuse_others(chosen, {"learn", "keep_rest"}, "--learn")
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_learn([Path(one) for one in chosen.learn], Path(chosen.output), chosen.keep_rest, progress)
        show(summary, chosen, learned_text)
        return GOOD
    _refuse_others(chosen, {"kernel", "recording", "among"}, "a learned kernel")
    if chosen.recording is None:
        raise InputError("--recording is missing: a learned kernel reads a file of touches, and makes none itself")
    with only_the_summary_on_stdout():
        summary = run_touches(Path(chosen.kernel), Path(chosen.recording), Path(chosen.output), chosen.among or "all")
    show(summary, chosen, touches_text)
    return GOOD if summary["is_of_the_sensor"] else NOT_CONVERGED


def _refuse_others(chosen: Namespace, known: set[str], beside: str) -> None:
    """InputError for an option of softdot read that has no effect here."""
    from foundation.errors import InputError
    from softdot.command_line.parser import parser

    usual = vars(parser().parse_args(["read", "-o", "OUT"]))
    for name, value in vars(chosen).items():
        if name not in known | OF_EVERY_COMMAND and value != usual[name]:
            told = name if name in ("text", "config") else f"--{name.replace('_', '-')}"
            raise InputError(f"{told} = {value}: has no effect beside {beside}; leave it out")


def learned_text(summary: dict[str, Any], output: str) -> str:
    """What was learned, in a few lines."""
    cells = summary["touches_of_cells"]
    return "\n".join(
        [
            f"{sum(cells.values())} touches of {len(cells)} cells, {summary['channels']} channels, "
            f"resting values {'kept' if summary['rest_kept'] else 'removed'}",
            f"left out while learning and read among all 64: {100 * summary['touches_left_out_read']:.0f} % of touches "
            f"of learned cells, {100 * summary['cells_left_out_read']:.0f} % of those of cells left out whole",
            f"superposition of dots: {100 * summary['share_of_dots']:.0f} % of what sets cells apart; the rest is "
            "statistics of likeness between cells",
            f"{output}/kernel.json",
        ]
    )


def touches_text(summary: dict[str, Any], output: str) -> str:
    """The cells that were read, their rates where they are known, and what share of it is superposition."""
    lines = [summary["cells"]]
    stated = sum(row["answer"] != "?" for row in summary["touches"])
    lines.append(
        f"{stated} of {len(summary['touches'])} touches stated at {summary['stated_at']:g} or above, others '?'"
    )
    if "score" in summary:
        rates = summary["score"]
        lines += [
            f"{name}: {100 * rates[key]['value']:.1f} % of {rates[key]['of']} "
            f"({100 * rates[key]['low']:.1f} to {100 * rates[key]['high']:.1f})"
            for name, key in (("right cells", "cells"), ("right dots", "dots"), ("right of those stated", "stated"))
            if rates[key] is not None
        ]
    lines.append(
        f"superposition of dots alone names the same cell in {100 * summary['dots_alone_agree']:.0f} % of the touches"
    )
    return "\n".join([*lines, f"{output}/cells.csv"])
