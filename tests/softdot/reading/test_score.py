"""Rates and confusions."""

import numpy as np
import pytest

from softdot.reading.cells import cells_of
from softdot.reading.score import align, rate, scores


def test_what_was_lost_and_added_is_found():
    assert align("touch", "tuch") == [(0, 0), (1, None), (2, 1), (3, 2), (4, 3)]
    assert align("dot", "dots") == [(0, 0), (1, 1), (2, 2), (None, 3)]
    assert align("", "ab") == [(None, 0), (None, 1)]


def test_the_least_number_of_errors_is_that_of_the_literature():
    """kitten and sitting differ by three (Levenshtein's distance)."""
    pairs = align("kitten", "sitting")
    assert sum(i is None or j is None or "kitten"[i] != "sitting"[j] for i, j in pairs) == 3


def test_rates_have_wilsons_interval():
    """Nine of ten: 0.596 to 0.982 (Wilson, 1927)."""
    found = rate("abcdefghij", "abcdefghix")
    assert (found["right"], found["of"], found["value"]) == (9, 10, 0.9)
    assert (found["low"], found["high"]) == pytest.approx((0.596, 0.982), abs=1e-3)
    assert rate("ab", "xyzxyz")["value"] == 0.0


def test_errors_are_counted_by_cell_and_dot():
    """One b read as a (dot 2 missed), one a as c (dot 4 that is not there)."""
    found = scores(cells_of("bad a"), np.concatenate([cells_of("aad"), [0], cells_of("c")]), None)
    assert {(one["true"], one["read"], one["count"]) for one in found["confusion"]} == {("⠃", "⠁", 1), ("⠁", "⠉", 1)}
    assert found["missed_dots"]["2"] == 1
    assert found["false_dots"]["4"] == 1
    assert sum(found["missed_dots"].values()) + sum(found["false_dots"].values()) == 2
    assert found["text_read"] == "aad c"
    assert found["character_accuracy"]["value"] == 0.6
    assert found["word_accuracy"]["value"] == 0.0
