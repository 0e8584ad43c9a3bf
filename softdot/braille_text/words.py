"""The words of a language as Braille cells, with how often they are used, by the lists of pyspellchecker.

Their counts come from OpenSubtitles (Lison and Tiedemann, LREC 2016), so that they are those of what people say.
Letters alone make a word; of English ones those of a single letter are a, i and o.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from geometry.braille_cells import FIRST_CELL
from softdot.braille_text.english import english_cells
from softdot.braille_text.liblouis import louis_words

LANGUAGES = ("en", "de")
MOST_WORDS = 20_000
"""The most usual ones; rarer ones of the list are often misspelt."""


@dataclass(frozen=True)
class Words:
    """by_length : cells (w, n) of the words of n cells, and the shares (w,) of these in text. letters (64,) : shares of
    the cells within words.
    """

    by_length: dict[int, tuple[Ints, Floats]]
    letters: Floats


@cache
def words_of(language: str, table: str | None = None) -> Words:
    """The words of a language in the cells of a table of liblouis, or in plain English ones.

    InputError for a language that is not known, without a table for German, and without pyspellchecker.
    """
    if language not in LANGUAGES:
        raise InputError(f"--language = '{language}': is not known, allowed are {', '.join(LANGUAGES)}")
    if table is None and language != "en":
        raise InputError(f"--language = '{language}': needs a table of liblouis, such as --table de-g1.ctb")
    counts = _counts(language)
    chosen = sorted(counts, key=lambda word: -counts[word])[:MOST_WORDS]
    cells = [english_cells(word, "") for word in chosen] if table is None else louis_words(chosen, table)
    together: dict[str, float] = {}
    for word, one in zip(chosen, cells, strict=True):
        if one is not None:
            together[one] = together.get(one, 0.0) + counts[word]
    total = sum(together.values())
    letters, grouped = np.zeros(64), dict[int, list[str]]()
    for one in together:
        grouped.setdefault(len(one), []).append(one)
    by_length = {}
    for length, group in grouped.items():
        numbers = np.array([[ord(cell) - FIRST_CELL for cell in one] for one in group], dtype=np.int64)
        share = np.array([together[one] for one in group]) / total
        np.add.at(letters, numbers.ravel(), np.repeat(share, length))
        by_length[length] = numbers, share
    return Words(by_length, letters / letters.sum())


def _counts(language: str) -> dict[str, int]:
    """How often each word of letters alone is used. InputError without pyspellchecker."""
    try:
        from spellchecker import SpellChecker
    except ImportError:
        raise InputError(
            f"--language = '{language}': needs pyspellchecker, which is not installed; pip install 'softdot[language]'"
        ) from None
    listed = SpellChecker(language=language).word_frequency.dictionary
    return {
        word: count
        for word, count in listed.items()
        if word.isalpha() and (language != "en" or word.isascii()) and (len(word) > 1 or word in "aio")
    }
