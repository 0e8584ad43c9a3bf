"""Logs of one press by several instruments give the columns of that press, whatever their clocks and rates."""

import numpy as np
import pytest

from softdot.cli import main
from softdot.config.rig import load_rig
from tests.diagnose.rigs import HEAD, RUN, SEGMENT

RIG = HEAD + SEGMENT + RUN


def depth_mm(time_s):
    """Clear of the dot, a half-sine of 0.3 mm and half a second, and clear again."""
    place = np.clip((time_s - 1.0) / 0.5, -0.2, 1.2)
    return 0.3 * np.sin(np.pi * place)


def write(path, head, *columns):
    rows = "".join(",".join(f"{value:.9g}" for value in row) + "\n" for row in zip(*columns, strict=True))
    path.write_text(head + "\n" + rows, "utf-8")
    return str(path)


@pytest.fixture
def bench(tmp_path):
    """An oscilloscope at 1 kHz with the load cell, and a stage at 200 Hz, whose clock began 0.7 s later."""
    rng = np.random.default_rng(3)
    fast, slow = np.arange(0.0, 2.5, 1e-3), np.arange(0.05, 2.45, 5e-3)
    voltage = np.gradient(np.clip(depth_mm(fast), 0.0, None), fast)
    force = np.clip(depth_mm(fast), 0.0, None)
    scope = write(
        tmp_path / "scope.csv", "Time (ms),CH1 (mV),Load cell (g)", 1e3 * fast,
        1e3 * voltage + 0.1 * rng.standard_normal(len(fast)),
        1e3 * (force + 1e-4 * rng.standard_normal(len(fast))) / 9.80665,
    )  # fmt: skip
    stage = write(
        tmp_path / "stage.csv", "Time (s),Position (um),Force (N)", slow - 0.7, 1e3 * depth_mm(slow),
        np.clip(depth_mm(slow), 0.0, None) + 1e-4 * rng.standard_normal(len(slow)),
    )  # fmt: skip
    (tmp_path / "rig.toml").write_text(RIG, "utf-8")
    return [scope, stage, "--rig", str(tmp_path / "rig.toml"), "-o", str(tmp_path / "out")]


def columns_of(out):
    (run,) = load_rig(out).recording.runs
    return run.time_s, run.channels


@pytest.mark.parametrize("clock", [["--offset", "0.7"], ["--align"]])
def test_clocks_rates_and_units_change_no_column(clock, bench, tmp_path, capsys):
    named = ["--column", "CH1=voltage_V", "--column", "Load cell=force_N", "--column", "Position=displacement_mm"]
    assert main(["convert", *bench, *clock, *named]) == 0
    said = capsys.readouterr()
    assert "displacement_mm is 'Position' of 'stage.csv', a sample every 0.005 s" in said.out
    time, channels = columns_of(tmp_path / "out")
    assert time[0] == pytest.approx(0.05, abs=2e-3)
    assert np.diff(time) == pytest.approx(1e-3)
    assert channels["displacement_mm"] == pytest.approx(depth_mm(time), abs=2e-3)
    assert channels["force_N"] == pytest.approx(np.clip(depth_mm(time), 0.0, None), abs=1e-3)


def test_a_channel_that_only_tells_the_clock_is_in_no_column(bench, tmp_path, capsys):
    """The force of the stage is that of the oscilloscope once more."""
    assert main(["convert", *bench, "--align"]) == 0
    assert "force_N is 'Load cell' of 'scope.csv'" in capsys.readouterr().out
    time, channels = columns_of(tmp_path / "out")
    assert sorted(channels) == ["displacement_mm", "force_N", "voltage_V"]
    assert channels["displacement_mm"] == pytest.approx(depth_mm(time), abs=2e-3)


def test_what_a_coarse_drive_costs_is_told(bench, tmp_path, capsys):
    """Within a factor of three of the true error of the rate, where the drive moves."""
    rough = np.arange(0.0, 2.5, 0.05)
    write(tmp_path / "stage.csv", "Time (s),Position (um)", rough, 1e3 * depth_mm(rough))
    assert main(["convert", *bench]) == 0
    said = capsys.readouterr().err
    assert "displacement_mm has a sample every 0.05 s, 50 times as far apart" in said
    told = float(said.partition("of its range and ")[2].partition(" %")[0])
    time, channels = columns_of(tmp_path / "out")
    true = np.gradient(depth_mm(time), time)
    error = 100.0 * np.std(np.gradient(channels["displacement_mm"], time) - true) / np.std(true)
    assert error / 3.0 < told < 3.0 * error


def test_a_drive_that_is_as_fine_costs_nothing(bench, tmp_path, capsys):
    fast = np.arange(0.0, 2.5, 1e-3)
    write(tmp_path / "stage.csv", "Time (s),Position (um)", fast, 1e3 * depth_mm(fast))
    assert main(["convert", *bench]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert "all clocks are taken as started by one trigger" in said.out


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ([], "could all be force_N; say which, such as --column"),
        (["--column", "CH2=voltage_V"], "--column 'CH2=voltage_V': there is none; did you mean 'CH1'"),
        (["--column", "CH1=force_N"], "is in V, which is no N"),
        (["--column", "CH1=voltage"], "must be CHANNEL=COLUMN with a column of"),
        (["--offset", "soon", "--column", "CH1=voltage_V"], "must be a number of seconds"),
        (["--offset", "1", "--offset", "2", "--column", "CH1=voltage_V"], "2 are given; needs one for each log behind"),
        (["--offset", "9", "--column", "CH1=voltage_V"], "share 0 s, less than 8 samples"),
    ],
)
def test_what_cannot_be_joined_is_one_sentence(more, said, bench, tmp_path, capsys):
    assert main(["convert", *bench, *more]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("missing", ["rows", "cells", "beginning"])
def test_a_gap_in_a_drive_is_missing_and_said(missing, bench, tmp_path, capsys):
    slow = np.arange(0.0, 2.5, 5e-3)
    hidden = slow < 0.5 if missing == "beginning" else (slow > 1.1) & (slow < 1.4)
    place = np.where(hidden & (missing != "rows"), np.nan, depth_mm(slow))
    kept = slice(None) if missing != "rows" else ~hidden
    write(tmp_path / "stage.csv", "Time (s),Position (mm)", slow[kept], place[kept])
    assert main(["convert", *bench]) == 0
    assert "'Position' of 'stage.csv' has gaps, so" in capsys.readouterr().err
    (run,) = load_rig(tmp_path / "out").recording.runs
    there = run.valid["displacement_mm"]
    assert run.channels["displacement_mm"][there] == pytest.approx(depth_mm(run.time_s[there]), abs=2e-3)
    assert 1.0 - there.mean() == pytest.approx(hidden.mean(), abs=0.02)


def test_clocks_that_run_apart_are_told(bench, tmp_path, capsys):
    """By three percent, over one press."""
    slow = np.arange(0.0, 2.5, 5e-3)
    force = np.clip(depth_mm(slow), 0.0, None) + 1e-4 * np.random.default_rng(1).standard_normal(len(slow))
    write(tmp_path / "stage.csv", "Time (s),Position (mm),Force (N)", 1.03 * slow, depth_mm(slow), force)
    assert main(["convert", *bench, "--align"]) == 0
    assert "one clock runs faster by about 0.0" in capsys.readouterr().err


def test_a_drive_of_a_few_samples_is_refused(bench, tmp_path, capsys):
    slow = np.arange(0.0, 2.5, 5e-3)
    write(tmp_path / "stage.csv", "Time (s),Position (mm)", slow, np.where(slow > 0.01, np.nan, -0.1))
    assert main(["convert", *bench]) == 2
    assert "'Position' was measured in less than 8 samples" in capsys.readouterr().err


def test_logs_that_share_no_channel_are_not_aligned(bench, tmp_path, capsys):
    fast = np.arange(0.0, 2.5, 1e-3)
    write(tmp_path / "stage.csv", "Time (s),Position (um)", fast, 1e3 * depth_mm(fast))
    assert main(["convert", *bench, "--align"]) == 2
    assert "do not both hold one channel of force or displacement" in capsys.readouterr().err


def test_a_rig_of_several_runs_is_refused(bench, tmp_path, capsys):
    (tmp_path / "rig.toml").write_text(RIG + RUN, "utf-8")
    assert main(["convert", *bench]) == 2
    assert "must hold one table [[runs]]" in capsys.readouterr().err
