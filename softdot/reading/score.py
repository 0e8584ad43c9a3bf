"""The score of a reading: cells and characters aligned with the true ones, rates with their intervals, confusions.

Aligned by the least number of insertions, deletions and substitutions (Levenshtein, Soviet Physics Doklady 10 (1966)
707), within a band around the diagonal: a track slips by a few cells, not by hundreds.
"""

from collections import Counter
from collections.abc import Hashable, Sequence
from typing import Any

from diagnose.statistics.proportions import wilson_interval
from foundation.arrays import Ints
from softdot.reading.cells import DOTS, braille, text_of

BAND_CELLS = 40
"""Half width of the band around the diagonal."""
Pair = tuple[int | None, int | None]


def align(true: Sequence[Hashable], read: Sequence[Hashable]) -> list[Pair]:
    """Pairs of places in both sequences that correspond, in order; None for a place that the other sequence lacks."""
    half = BAND_CELLS + abs(len(true) - len(read))
    far = len(true) + len(read) + 1
    cost: list[dict[int, int]] = [{j: j for j in range(min(half, len(read)) + 1)}]
    for i, one in enumerate(true, 1):
        above = cost[-1]
        row: dict[int, int] = {}
        for j in range(max(0, i - half), min(len(read), i + half) + 1):
            new = above.get(j, far) + 1
            if j:
                new = min(new, row.get(j - 1, far) + 1, above.get(j - 1, far) + (one != read[j - 1]))
            row[j] = new
        cost.append(row)
    return _trace_back(cost, true, read, far)


def _trace_back(cost: list[dict[int, int]], true: Sequence[Hashable], read: Sequence[Hashable], far: int) -> list[Pair]:
    """The pairs along the cheapest way through the table of costs."""
    i, j = len(true), len(read)
    pairs: list[Pair] = []
    while i or j:
        here = cost[i][j]
        if i and j and here == cost[i - 1].get(j - 1, far) + (true[i - 1] != read[j - 1]):
            i, j = i - 1, j - 1
            pairs.append((i, j))
        elif i and here == cost[i - 1].get(j, far) + 1:
            i -= 1
            pairs.append((i, None))
        else:
            j -= 1
            pairs.append((None, j))
    return pairs[::-1]


def rate(true: Sequence[Hashable], read: Sequence[Hashable]) -> dict[str, Any]:
    """Share of the elements that was read, with Wilson's 95 % interval; an added element counts as an error too."""
    pairs = align(true, read)
    errors = sum(i is None or j is None or true[i] != read[j] for i, j in pairs)
    right = max(0, len(true) - errors)
    low, high = wilson_interval(right, len(true))
    return {"value": right / len(true), "low": low, "high": high, "right": right, "of": len(true)}


def scores(true: Ints, read: Ints, table: str | None) -> dict[str, Any]:
    """Text read, rates of cells, characters and words, confusions, and errors by the number of the dot.

    Characters and words are compared with the text of the true cells: where two signs have the same cells, that is no
    error of the reader.
    """
    written, found = text_of(true, table), text_of(read, table)
    cells, said = [int(one) for one in true], [int(one) for one in read]
    pairs = align(cells, said)
    wrong = Counter((cells[i], said[j]) for i, j in pairs if i is not None and j is not None and cells[i] != said[j])
    missed, false = [0] * DOTS, [0] * DOTS
    for i, j in pairs:
        own, other = 0 if i is None else cells[i], 0 if j is None or said[j] < 0 else said[j]
        for dot in range(DOTS):
            missed[dot] += (own & ~other) >> dot & 1
            false[dot] += (other & ~own) >> dot & 1
    return {
        "text_read": found,
        "cells_read": braille(read),
        "cell_accuracy": rate(cells, said),
        "character_accuracy": rate(written, found),
        "word_accuracy": rate(written.split() or [written], found.split()),
        "confusion": [{"true": braille([a]), "read": braille([b]), "count": n} for (a, b), n in wrong.most_common()],
        "missed_dots": {str(dot + 1): missed[dot] for dot in range(DOTS)},
        "false_dots": {str(dot + 1): false[dot] for dot in range(DOTS)},
    }
