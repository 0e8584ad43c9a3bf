"""The reading of a line: a text through the voltages and back, and what reading.json and signals.npz say of it."""

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np

from foundation.arrays import Ints
from foundation.errors import InputError
from softdot.arrays.kernel import ArrayKernel
from softdot.progress import Progress
from softdot.reading.cells import braille, text_of
from softdot.reading.conditions import ReadingConditions, refuse_missing_channels, standard_of, standard_warnings
from softdot.reading.decoders.decoding import Seen, decoded
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.hand import HandTrack
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.kernels import electronics_of
from softdot.reading.line import DotLine, cell_pitch_mm, manufactured_line
from softdot.reading.motion import ArrayPath, array_path, press_times
from softdot.reading.score import scores
from softdot.reading.told_line import cell_content, line_content, track_warnings
from softdot.reading.voltages import Reader, Voltages, record_voltages
from solve.model import Readout

LOG = logging.getLogger(__name__)
MOST_SAMPLES = 1e8
"""Most samples of all segments together: half an hour at 10 kHz of six; they take a gigabyte in some of the steps."""


@dataclass(frozen=True)
class LineReading:
    """A line that was read.

    cells_true (c,) : None where they are not known. line, path : None for a recording. voltages : simulated or
    recorded. decoded : by name of the decoder.
    """

    reader: Reader
    conditions: ReadingConditions
    cells_true: Ints | None
    voltages: Voltages
    line: DotLine | None
    path: ArrayPath | None
    seen: Seen
    decoded: dict[str, DecodedCells]

    @property
    def is_certain(self) -> bool:
        """Whether what was heard is Braille, and no cell is uncertain because the track was lost."""
        return not isinstance(self.seen, HandTrack) or self.seen.is_whole

    @property
    def first(self) -> DecodedCells:
        """The cells of the decoder that was named first."""
        return next(iter(self.decoded.values()))


def read_line(
    kernel: ArrayKernel,
    readout: Readout,
    conditions: ReadingConditions,
    names: list[str],
    progress: Progress,
    cells: Ints | None,
    recording: Voltages | None = None,
) -> LineReading:
    """Simulate the voltages of cells, or take recorded ones, and decode them. InputError.

    Every decoder gets the reader and the voltages alone.
    """
    known = conditions.with_implied_values(kernel)
    refuse_missing_channels(known, len(kernel.centres_mm))
    chosen = standard_of(kernel, known.standard)
    times = press_times(known, cell_pitch_mm(chosen)) if known.mode == "press" else None
    behind, physics = electronics_of(kernel, readout)
    reader = Reader(kernel, chosen, behind, times, physics)
    line: DotLine | None = None
    path: ArrayPath | None = None
    if recording is None:
        assert cells is not None
        _refuse_too_much(known, len(cells), reader)
        progress.stage("simulate")
        random = np.random.default_rng(known.seed)
        line = manufactured_line(cells, chosen, known, random)
        path = array_path(kernel, line, len(cells), chosen, known, random)
        heard = record_voltages(reader, line, path, known, random, lambda done, all_: progress.step(done, all_, ""))
    else:
        heard = recording
    progress.stage("decode")
    seen, found = decoded(reader, heard, names, lambda done: progress.step(done, len(names), names[done - 1]))
    return LineReading(reader, known, cells, heard, line, path, seen, found)


def _refuse_too_much(known: ReadingConditions, cells: int, reader: Reader) -> None:
    """InputError for more samples than MOST_SAMPLES; else their number is logged."""
    travel_mm = cells * cell_pitch_mm(reader.standard)
    seconds = travel_mm / known.speed_mm_per_s if reader.presses is None else cells * reader.presses.period_s
    count = seconds * known.sampling_Hz * len(reader.kernel.centres_mm)
    if count > MOST_SAMPLES:
        raise InputError(
            f"--sampling-Hz = {known.sampling_Hz:g}: {cells} cells take {seconds:.4g} s and {count:.3g} samples "
            f"of all segments, at most {MOST_SAMPLES:.3g} are made; sample slower, move faster or read less"
        )
    LOG.info("%d cells in %.4g s, %.3g samples of all segments", cells, seconds, count)


def reading_content(reading: LineReading, text: str | None, table: str | None) -> dict[str, Any]:
    """The content of reading.json but for format, version and configuration."""
    first, true = reading.first, reading.cells_true
    decoders = {name: _decoder_content(true, found, table) for name, found in reading.decoded.items()}
    own = next(iter(decoders.values()))
    seconds = _duration_s(reading)
    words = len((text_of(first.cells if true is None else true, table)).split())
    count = len(first.cells) if true is None else len(true)
    return {
        "text_true": text,
        "text_of_cells_true": None if true is None else text_of(true, table),
        "cells_true": None if true is None else braille(true),
        "characters": None if true is None else len(text_of(true, table)),
        **own,
        "is_certain": reading.is_certain,
        "decoder": next(iter(decoders)),
        "decoders": decoders,
        "words_per_minute": 60.0 * words / seconds if seconds > 0.0 else None,
        "cells_per_s": count / seconds if seconds > 0.0 else None,
        "duration_s": seconds,
        "conditions": {**reading.conditions.as_dict(), **_readout_conditions(reading.reader.readout)},
        "share_of_time_at_force": None if reading.path is None else reading.path.held,
        "track": _track_content(reading.seen),
        "cells": cell_content(first),
        "kernel": {key: value for key, value in reading.reader.kernel.about.items() if key != "config"},
        "warnings": _warnings(reading),
    }


def _readout_conditions(readout: Readout) -> dict[str, Any]:
    """The stated values of the amplifier, by names for the table of conditions."""
    stated = readout.model_dump(mode="json", exclude_none=True)
    return {f"readout_{name}": value for name, value in stated.items()}


def _decoder_content(true: Ints | None, found: DecodedCells, table: str | None) -> dict[str, Any]:
    """The scores of a decoder, or its text alone where the true cells are not known."""
    if true is not None:
        return scores(true, found.cells, table)
    return {"text_read": text_of(found.cells, table), "cells_read": braille(found.cells)}


def _duration_s(reading: LineReading) -> float:
    """Time from the first cell to the last and through that, s."""
    passed = reading.first.passed_s if reading.path is None else reading.path.reached_s
    if len(passed) < 2:
        presses = reading.reader.presses
        if presses is not None:
            return presses.period_s
        return cell_pitch_mm(reading.reader.standard) / reading.conditions.speed_mm_per_s
    return float(abs(passed[-1] - passed[0]) * len(passed) / (len(passed) - 1))


def _track_content(seen: Seen) -> dict[str, Any] | None:
    """The motion as found from the voltages alone."""
    if isinstance(seen, HandTrack):
        return line_content(seen)
    return vars(seen.posture) if isinstance(seen, Track) else None


def _warnings(reading: LineReading) -> list[str]:
    told = standard_warnings(reading.reader.kernel, reading.reader.standard)
    if isinstance(reading.seen, HandTrack):
        told += track_warnings(reading.seen, reading.reader.kernel.about["labels"])
    held = None if reading.path is None else reading.path.held
    if held is not None and held < 1.0:
        told.append(
            f"the force of {reading.conditions.force_N:g} N was held for {100 * held:.3g} % of the time; else a "
            f"stop held the array at the depth of {reading.conditions.depth_mm:.3g} mm, where the kernel ends for the "
            "highest dot"
        )
    return told
