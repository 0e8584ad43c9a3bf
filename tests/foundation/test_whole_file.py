"""Files that appear whole or not at all."""

import pytest

from foundation.files import whole_file


def test_the_file_is_there_when_the_block_has_ended(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old", "utf-8")
    with whole_file(path) as beside:
        beside.write_text("new", "utf-8")
        assert path.read_text(encoding="utf-8") == "old"
    assert [(entry.name, entry.read_text(encoding="utf-8")) for entry in tmp_path.iterdir()] == [("a.txt", "new")]


def stop_halfway(path, error):
    with whole_file(path) as beside:
        beside.write_text("ne", "utf-8")
        raise error


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
def test_after_an_interruption_the_old_file_is_all_there_is(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("old", "utf-8")
    with pytest.raises(error):
        stop_halfway(path, error)
    assert [(entry.name, entry.read_text(encoding="utf-8")) for entry in tmp_path.iterdir()] == [("a.txt", "old")]


def test_of_two_who_write_at_once_the_last_to_end_wins_whole(tmp_path):
    path = tmp_path / "a.txt"
    with whole_file(path, shared=True) as first:
        first.write_text("first", "utf-8")
        with whole_file(path, shared=True) as second:
            second.write_text("second", "utf-8")
        assert path.read_text(encoding="utf-8") == "second"
    assert [(entry.name, entry.read_text(encoding="utf-8")) for entry in tmp_path.iterdir()] == [("a.txt", "first")]
