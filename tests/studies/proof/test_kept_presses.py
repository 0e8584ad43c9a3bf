"""Solved presses of the proof's own code on disk: what is damaged is solved again, and never ends a case."""

import numpy as np
import pytest

from softdot.studies.proof.world import march
from tests.cases import for_each

COURSE = march.Course(*(np.linspace(0.0, scale, 25) for scale in (1.0, 2.0, 3.0)))


@pytest.fixture
def kept(tmp_path, monkeypatch):
    monkeypatch.setenv("SOFTDOT_PROOF_CACHE", str(tmp_path))
    found = march._file_of("table")
    found.write(COURSE)
    return found


def test_what_was_written_is_read(kept):
    for name, column in vars(COURSE).items():
        np.testing.assert_array_equal(getattr(kept.load(), name), column)


@pytest.mark.press
def test_no_flipped_bit_is_believed_and_none_escapes(kept):
    good = kept.path.read_bytes()
    for bit in range(8 * len(good)):
        bad = bytearray(good)
        bad[bit // 8] ^= 1 << bit % 8
        kept.path.write_bytes(bytes(bad))
        assert kept.load() is None


@for_each("content", [b"", b"{}", b"PK\x05\x06" + bytes(18)])
def test_other_content_is_not_believed(kept, content):
    kept.path.write_bytes(content)
    assert kept.load() is None
