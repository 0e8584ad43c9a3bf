"""Text to cells and back."""

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.braille_text.english import english_table
from softdot.braille_text.liblouis import liblouis
from softdot.reading.cells import MOST_CELLS, braille, cells_of, text_of
from tests.cases import for_each

TEXTS = (
    "soft dots, read by touch",
    "It's 7.45; A is 1, UEB and pH 3-4!",
    "Call (020) 7946 or write: a/b@c",
    "12 apples, 3b or 4k? .5 too.",
    "“who” knows",
    "ABc aBC A BCD",
)


@for_each("text", TEXTS)
def test_what_is_written_is_read_again(text):
    assert text_of(cells_of(text)) == text


def test_cells_of_any_text_stay_what_they_are():
    """Two signs may share their cells, so not every text comes back; its cells do."""
    table = english_table()
    known = [*table["letters"], *map(str.upper, table["letters"]), *table["digits"], *table["signs"], *" " * 20]
    random = np.random.default_rng(3)
    for _ in range(300):
        text = "x" + "".join(random.choice(known, 12)) + "x"
        cells = cells_of(text)
        np.testing.assert_array_equal(cells_of(text_of(cells)), cells, err_msg=text)


def test_every_cell_has_a_text():
    """A cell that means nothing alone stays a cell."""
    for cell in range(1, 64):
        assert text_of([cell])


def test_cells_are_the_bits_of_unicode():
    assert braille(cells_of("d")) == "⠙"
    assert cells_of("d").tolist() == [0b011001]


@for_each(
    ("text", "said"),
    [
        ("caf\u00e9", r"text: 'é' \(U\+00E9, latin small letter e with acute\) at place 4"),
        ("  ", "text: is empty"),
        ("⠿⣿", "text: the cell '⣿' has eight dots"),
        ("a" * (MOST_CELLS + 1), f"text: has {MOST_CELLS + 1} cells, at most {MOST_CELLS}"),
    ],
)
def test_what_cannot_be_written_is_named(text, said):
    with pytest.raises(InputError, match=said):
        cells_of(text)


@pytest.mark.skipif(liblouis() is None, reason="needs liblouis")
def test_contracted_braille_comes_back():
    cells = cells_of("the children can read", "en-ueb-g2.ctb")
    assert len(cells) < len("the children can read")
    assert text_of(cells, "en-ueb-g2.ctb") == "the children can read"
