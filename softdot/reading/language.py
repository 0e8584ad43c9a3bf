"""Cells that a reading left uncertain, completed by the words of a language; what is certain stays as it was read.

Between two certain blanks, or signs that no word has, the cells are words with blanks between them: a word of a list
as often as text has it, or, with the probability UNLISTED, any letters as often as words have them. The probability of
each cell is that of all such lines together, each weighted by what the voltages say of its cells (forward-backward sums
over the places where words end; Rabiner, Proc. IEEE 77 (1989) 257).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from softdot.braille_text.words import Words
from softdot.reading.cells import KINDS_OF_CELL, braille, text_of
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.line_filter.line_reader import CERTAIN

UNLISTED = 0.05
"""Probability of a word that is in no list: a name, a misspelling."""
LEAST_SHARE = 1e-4
"""Probability of a cell that the voltages seem to exclude."""
LONGEST = 24
"""Most cells between two certain signs; more are left as they were read."""
NUMBER_SIGN = 0x3C


@dataclass(frozen=True)
class CompletedCells:
    """cells (c,) : the most likely ones. probability (c,) : of them. completed (c,) : which ones words say for certain
    that voltages alone do not.
    """

    cells: Ints
    probability: Floats
    completed: Bools


def language_content(found: DecodedCells, words: Words, table: str | None) -> dict[str, Any]:
    """What reading.json says of a line with its words: text, and the cells that these complete."""
    assert found.likely is not None
    assert found.shares is not None
    certain = found.cells >= 0
    told = complete(found.likely, found.shares, certain, words, CERTAIN)
    cells = np.where(certain | told.completed, told.cells, -1)
    return {
        "text": text_of(cells, table),
        "cells": braille(cells),
        "completed": [
            {"place": int(n) + 1, "cell": int(told.cells[n]), "probability": round(float(told.probability[n]), 6)}
            for n in np.flatnonzero(told.completed)
        ],
    }


def complete(likely: Ints, shares: Floats, certain: Bools, words: Words, least: float) -> CompletedCells:
    """Cells (c,) with what words say of the uncertain ones.

    shares (c, 64) : probability of each cell by the voltages. least : probability above which a cell is completed. Of
    a line without a certain cell, which is no Braille or no text, words would invent all, and complete nothing.
    """
    cells, probability = likely.copy(), shares[np.arange(len(likely)), np.maximum(likely, 0)]
    sharp = np.eye(KINDS_OF_CELL)[np.maximum(likely, 0)]
    known = np.where(certain[:, None], sharp, np.maximum(shares, LEAST_SHARE))
    apart = certain & (words.letters[np.maximum(likely, 0)] == 0.0)
    for begin, end in _stretches(apart):
        if certain[begin:end].all() or end - begin > LONGEST or (begin and likely[begin - 1] == NUMBER_SIGN):
            continue
        found = _marginals(known[begin:end], words)
        best = found.argmax(axis=1)
        unsure = ~certain[begin:end]
        cells[begin:end][unsure] = best[unsure]
        probability[begin:end][unsure] = found.max(axis=1)[unsure]
    return CompletedCells(cells, probability, ~certain & (probability >= least) & certain.any())


def _stretches(apart: Bools) -> list[tuple[int, int]]:
    """First cell and one past the last of each stretch between blanks and signs."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], apart, [True]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _marginals(known: Floats, words: Words) -> Floats:
    """Probability (n, 64) of each cell of words with blanks between them, from that by the voltages (n, 64)."""
    count = len(known)
    spans = {(j, k): _span(known[j:k], words) for j in range(count) for k in range(j + 1, count + 1)}
    weight = {place: one[0] for place, one in spans.items()}
    weight |= {(j, j): 1.0 for j in range(count + 1)}  # no word, between two blanks
    ends, begins = np.zeros(count + 1), np.zeros(count + 1)  # sums over lines up to a word's end, from a word's begin
    for k in range(count + 1):
        ends[k] = weight[0, k] + sum(ends[j] * known[j, 0] * weight[j + 1, k] for j in range(k))
    for j in range(count, -1, -1):
        begins[j] = weight[j, count] + sum(weight[j, k] * known[k, 0] * begins[k + 1] for k in range(j, count))
    found = np.zeros_like(known)
    for j in range(count):
        found[j, 0] += ends[j] * known[j, 0] * begins[j + 1]
    for (j, k), (_, own) in spans.items():
        before = 1.0 if j == 0 else ends[j - 1] * known[j - 1, 0]
        after = 1.0 if k == count else known[k, 0] * begins[k + 1]
        found[j:k] += before * after * own
    return np.asarray(found / found.sum(axis=1, keepdims=True))


def _span(known: Floats, words: Words) -> tuple[float, Floats]:
    """Sum of the weights of all words that stand in some cells, and for each cell (n, 64) the part with it."""
    letters = known * words.letters
    each = letters.sum(axis=1)
    whole = UNLISTED * float(np.prod(each))
    own = whole * letters / np.maximum(each, np.finfo(float).tiny)[:, None]
    listed = words.by_length.get(len(known))
    if listed is None:
        return whole, own
    cells, share = listed
    weight = (1.0 - UNLISTED) * share * np.prod(known[np.arange(len(known)), cells], axis=1)
    for place in range(len(known)):
        own[place] += np.bincount(cells[:, place], weight, KINDS_OF_CELL)
    return whole + float(weight.sum()), own
