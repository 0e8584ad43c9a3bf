"""Letters that a real finger touched: python -m benchmarks.real_braille DATA OUT.

DATA holds open.npz, touches as softdot read --learn takes them, and folds.json with inner_folds_unseen, lists of
letters that are left out together, and few_shot_train_rows, rows to train on by their number a letter. Rates, with the
resting values and without, and how far stated probabilities are from the rates, are printed and written to OUT.
"""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from softdot.json_files import write_json
from softdot.progress import Untold
from softdot.reading.cells import DOTS, KINDS_OF_CELL
from softdot.reading.learned_kernel.answers import answer_touches
from softdot.reading.learned_kernel.learning import learn_kernel
from softdot.reading.learned_kernel.touches import Touches, letter_cells, load_touches

FIVE, DRAWS = 5, 20
"""Touches that are read together, and draws of so many for each letter."""


@dataclass
class Tally:
    """Probabilities (n, 64) of touches, or of five together, beside their cells (n,)."""

    probability: list[Any]
    cells: list[Any]

    def add(self, probability: Any, cells: Any) -> None:
        """Append some."""
        self.probability.extend(probability)
        self.cells.extend(cells)


def calibration(probability: Any, cells: Any, bins: int = 10) -> dict[str, float]:
    """Share of those stated at 0.9 and above, of them right, and the expected calibration error of all."""
    top, right = probability.max(axis=1), probability.argmax(axis=1) == cells
    place = np.minimum((bins * top).astype(int), bins - 1)
    error = sum(
        np.mean(place == one) * abs(top[place == one].mean() - right[place == one].mean()) for one in set(place)
    )
    stated = top >= 0.9
    return {
        "stated": float(stated.mean()),
        "stated_right": float(right[stated].mean()) if stated.any() else float("nan"),
        "calibration_error": float(error),
    }


def rates(tally: Tally) -> dict[str, float]:
    """Shares of letters, of cells and of dots that are right, and the calibration."""
    probability, cells = np.array(tally.probability), np.array(tally.cells)
    letters = np.array(sorted(letter_cells().values()))
    first = probability.argmax(axis=1)
    return {
        "letters": float(np.mean(letters[probability[:, letters].argmax(axis=1)] == cells)),
        "cells": float(np.mean(first == cells)),
        "dots": float(np.mean((first ^ cells)[:, None] >> np.arange(DOTS) & 1 == 0)),
        **calibration(probability, cells),
    }


def unseen_letters(touches: Touches, folds: list[list[str]], keep_rest: bool) -> dict[str, dict[str, float]]:
    """Rates of letters that training has not met, one touch and five of one cell together."""
    assert touches.cells is not None
    one, five = Tally([], []), Tally([], [])
    random = np.random.default_rng(0)
    for fold in folds:
        out = np.isin(touches.cells, [letter_cells()[letter] for letter in fold])
        kernel = learn_kernel(touches.part(np.flatnonzero(~out)), keep_rest, Untold())
        asked = touches.part(np.flatnonzero(out))
        one.add(answer_touches(kernel, asked, "all").probability, asked.cells)
        rows = [
            random.choice(np.flatnonzero(touches.cells == letter_cells()[letter]), FIVE, replace=False)
            for letter in fold
            for _ in range(DRAWS)
        ]
        together = np.repeat(np.arange(len(rows)), FIVE)
        drawn = Touches(
            touches.taxels[np.concatenate(rows)], touches.sampling_Hz, touches.cells[np.concatenate(rows)],
            together=together,
        )  # fmt: skip
        five.add(
            [row for _, _, row in answer_touches(kernel, drawn, "all").together], [touches.cells[i[0]] for i in rows]
        )
    return {"unseen letters, one touch": rates(one), "unseen letters, five touches": rates(five)}


def seen_letters(touches: Touches, rows_by_count: dict[str, list[int]], keep_rest: bool) -> dict[str, dict[str, float]]:
    """Rates of the other touches of letters of which some were learned."""
    found = {}
    for count, rows in rows_by_count.items():
        kernel = learn_kernel(touches.part(np.array(rows)), keep_rest, Untold())
        asked = touches.part(np.setdiff1d(np.arange(len(touches.taxels)), rows))
        tally = Tally([], [])
        tally.add(answer_touches(kernel, asked, "all").probability, asked.cells)
        found[f"seen letters, {count} learned of each"] = rates(tally)
        among = answer_touches(kernel, asked, "learned").probability
        found[f"seen letters, {count} learned of each, among learned"] = rates(Tally([*among], [*asked.cells]))
    return found


def main() -> None:
    """Print the table and write it."""
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    data, out = Path(sys.argv[1]), Path(sys.argv[2])
    touches = load_touches(data / "open.npz")
    folds = json.loads((data / "folds.json").read_text("utf-8"))
    table = {}
    for keep_rest in (False, True):
        told = "raw" if keep_rest else "rest removed"
        for name, row in (
            *unseen_letters(touches, folds["inner_folds_unseen"], keep_rest).items(),
            *seen_letters(touches, folds["few_shot_train_rows"], keep_rest).items(),
        ):
            table[f"{name}, {told}"] = row
            print(
                f"{name}, {told}: " + ", ".join(f"{key} {100 * value:.1f} %" for key, value in row.items()), flush=True
            )
    out.mkdir(parents=True, exist_ok=True)
    write_json(out / "real_braille.json", table)


if __name__ == "__main__":
    assert KINDS_OF_CELL == 2**DOTS
    main()
