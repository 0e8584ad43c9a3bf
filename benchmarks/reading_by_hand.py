"""Lines read under the conditions of a hand: characters, and how far stated probabilities are to be believed.

    python -m benchmarks.reading_by_hand KERNEL [TRUE ...] [--characters 200] [--seed 1000] [--rows NAME,NAME] [--words]

KERNEL is the folder of softdot array --kernel that the reader knows; TRUE are folders of other sensors that make the
voltages, one line after the other; without one KERNEL makes them. "made" stands for the kernel of the tests, and
"made-other" for one whose charges are 0.8 of it, 5 % wider, with more crosstalk and interaction. Every row has seeds
of its own from --seed on. Characters are right where the most likely cells say so; "certain" is the share of cells
stated at 0.9 or above, and "right of these" the share of them that is right. A second table compares stated
probabilities of all rows with shares that are right. With --words a last line says what English words make of the
cells below 0.9: how many they complete, how many of these rightly, and how many words have a completed cell that is
wrong, that is, are invented.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.statistics.proportions import wilson_interval
from foundation.arrays import Ints
from softdot.arrays.kernel import ArrayKernel, load_kernel
from softdot.braille_text.words import words_of
from softdot.reading.cells import cells_of, text_of
from softdot.reading.conditions import ReadingConditions, standard_of
from softdot.reading.decoders.hand import HandTrack, track_hand
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.language import complete
from softdot.reading.line import manufactured_line
from softdot.reading.line_filter.line_reader import CERTAIN
from softdot.reading.motion import array_path
from softdot.reading.score import align, rate
from softdot.reading.voltages import Reader, Voltages, record_voltages
from solve.model import Readout

TEXT = (
    "alice was beginning to get very tired of sitting by her sister on the bank, and of having nothing to do: once or "
    "twice she had peeped into the book her sister was reading, but it had no pictures or conversations in it; the "
    "hot day made her feel very sleepy and stupid, whether the pleasure of making a daisy chain would be worth the "
    "trouble of getting up and picking the daisies, when suddenly a white rabbit with pink eyes ran close by her"
)
LINE_CHARACTERS = 40
EDGES = (0.5, 0.7, 0.9, 0.99, 0.999)
"""Of the groups of stated probabilities."""
HAND = {"speed_mm_per_s": 40.0, "speed_cv": 0.2, "speed_time_s": 0.5}
ALL = {"pauses": 2, "ways_back": 2, "wander_mm": 0.3, "skew_deg": 0.57, "hum_mV": 20.0, "hum_drift_Hz": 0.05,
       "hum_third": 0.2, "gain_scatter": 0.2}  # fmt: skip
ROWS: dict[str, dict[str, Any]] = {
    "constant speed": {"speed_mm_per_s": 40.0},
    "cv 10 %, 2 s": {**HAND, "speed_cv": 0.1, "speed_time_s": 2.0},
    "cv 20 %, 0.5 s (base)": HAND,
    "cv 30 %, 0.3 s": {**HAND, "speed_cv": 0.3, "speed_time_s": 0.3},
    "two pauses": {**HAND, "pauses": 2},
    "two ways back": {**HAND, "ways_back": 2},
    "right to left": {**HAND, "leftward": True},
    "wander 0.3 mm": {**HAND, "wander_mm": 0.3},
    "skew 0.57 deg": {**HAND, "skew_deg": 0.57},
    "hum 20 mV, 45 to 65 Hz": {**HAND, "hum_mV": 20.0, "hum_Hz": (45.0, 65.0), "hum_drift_Hz": 0.05, "hum_third": 0.2},
    "gains 20 %": {**HAND, "gain_scatter": 0.2},
    "one dead channel": {**HAND, "dead_channel": (1, 6)},
    "all polarities turned": {**HAND, "reversed_all": True},
    "contact lost for 0.2 s": {**HAND, "contact_losses": 1},
    "yaw 5 deg": {**HAND, "yaw_deg": 5.0},
    "offset 0.7 mm": {**HAND, "offset_mm": 0.7},
    "30 % worn by 0.1 mm": {**HAND, "worn": 0.3},
    "slow drift of 30 mV": {**HAND, "drift_mV": 30.0},
    "10 mm/s": {**HAND, "speed_mm_per_s": 10.0},
    "100 mm/s": {**HAND, "speed_mm_per_s": 100.0},
    "all at once": {**HAND, **ALL, "hum_Hz": (45.0, 65.0)},
    "all at once, leftward": {**HAND, **ALL, "hum_Hz": (45.0, 65.0), "leftward": True},
    "two channels exchanged": {**HAND, "swapped_channel": (1, 6)},
}
"""Conditions of each row; of a pair one value in between, whole where both ends are."""


def other_sensor(kernel: ArrayKernel, charge: float = 0.8, wide: float = 1.05, more: float = 1.2) -> ArrayKernel:
    """A sensor whose charges are a share of the kernel's, over wider places, with more interaction of dots."""
    return replace(kernel, charge_pC=charge * kernel.charge_pC, x_mm=wide * kernel.x_mm, y_mm=wide * kernel.y_mm,
                   sinking_mm=more * kernel.sinking_mm)  # fmt: skip


def kernel_named(name: str) -> ArrayKernel:
    """The kernel of a folder, or one of those that no solver made."""
    if not name.startswith("made"):
        return load_kernel(Path(name))
    from tests.softdot.reading.made_kernel import made_kernel

    return made_kernel() if name == "made" else other_sensor(made_kernel(interaction=1.2, crosstalk=0.08))


def drawn(conditions: dict[str, Any], random: np.random.Generator) -> dict[str, Any]:
    """The conditions with one value for each pair."""
    found = {}
    for name, value in conditions.items():
        if isinstance(value, tuple):
            low, high = value
            value = int(random.integers(low, high + 1)) if isinstance(low, int) else float(random.uniform(low, high))
        found[name] = value
    return found


def line_of_words(random: np.random.Generator) -> str:
    """Some words of the text in a row, about a line long."""
    words = TEXT.split()
    begin = int(random.integers(0, len(words) - 12))
    found = ""
    for word in words[begin:]:
        if len(found) + len(word) > LINE_CHARACTERS:
            break
        found += f" {word}"
    return found.strip()


def heard_line(true: ArrayKernel, known: ArrayKernel, cells: np.ndarray, given: dict[str, Any], seed: int) -> Any:
    """The reader that knows one kernel, and the voltages that another sensor gives."""
    conditions = ReadingConditions(seed=seed, **given).with_implied_values(true)
    chosen, random = standard_of(true, None), np.random.default_rng(seed)
    line = manufactured_line(cells, chosen, conditions, random)
    path = array_path(true, line, len(cells), chosen, conditions, random)
    readout = Readout(input_resistance_MOhm=10.0)
    heard = record_voltages(Reader(true, chosen, readout), line, path, conditions, random)
    return Reader(known, chosen, readout), heard


class Completed:
    """Cells that English words complete, counted over all lines."""

    def __init__(self) -> None:
        self.uncertain, self.completed, self.right, self.words, self.invented = 0, 0, 0, 0, 0

    def add(self, track: HandTrack, true: Ints) -> None:
        """Count those of a line; true (c,) : its cell at each place of the track, -1 where it has none."""
        certain = track.probability >= CERTAIN
        told = complete(track.cells, track.shares, certain, words_of("en"), CERTAIN)
        wrong = told.completed & (told.cells != true)
        word = np.cumsum(true == 0)
        self.uncertain += int((~certain).sum())
        self.completed += int(told.completed.sum())
        self.right += int((told.completed & ~wrong).sum())
        self.words += int(word[-1]) + 1
        self.invented += len(np.unique(word[wrong]))

    def __str__(self) -> str:
        return (
            f"words complete {self.completed} of {self.uncertain} uncertain cells, {self.right} rightly; "
            f"{self.invented} of {self.words} words are invented"
        )


def read_one(
    reader: Reader, heard: Voltages, cells: np.ndarray, stated: list[tuple[float, bool]], words: Completed | None
) -> dict[str, float]:
    """Characters and certain cells of one line; stated takes the probability of each cell, and whether it is right."""
    begun = time.process_time()
    text = text_of(cells)
    found: dict[str, float] = {"of": len(text), "right": 0, "certain": 0, "certain_right": 0, "cells": 0, "lost": 0}
    found["seconds"] = float(np.ptp(heard.time_s))
    try:
        track = track_hand(reader, heard)
    except NoDotError:
        return {**found, "cpu_s": time.process_time() - begun}
    found["cpu_s"] = time.process_time() - begun
    found["right"] = rate(text, text_of(track.cells))["right"]
    partner = {j: i for i, j in align([int(c) for c in cells], [int(c) for c in track.cells]) if j is not None}
    right = np.array([partner[j] is not None and cells[partner[j]] == one for j, one in enumerate(track.cells)])
    certain = track.probability >= 0.9
    found |= {"certain": int(certain.sum()), "certain_right": int((certain & right).sum()), "cells": len(right)}
    found["lost"] = track.report.lost
    stated += zip(track.probability, right, strict=True)
    if words is not None:
        words.add(track, np.array([-1 if partner[j] is None else cells[partner[j]] for j in range(len(right))]))
    return found


def row(
    conditions: dict[str, Any], known: ArrayKernel, true: list[ArrayKernel], characters: int, seed: int,
    stated: list[tuple[float, bool]], words: Completed | None,
) -> str:  # fmt: skip
    """The figures of one row."""
    found: list[dict[str, float]] = []
    while sum(one["of"] for one in found) < characters:
        own = seed + len(found)
        random = np.random.default_rng(own)
        cells = cells_of(line_of_words(random))
        reader, heard = heard_line(true[len(found) % len(true)], known, cells, drawn(conditions, random), own)
        found.append(read_one(reader, heard, cells, stated, words))
    total = {name: sum(one[name] for one in found) for name in found[0]}
    low = 100.0 * wilson_interval(int(total["right"]), int(total["of"]))[0]
    sure = 100.0 * total["certain_right"] / max(total["certain"], 1)
    return (
        f"{int(total['right'])} of {int(total['of'])} | {100 * total['right'] / total['of']:.1f} | {low:.1f} | "
        f"{100 * total['certain'] / max(total['cells'], 1):.1f} | {sure:.1f} | "
        f"{int(total['lost'])} | "
        f"{total['cpu_s'] / total['seconds']:.2f}"
    )


def reliability(stated: list[tuple[float, bool]]) -> str:
    """Stated probabilities beside shares that are right, and the expected calibration error."""
    told, right = np.array(stated, dtype=np.float64).T
    group = np.digitize(told, EDGES)
    lines, error = ["| stated | cells | mean stated % | right % |", "|---|---|---|---|"], 0.0
    for number in np.unique(group):
        own = group == number
        low, high = (0.0, *EDGES)[number], (*EDGES, 1.0)[number]
        lines.append(
            f"| {low:g} to {high:g} | {own.sum()} | {100 * told[own].mean():.2f} | {100 * right[own].mean():.2f} |"
        )
        error += abs(told[own].mean() - right[own].mean()) * own.mean()
    return "\n".join([*lines, f"expected calibration error {error:.4f}"])


def main() -> None:
    """Print the table."""
    ask = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    ask.add_argument("kernel")
    ask.add_argument("true", nargs="*")
    ask.add_argument("--characters", type=int, default=200)
    ask.add_argument("--seed", type=int, default=1000)
    ask.add_argument("--rows")
    ask.add_argument("--words", action="store_true")
    chosen = ask.parse_args()
    known = kernel_named(chosen.kernel)
    true = [kernel_named(name) for name in chosen.true] or [known]
    print("| condition | right | % | at least % | certain % | right of these % | lost | s per s |")
    print("|---|---|---|---|---|---|---|---|")
    stated: list[tuple[float, bool]] = []
    words = Completed() if chosen.words else None
    for number, (name, conditions) in enumerate(ROWS.items()):
        if chosen.rows is None or any(part in name for part in chosen.rows.split(",")):
            seed = chosen.seed + 100 * number
            print(f"| {name} | {row(conditions, known, true, chosen.characters, seed, stated, words)} |", flush=True)
    print(reliability(stated), flush=True)
    if words is not None:
        print(words, flush=True)


if __name__ == "__main__":
    main()
