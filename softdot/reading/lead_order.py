"""Whether cells look like text, or like text through leads that are dead, or exchanged by rows or columns as a whole.

Such an array reads other cells as certainly as the right one. What tells it is that letters are far more frequent in
text than other cells, in any language: the cells are more usual with the leads exchanged back.
"""

from itertools import permutations

import numpy as np

from foundation.arrays import Ints
from softdot.reading.cells import DOTS, KINDS_OF_CELL, cells_of

LETTERS = {
    "e": 12.7, "t": 9.1, "a": 8.2, "o": 7.5, "i": 7.0, "n": 6.7, "s": 6.3, "h": 6.1, "r": 6.0, "d": 4.3, "l": 4.0,
    "c": 2.8, "u": 2.8, "m": 2.4, "w": 2.4, "f": 2.2, "g": 2.0, "y": 2.0, "p": 1.9, "b": 1.5, "v": 1.0, "k": 0.8,
    "j": 0.2, "x": 0.2, "q": 0.1, "z": 0.1,
}  # fmt: skip
"""Per cent of the letters of English texts (Lewand, Cryptological Mathematics, 2000)."""
LETTERS_SHARE = 0.85
"""Of the cells with dots, assumed; the others share the rest alike."""
LEAST_CELLS = 10
"""With dots from which a row without any is told."""
LEAST_NATS, LEAST_NATS_A_CELL, LIKE_TEXT = 12.0, 0.3, -3.8
"""Log-likelihood by which cells must be more usual in another order, in all and for each, and least one of a cell in
that order: of text it is -3.2, of cells at random below -5.
"""


def likelier_order(cells: Ints) -> str | None:
    """How leads are exchanged, in words, where cells (c,) with dots are far more usual so; else None."""
    seen = cells[cells > 0]
    if len(seen) == 0:
        return None
    usual = _log_shares()
    gains = {words: float((usual[order[seen]] - usual[seen]).sum()) for words, order in _orders().items()}
    best = max(gains, key=lambda words: gains[words])
    like_text = gains[best] + float(usual[seen].sum()) > LIKE_TEXT * len(seen)
    return best if like_text and gains[best] > max(LEAST_NATS, LEAST_NATS_A_CELL * len(seen)) else None


def silent_rows(cells: Ints) -> list[int]:
    """Rows, from 1, that have no dot in any of LEAST_CELLS cells (c,) or more, as text never has it."""
    seen = cells[cells > 0]
    if len(seen) < LEAST_CELLS:
        return []
    return [row + 1 for row in range(3) if not (seen & (0b001001 << row)).any()]


def _log_shares() -> np.ndarray:
    """Logarithm (64,) of the share of each cell among those with dots."""
    share = np.full(KINDS_OF_CELL, (1.0 - LETTERS_SHARE) / (KINDS_OF_CELL - 1))
    for letter, percent in LETTERS.items():
        share[cells_of(letter)[0]] += LETTERS_SHARE * percent / sum(LETTERS.values())
    return np.asarray(np.log(share / share[1:].sum()))


def _orders() -> dict[str, Ints]:
    """Words for each way in which rows and columns are exchanged, and what every cell (64,) becomes by it."""
    bits = (np.arange(KINDS_OF_CELL)[:, None] >> np.arange(DOTS)) & 1
    found = {}
    for rows in permutations(range(3)):
        for columns in ((0, 1), (1, 0)):
            words = [] if rows == (0, 1, 2) else ["rows " + ", ".join(str(row + 1) for row in rows) + " for 1, 2, 3"]
            words += ["columns 2, 1 for 1, 2"] if columns == (1, 0) else []
            dots = [3 * column + row for column in columns for row in rows]
            if words:
                found[" and ".join(words)] = bits[:, dots] @ (1 << np.arange(DOTS))
    return found
