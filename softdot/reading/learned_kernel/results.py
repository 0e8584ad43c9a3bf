"""What a learned kernel says of touches, as the content of cells.json and cells.csv."""

import csv
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.statistics.proportions import wilson_interval
from foundation.arrays import Bools, Floats, Ints
from softdot.reading.cells import DOTS, braille
from softdot.reading.learned_kernel.answers import TouchAnswers
from softdot.reading.learned_kernel.kernel_file import LearnedKernel
from softdot.reading.learned_kernel.touches import Touches, letter_of

BEST_CELLS, STATED_AT = 5, 0.9
"""Cells that are listed for each touch, and the least probability at which the first of them is stated."""
UNKNOWN = "?"


def answers_content(kernel: LearnedKernel, touches: Touches, answers: TouchAnswers) -> dict[str, Any]:
    """The answer to each touch, the rates where the letters are known, and what the kernel says of itself."""
    rows = [
        {"touch": number, **_cell_content(row), "unlike": bool(unlike)}
        for number, (row, unlike) in enumerate(zip(answers.probability, answers.unlike, strict=True))
    ]
    for row in rows:
        row["answer"] = UNKNOWN if row["unlike"] or answers.foreign else row["answer"]
    if touches.cells is not None:
        for row, cell in zip(rows, touches.cells, strict=True):
            row["true"] = braille([int(cell)])
    together = [{"together": number, "touches": count, **_cell_content(row)} for number, count, row in answers.together]
    for row in together if answers.foreign else []:
        row["answer"] = UNKNOWN
    stated = np.array([row["answer"] != UNKNOWN for row in rows])
    scored = {} if touches.cells is None else {"score": _rates(touches.cells, answers.probability, stated)}
    return {
        "cells": "".join(row["answer"] for row in rows),
        "stated_at": STATED_AT,
        "among": answers.among,
        "is_of_the_sensor": not answers.foreign,
        **scored,
        "dots_alone_agree": float(np.mean(answers.by_dots_alone == answers.probability.argmax(axis=1))),
        "touches": rows,
        "together": together,
        "kernel": kernel.about,
        "warnings": answers.warnings,
    }


def _cell_content(probability: Floats) -> dict[str, Any]:
    """The stated cell or UNKNOWN, and the best cells by their probabilities (64,)."""
    order = np.argsort(-probability, kind="stable")[:BEST_CELLS]
    best = [
        {"cell": braille([int(cell)]), "letter": letter_of(int(cell)), "probability": float(probability[cell])}
        for cell in order
    ]
    return {"answer": best[0]["cell"] if probability.max() >= STATED_AT else UNKNOWN, "best": best}


def _rates(true: Ints, probability: Floats, stated: Bools) -> dict[str, Any]:
    """Shares of cells and dots that are right, of stated cells too, with Wilson's intervals."""
    first = probability.argmax(axis=1)
    right = first == true
    dots = (true ^ first)[:, None] >> np.arange(DOTS) & 1 == 0
    return {
        "cells": _rate(right),
        "stated": None if not stated.any() else _rate(right[stated]),
        "dots": _rate(dots),
        "in_best_five": _rate(
            (np.argsort(-probability, axis=1, kind="stable")[:, :BEST_CELLS] == true[:, None]).any(1)
        ),
    }


def _rate(right: Bools) -> dict[str, Any]:
    low, high = wilson_interval(int(right.sum()), right.size)
    return {"value": float(right.mean()), "low": low, "high": high, "right": int(right.sum()), "of": right.size}


def write_csv(path: Path, rows: list[dict[str, Any]]) -> None:
    """Write a line for each touch: its number, the answer, and the best cells with their dots and probabilities."""
    places = range(1, BEST_CELLS + 1)
    head = [f"{name}_{place}" for place in places for name in ("cell", "letter", "probability")]
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["touch", "answer", *head])
        for row in rows:
            best = [one[name] for one in row["best"] for name in ("cell", "letter", "probability")]
            table.writerow([row["touch"], row["answer"], *best])
