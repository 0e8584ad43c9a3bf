"""What a command tells while it works where nobody watches a terminal: a pipe, a batch system, a notebook."""

import json
import subprocess
import sys

import pytest

from softdot.cli import main
from softdot.commands import run
from softdot.commands.plate import short_text
from softdot.log import LOG_FILE, lines_on_stderr, log_file, warn
from softdot.progress import Logged

DOT = ("plate", "--kind", "dot", "--standard", "marburg-medium", "-o", "out")
SOLVED = {"warnings": ["segment.held_layers is not what you think"], "solver": {"converged": True}}


def _softdot(folder, *arguments):
    command = [sys.executable, "-m", "softdot.cli", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, encoding="utf-8", check=True)


@pytest.mark.process
def test_in_a_pipe_each_stage_is_a_line_with_its_time_on_stderr_and_in_the_log(tmp_path):
    done = _softdot(tmp_path, *DOT)
    summary = json.loads((tmp_path / "out" / "plate.json").read_text(encoding="utf-8"))
    assert done.stdout == f"{short_text(summary, 'out')}\n"  # the result alone
    times, stages = zip(*(line.split(" s  ") for line in done.stderr.splitlines()), strict=True)
    assert list(stages) == ["printability", "export"]
    assert [float(time) for time in times] == sorted(float(time) for time in times)
    assert "INFO    export" in (tmp_path / "out" / LOG_FILE).read_text(encoding="utf-8")


@pytest.mark.process
def test_quiet_tells_nothing_and_json_alone_is_on_stdout(tmp_path):
    done = _softdot(tmp_path, *DOT, "--quiet", "--json")
    assert done.stderr == ""
    assert json.loads(done.stdout)["format"] == "softdot-plate/1"
    assert (tmp_path / "out" / LOG_FILE).exists()


@pytest.mark.parametrize("options", [[], ["--json"], ["--quiet"], ["--json", "--quiet"]])
def test_warnings_are_on_stderr_whatever_else_is_asked_for(options, monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(run, "run_case", lambda *_: SOLVED)
    assert main(["run", "-o", str(tmp_path / "out"), *options]) == 0
    assert capfd.readouterr().err == "softdot: warning: segment.held_layers is not what you think\n"


def test_each_load_step_is_a_line_and_each_hundredth_of_ten_thousand_points(capsys):
    with lines_on_stderr():
        progress = Logged()
        progress.stage("solve")
        for number in range(1, 7):
            progress.step(number, 6, f"{number} N")
        steps = capsys.readouterr().err.splitlines()
        for number in range(1, 10_001):
            progress.step(number, 10_000, "")
    assert len(steps) == 7
    assert steps[-1].endswith("solve 6 of 6: 6 N")
    assert len(capsys.readouterr().err.splitlines()) == 100


def test_details_are_in_the_log_always_and_on_stderr_when_asked_for(tmp_path, capsys):
    from solve.solution.newton import LOG

    for verbose in (False, True):
        with lines_on_stderr(verbose=verbose), log_file(tmp_path / LOG_FILE):
            LOG.debug("Newton iteration 3")
        assert ("Newton iteration 3" in capsys.readouterr().err) is verbose
    assert (tmp_path / LOG_FILE).read_text(encoding="utf-8").count("Newton iteration 3") == 2


def test_a_warning_is_told_once_even_when_its_text_has_a_percent_sign(capsys):
    with lines_on_stderr(quiet=True):
        warn(["5 % of the film yields", "5 % of the film yields"])
    assert capsys.readouterr().err == "softdot: warning: 5 % of the film yields\n"


def test_lines_appear_at_the_prompt_of_python_and_in_a_notebook_but_not_in_a_script(monkeypatch, capsys):
    from softdot.log import lines_when_interactive

    with lines_when_interactive():
        Logged().stage("mesh")
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys, "ps1", "In [1]: ", raising=False)
    with lines_when_interactive():
        Logged().stage("mesh")
    assert capsys.readouterr().err.endswith(" s  mesh\n")
