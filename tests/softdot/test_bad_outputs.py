"""Output folders that cannot be: one sentence, exit 2, before any work, nothing touched."""

import os

import pytest

from softdot.cli import main


@pytest.fixture
def refused(stages, capfd):
    """Run into a folder that must be refused before the geometry is built; returns the sentence."""

    def no_work(*_):
        raise AssertionError("work began")

    stages.parts = no_work

    def run_into(out):
        assert main(["run", "-o", str(out)]) == 2
        said = capfd.readouterr().err
        assert said.count("\n") == 1
        return said.removeprefix("softdot: ").rstrip("\n")

    return run_into


def test_a_file(tmp_path, refused):
    out = tmp_path / "out"
    out.write_text("mine", "utf-8")
    assert refused(out) == f"output '{out}': this is a file, a folder is needed"
    assert out.read_text(encoding="utf-8") == "mine"


def test_a_file_on_the_way(tmp_path, refused):
    (tmp_path / "file").write_text("mine", "utf-8")
    out = tmp_path / "file" / "deep" / "out"
    assert refused(out) == f"output '{out}': '{tmp_path / 'file'}' is a file, a folder is needed"


def test_a_folder_with_other_things(tmp_path, refused):
    (tmp_path / "thesis.tex").write_text("mine", "utf-8")
    said = refused(tmp_path)
    assert said == (f"output '{tmp_path}': holds 'thesis.tex', which softdot did not write; name a new or empty folder")
    assert os.listdir(tmp_path) == ["thesis.tex"]


def test_a_summary_of_another_program(tmp_path, refused):
    (tmp_path / "summary.json").write_text('{"format": "other/1"}', "utf-8")
    assert "holds 'summary.json', which softdot did not write" in refused(tmp_path)


@pytest.mark.usefixtures("stages")
def test_an_earlier_run_to_which_something_was_added(tmp_path, capfd):
    out = tmp_path / "out"
    assert main(["run", "-o", str(out)]) == 0
    (out / "notes.txt").write_text("mine", "utf-8")
    assert main(["run", "-o", str(out)]) == 2
    assert "holds 'notes.txt'" in capfd.readouterr().err
    assert (out / "notes.txt").read_text(encoding="utf-8") == "mine"


def test_a_name_that_is_too_long(tmp_path, refused):
    assert "File name too long" in refused(tmp_path / ("x" * 300))


def test_a_link_that_leads_in_circles(tmp_path, refused):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    assert refused(tmp_path / "a").startswith(f"output '{tmp_path / 'a'}': ")


@pytest.mark.skipif("not os.path.isdir('/proc/self')", reason="needs a file system that root cannot write")
def test_a_place_that_cannot_be_written(refused):
    assert refused("/proc/out").startswith("output '/proc/out': not writable (")


@pytest.mark.skipif("os.geteuid() == 0", reason="everything is writable to root")
def test_a_folder_without_permission(tmp_path, refused):
    (tmp_path / "locked").mkdir(mode=0o500)
    out = tmp_path / "locked" / "out"
    assert refused(out) == f"output '{out}': not writable (Permission denied)"
