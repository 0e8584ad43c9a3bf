"""Unicode cells: code points from the Unicode chart, positions from the numbering of the dots."""

import pytest

from foundation.errors import InputError
from geometry.braille_cells import dot_offset_mm, raised_dots
from tests.cases import for_each


@for_each(
    ("character", "dots"),
    [
        ("\u2801", (1,)),  # a
        ("\u2807", (1, 2, 3)),  # l
        ("\u283f", (1, 2, 3, 4, 5, 6)),
        ("\u28ff", (1, 2, 3, 4, 5, 6, 7, 8)),
        ("\u2840", (7,)),
        ("\u2880", (8,)),
        ("\u2800", ()),
        ("⠝", (1, 3, 4, 5)),  # n
    ],
)
def test_bits_of_the_code_point_are_raised_dots(character, dots):
    assert raised_dots(character) == dots


@for_each("wrong", ["a", "", "⠁⠁", "\u27ff", "\u2900"])
def test_anything_else_is_refused(wrong):
    with pytest.raises(InputError, match=f"^dot.cell = '{wrong}': must be one Unicode Braille character"):
        raised_dots(wrong)


@for_each(
    ("dot", "column", "row"),
    [(1, 0, 0), (2, 0, 1), (3, 0, 2), (4, 1, 0), (5, 1, 1), (6, 1, 2), (7, 0, 3), (8, 1, 3)],
)
def test_columns_run_along_x_and_rows_along_y(dot, column, row):
    assert dot_offset_mm(dot, 2.5) == pytest.approx([2.5 * column, 2.5 * row])
