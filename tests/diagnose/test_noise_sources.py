"""Where the noise of a channel is taken from, and where never."""

import numpy as np
import pytest

from diagnose.noise.estimate import noise_models
from diagnose.noise.rest import rest_mask
from diagnose.signals.phases import find_phases
from foundation.errors import InputError
from softdot.config.rig import load_rig
from tests.diagnose.rigs import COUPON, HEAD, RUN, SEGMENT, samples, write_rig


def models(folder):
    """Noise of every channel of a folder."""
    return noise_models(load_rig(folder).recording)


def runs(*names, extra=""):
    return HEAD + SEGMENT + "".join(f'[[runs]]\nfile = "{name}.csv"\n{extra}' for name in names)


def test_rest_tells_the_noise(tmp_path):
    noise = models(write_rig(tmp_path / "rig", press=samples(4000, 1000.0)))["press", "voltage_V"]
    assert noise.source == "rest"
    assert noise.rms == pytest.approx(0.001, rel=0.1)


def test_the_answer_to_a_press_is_no_noise(tmp_path):
    columns = samples(4000, 1000.0)
    before = models(write_rig(tmp_path / "one", press=columns))["press", "voltage_V"]
    during = (columns["time_s"] > 1.0) & (columns["time_s"] < 2.0)
    columns["voltage_V"][during] *= 5.0
    after = models(write_rig(tmp_path / "two", press=columns))["press", "voltage_V"]
    assert after.rms == before.rms


def test_rest_begins_one_press_length_behind_a_press(tmp_path):
    (run,) = load_rig(write_rig(tmp_path / "rig", press=samples(4000, 1000.0))).recording.runs
    rest = rest_mask(run, find_phases(run.time_s, run.drive_values))
    assert run.time_s[~rest][[0, -1]] == pytest.approx([0.9, 2.8], abs=0.02)


def test_repeated_runs_show_the_scatter_of_presses_that_rest_does_not(tmp_path):
    presses = {f"press{n}": samples(4000, 1000.0, seed=n) for n in range(5)}
    gains = 1.0 + 0.02 * np.array([-1.0, 0.5, 1.5, -1.5, 0.5])
    for gain, columns in zip(gains, presses.values(), strict=True):
        columns["voltage_V"] *= gain
    found = models(write_rig(tmp_path / "rig", runs(*presses), **presses))
    noise = found["press0", "voltage_V"]
    press = 0.3 * np.sqrt((0.5 + 2 * 0.2 / 3) / 4.0)  # root mean square of the trapezoid over the 4 s
    assert noise.source == "repeated runs"
    assert noise.rms == pytest.approx(np.hypot(0.001, np.std(gains, ddof=1) * press), rel=0.15)


def test_runs_of_another_depth_are_no_repeats(tmp_path):
    deep, shallow = samples(4000, 1000.0), samples(4000, 1000.0, seed=1)
    shallow["displacement_mm"] = 0.8 * shallow["displacement_mm"]
    found = models(write_rig(tmp_path / "rig", runs("deep", "shallow"), deep=deep, shallow=shallow))
    assert {noise.source for noise in found.values()} == {"rest"}


def test_a_coupon_never_rests_so_its_noise_is_stated(tmp_path):
    columns = {"time_s": np.arange(200.0), "displacement_mm": np.arange(200.0), "force_N": np.arange(200.0) ** 0.5}
    rig = HEAD + RUN + "noise = {force_N = 0.05}\n" + COUPON
    noise = models(write_rig(tmp_path / "rig", rig, press=columns))["press", "force_N"]
    assert (noise.source, noise.rms) == ("stated", pytest.approx(0.05))


def test_noise_that_nothing_tells_is_asked_for(tmp_path):
    columns = {name: values[95:] for name, values in samples(rows=200).items()}
    folder = write_rig(tmp_path / "rig", press=columns)
    with pytest.raises(InputError, match=r"press.csv', column voltage_V: its noise is not known; record at least 50"):
        models(folder)


def test_hum_at_rest_is_known_all_through_the_press(tmp_path):
    columns = samples(6000, 1000.0)
    signal, time = np.clip(columns["displacement_mm"], 0.0, None), columns["time_s"]
    columns["voltage_V"] += 0.02 * np.sin(2.0 * np.pi * 50.07 * time + 0.4)
    noise = models(write_rig(tmp_path / "rig", press=columns))["press", "voltage_V"]
    assert [line.frequency_Hz for line in noise.lines] == pytest.approx([50.07], abs=0.02)
    white = noise.whiten(columns["voltage_V"] - signal, time)
    assert white @ white == pytest.approx(len(white), rel=0.15)
    assert len(white) < 0.5 * float(np.square(noise.without_lines().whiten(columns["voltage_V"] - signal, time)).sum())
