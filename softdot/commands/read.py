"""softdot read: a line of Braille under an array, its voltages, and the text that decoders read from them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdot.console import GOOD, INTERRUPTED, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.json_files import plain, write_json
from softdot.log import warn
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.version import installed_version

if TYPE_CHECKING:
    from argparse import Namespace

    from softdot.arrays.kernel import ArrayKernel
    from softdot.braille_text.words import Words
    from softdot.config.schema import Config
    from softdot.reading.conditions import ReadingConditions
    from softdot.reading.line_reading import LineReading

READING = Product(
    "softdot-reading/1", "reading.json", frozenset({"reading.json", "signals.npz", "signals.png", "report.html"})
)
DEFAULT_DECODERS = "model,threshold,learned"


def run_read(
    text: str | None,
    kernel_folder: Path,
    out: Path,
    conditions: ReadingConditions | None = None,
    config: Config | None = None,
    table: str | None = None,
    decoders: str = DEFAULT_DECODERS,
    recording: Path | None = None,
    calibration: Path | None = None,
    progress: Progress | None = None,
    language: str | None = None,
) -> dict[str, Any]:
    """Read a text with the kernel of a folder into the folder out and return the content of reading.json.

    text : None or empty only with a recording of an unknown text. calibration : of the sensor of a recording. table :
    of liblouis, None for plain English. language : whose words complete what the decoder hand is not certain of, apart
    from the text that is read.
    InputError, before anything is written, for whatever cannot be read.
    """
    from foundation.errors import InputError
    from softdot.reading.calibration_file import load_calibration, widened
    from softdot.reading.cells import cells_of
    from softdot.reading.conditions import ReadingConditions
    from softdot.reading.decoders import named_decoders
    from softdot.reading.kernels import open_kernel, readout_of
    from softdot.reading.language import language_content
    from softdot.reading.line_reading import read_line, reading_content
    from softdot.reading.recorded_file import read_voltages
    from softdot.system_libraries import name_missing_library

    if calibration is not None and recording is None:
        raise InputError(f"calibration = '{calibration}': acts only on a recording")
    progress = progress or Logged()
    with name_missing_library():
        names = named_decoders(decoders)
        words = None if language is None else _words(language, table, names)
        cells = None if recording is not None and not (text or "").strip() else cells_of(text or "", table)
        kernel = open_kernel(kernel_folder, config)
        heard = None if recording is None else read_voltages(recording, len(kernel.centres_mm))
        if calibration is not None and heard is not None:
            known = load_calibration(calibration, kernel)
            kernel, heard = widened(kernel, known.width), known.voltages(heard)
        with staged_folder(out, READING) as folder:
            chosen = conditions or ReadingConditions()
            reading = read_line(kernel, readout_of(kernel, config), chosen, names, progress, cells, heard)
            progress.stage("export")
            summary: dict[str, Any] = plain(
                {
                    **_origin(kernel, table, recording, calibration),
                    **reading_content(reading, text if cells is not None else None, table),
                    **({} if words is None else {"language": language_content(reading.first, words, table)}),
                }
            )
            warn(summary["warnings"])
            _write_reading(reading, summary, folder)
    return summary


def _words(language: str, table: str | None, decoders: list[str]) -> Words:
    """The words that complete what the first decoder reads. InputError where it is another one than HAND."""
    from foundation.errors import InputError
    from softdot.braille_text.words import words_of
    from softdot.reading.decoders import HAND

    if decoders[0] != HAND:
        raise InputError(f"--language = '{language}': acts on what the decoder {HAND} reads; --decoders {HAND}")
    return words_of(language, table)


def _write_reading(reading: LineReading, summary: dict[str, Any], folder: Path) -> None:
    """All files of a reading."""
    import numpy as np

    from export.array.reading_page import write_reading_page
    from export.array.signals import draw_signals
    from softdot.reading.signals import page_signals, signal_arrays

    arrays = signal_arrays(reading)
    with (folder / "signals.npz").open("wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]
    draw_signals(arrays, reading.reader.kernel.about["labels"], folder / "signals.png")
    write_reading_page(folder / "report.html", summary, page_signals(reading))
    write_json(folder / READING.summary, summary)


def _origin(kernel: ArrayKernel, table: str | None, recording: Path | None, calibration: Path | None) -> dict[str, Any]:
    """What reading.json says of the program, the design, and the files that were read."""
    return {
        "format": READING.format,
        "softdot_version": installed_version(),
        "config_hash": kernel.about["config_hash"],
        "table": table,
        "recording": None if recording is None else str(recording),
        "calibration": None if calibration is None else str(calibration),
        "config": kernel.about["config"],
    }


def command(chosen: Namespace) -> int:
    """Read chosen.text into chosen.output, study how far conditions may go, search for a design, or learn and read
    single touches. InputError.
    """
    from foundation.errors import InputError
    from softdot.commands import read_calibration, read_touches
    from softdot.config.loading import load_config
    from softdot.progress import progress_of
    from softdot.reading.conditions import refuse_idle
    from softdot.reading.learned_kernel.kernel_file import is_learned_kernel

    if chosen.text_of_option is not None:
        if chosen.text is not None:
            raise InputError(f"--text = '{chosen.text_of_option}': the text stands before the options already")
        chosen.text = chosen.text_of_option
    read_calibration.refuse_idle_options(chosen)
    of_touches = chosen.learn is not None or is_learned_kernel(chosen.kernel)
    no_line = of_touches or chosen.design or chosen.study or chosen.conditions or chosen.calibrate
    if chosen.language is not None and no_line:
        raise InputError(f"--language = '{chosen.language}': acts only on a line that is read; leave it out")
    if of_touches:
        return read_touches.command(chosen)
    for name in ("keep_rest", "among"):
        if getattr(chosen, name):
            raise InputError(f"{_argument_name(name.replace('_', '-'))}: acts only on touches and a learned kernel")
    if chosen.design is not None:
        return _search_designs(chosen)
    if chosen.kernel is None:
        raise InputError("--kernel is missing: softdot array --kernel writes the folder that a line is read with")
    config = load_config(chosen.config, chosen.set) if chosen.config is not None or chosen.set else None
    if chosen.study or chosen.conditions is not None:
        return _study_conditions(chosen, config)
    is_heard = chosen.recording is not None or chosen.calibrate is not None
    refuse_idle(conditions_of(chosen), _stated_conditions(chosen), is_heard)
    if chosen.calibrate is not None:
        return read_calibration.command(chosen, config)
    recording = None if chosen.recording is None else Path(chosen.recording)
    if recording is not None and chosen.preset is not None:
        raise InputError(f"--preset = '{chosen.preset}': acts only on voltages that are simulated; leave it out")
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = run_read(
            chosen.text, Path(chosen.kernel), Path(chosen.output), conditions_of(chosen), config, chosen.table,
            _decoders(chosen), recording, None if chosen.calibration is None else Path(chosen.calibration), progress,
            chosen.language,
        )  # fmt: skip
    show(summary, chosen, short_text)
    return GOOD if summary["is_certain"] else NOT_CONVERGED


def _study_conditions(chosen: Namespace, config: Config | None) -> int:
    """Study how far conditions may go, into chosen.output; 0, or 130 when interrupted. InputError."""
    from dataclasses import replace

    from foundation.errors import InputError
    from softdot.reading.kernels import open_kernel
    from softdot.reading.study import ReadingStudy, default_axes, load_study
    from softdot.reading.study_run import FOLDER, run_reading_study

    if chosen.recording is not None:
        raise InputError("--recording: a study makes its own voltages; leave it out")
    kernel = open_kernel(Path(chosen.kernel), config)
    base = conditions_of(chosen)
    usual = ReadingStudy(base, default_axes(kernel, base))
    study = usual if chosen.conditions is None else load_study(Path(chosen.conditions), kernel, base)
    if chosen.text:
        study = replace(study, text=chosen.text, table=chosen.table)
    summary = _run_resumable(
        chosen,
        FOLDER,
        lambda progress: run_reading_study(
            study, Path(chosen.kernel), Path(chosen.output), config, chosen.workers, progress, chosen.scheduler
        ),
    )
    if summary is None:
        return INTERRUPTED
    show(summary, chosen, _limits_text)
    return GOOD


def _run_resumable(chosen: Namespace, folder: str, work: Callable[[Progress], dict[str, Any]]) -> dict[str, Any] | None:
    """The result of work; None where it was interrupted, after a sentence that says what is kept in folder."""
    from softdot.progress import progress_of

    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            return work(progress)
    except KeyboardInterrupt:
        if not (Path(chosen.output) / folder).exists():
            raise
        complain(f"interrupted; what was finished is kept in '{chosen.output}', the same command continues")
        return None


def _search_designs(chosen: Namespace) -> int:
    """Search for a design into chosen.output; 0, 3 when none could be solved, 130 when interrupted. InputError."""
    from foundation.errors import InputError
    from softdot.reading.decoders import named_decoders
    from softdot.reading.designs.design_file import load_request
    from softdot.reading.designs.run import FOLDER, AskedReading, run_designs
    from softdot.reading.study import DEFAULT_TEXT

    for name in ("kernel", "config", "recording", "conditions"):
        if getattr(chosen, name) is not None:
            raise InputError(f"--design: makes its own kernels and voltages; leave {_argument_name(name)} out")
    if chosen.study:
        raise InputError("--design: is another search than --study; give one of them")
    decoder = named_decoders(_decoders(chosen))[0]
    request = load_request(Path(chosen.design), chosen.set)
    asked = AskedReading(chosen.text or DEFAULT_TEXT, chosen.table, decoder, conditions_of(chosen))
    summary = _run_resumable(
        chosen,
        FOLDER,
        lambda progress: run_designs(request, asked, Path(chosen.output), chosen.workers, chosen.scheduler, progress),
    )
    if summary is None:
        return INTERRUPTED
    show(summary, chosen, _designs_text)
    if any(one["status"] == "solved" for one in summary["designs"]):
        return GOOD
    complain(f"not one of {len(summary['designs'])} designs could be solved; reasons are in '{chosen.output}'")
    return NOT_CONVERGED


def _argument_name(name: str) -> str:
    return "CONFIG.toml" if name == "config" else f"--{name}"


def conditions_of(chosen: Namespace) -> ReadingConditions:
    """The conditions of the command line, those that it does not state with their defaults. InputError."""
    from softdot.reading.conditions import ReadingConditions

    return ReadingConditions(**{**_preset(chosen), **_stated_conditions(chosen)})


def _stated_conditions(chosen: Namespace) -> dict[str, Any]:
    """The conditions that the command line states, by name."""
    from dataclasses import fields

    from softdot.reading.conditions import ReadingConditions

    given = {one.name: getattr(chosen, one.name, None) for one in fields(ReadingConditions)}
    return {name: value for name, value in given.items() if value is not None}


def _decoders(chosen: Namespace) -> str:
    """The decoders that the command line names, else those of its preset."""
    named: str | None = chosen.decoders
    return named or ("hand" if chosen.preset == "hand" else DEFAULT_DECODERS)


def _preset(chosen: Namespace) -> dict[str, Any]:
    """The conditions of the preset that the command line names."""
    from softdot.reading.conditions import PRESETS

    return dict(PRESETS[getattr(chosen, "preset", None) or "machine"])


def short_text(summary: dict[str, Any], output: str) -> str:
    """The reading in a few lines: text, rates, speed, and the path of the page."""
    lines = [summary["text_read"]]
    if "language" in summary:
        told = summary["language"]
        lines.append(f"with {len(told['completed'])} cells more by words of the language: {told['text']}")
    for name, own in summary["decoders"].items():
        if "character_accuracy" in own:
            share = own["character_accuracy"]
            lines.append(
                f"{name}: {100 * share['value']:.1f} % of {share['of']} characters "
                f"({100 * share['low']:.1f} to {100 * share['high']:.1f}), "
                f"{100 * own['word_accuracy']['value']:.1f} % of words"
            )
    if summary["words_per_minute"] is not None:
        lines.append(f"{summary['words_per_minute']:.3g} words a minute, {summary['cells_per_s']:.3g} cells a second")
    return "\n".join([*lines, f"{output}/report.html"])


def _limits_text(summary: dict[str, Any], output: str) -> str:
    """The limit of each condition, a line each."""
    lines = []
    for name, limit in summary["limits"].items():
        if limit["read_up_to"] is None:
            lines.append(f"{name}: too few characters are read already at the usual value")
        elif limit["fails_at"] is None:
            lines.append(f"{name}: read at {limit['read_up_to']:.4g}, the last value that was tried")
        else:
            why = "cannot be" if limit["refused"] else "no more"
            lines.append(f"{name}: read up to {limit['read_up_to']:.4g}, {why} at {limit['fails_at']:.4g}")
    return "\n".join(
        [f"at least {100 * summary['accuracy']:g} % of the characters:", *lines, f"{output}/reading_study.png"]
    )


def _designs_text(summary: dict[str, Any], output: str) -> str:
    """The design that reads with the least force, and the compared ones, a line each."""
    lines = [f"at least {100 * summary['accuracy']:g} % of {summary['characters']} characters:"]
    for one in summary["designs"]:
        if one["best"] or one["compared"]:
            least = one["least"]
            told = "does not read" if least is None else (
                f"{1e3 * least['mean_force_N']:.3g} mN on average, {1e3 * least['peak_force_N']:.3g} mN at most, "
                f"{least['depth_mm']:.3g} mm deep, crosstalk {least['crosstalk_percent']:.3g} %"
            )  # fmt: skip
            lines.append(f"{one['name']}{' (least force)' if one['best'] else ''}: {told}")
    return "\n".join([*lines, f"{output}/report.html"])
