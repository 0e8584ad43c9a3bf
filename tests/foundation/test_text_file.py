"""Files that a user names: regular, bounded, UTF-8."""

import os

import pytest

from foundation.errors import InputError
from foundation.files import LARGEST_TEXT_MB, read_text


def refusal(path):
    with pytest.raises(InputError) as caught:
        read_text(path, f"configuration '{path}'")
    return str(caught.value)


def test_a_byte_order_mark_is_no_text(tmp_path):
    (tmp_path / "a").write_bytes(b"\xef\xbb\xbftime_s")
    assert read_text(tmp_path / "a", "a") == "time_s"


def test_a_pipe_does_not_hang(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    assert "a regular file is needed" in refusal(tmp_path / "pipe")


def test_a_device_without_end_is_not_read(tmp_path):
    (tmp_path / "endless").symlink_to("/dev/zero")
    assert "a regular file is needed" in refusal(tmp_path / "endless")


def test_a_name_with_nul(tmp_path):
    assert "NUL" in refusal(tmp_path / "a\0b")


def test_a_huge_file_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / "huge").open("wb") as stream:
        stream.truncate(int(1e6 * LARGEST_TEXT_MB) + 1)  # sparse
    assert f"at most {LARGEST_TEXT_MB} MB" in refusal(tmp_path / "huge")
