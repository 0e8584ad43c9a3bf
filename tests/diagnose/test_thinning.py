"""Long recordings are averaged in time, and nothing that counts is lost."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.signals.reading import ENOUGH_SAMPLES, LEAST_RATE_HZ, average_blocks, thin_recording
from diagnose.signals.recording import Recording
from tests.diagnose.segment.rigs import run

RATE_Hz = 1000.0


def pressed(seconds=10.0, **changes):
    """A run of a slow press at RATE_Hz, with a voltage that follows it."""
    time = np.arange(0.0, seconds, 1.0 / RATE_Hz)
    depth = 0.2 * np.sin(np.pi * time / seconds) ** 2
    there = np.ones(len(time), dtype=bool)
    channels = {"displacement_mm": depth, "voltage_V": 3.0 * depth}
    valid = dict.fromkeys(channels, there)
    return replace(
        run(), time_s=time, channels=channels, valid=valid, saturated=dict.fromkeys(channels, ~there), **changes
    )


def test_a_short_recording_stays_as_it_is():
    recording = Recording((pressed(),))
    assert thin_recording(recording) is recording


def test_a_long_one_keeps_its_signals_and_says_what_was_done():
    recording = thin_recording(Recording((pressed(),) * 6))
    for one in recording.runs:
        assert one.step_s == pytest.approx(4.0 / RATE_Hz)
        np.testing.assert_allclose(one.channels["voltage_V"], 3.0 * one.channels["displacement_mm"])
        assert one.time_s[np.argmax(one.drive_values)] == pytest.approx(5.0, abs=4.0 / RATE_Hz)
    assert sum(len(one.time_s) for one in recording.runs) <= ENOUGH_SAMPLES
    (warning,) = recording.warnings
    assert "60,000 samples" in warning
    assert "125 Hz" in warning


def test_a_long_one_of_a_slow_clock_stays_as_it_is():
    whole = pressed()
    recording = Recording((replace(whole, time_s=10.0 * whole.time_s),) * 3)
    assert sum(len(run.time_s) for run in recording.runs) > ENOUGH_SAMPLES
    assert thin_recording(recording) is recording


def test_no_run_gets_slower_than_the_least_rate():
    recording = thin_recording(Recording((pressed(60.0),) * 6))
    assert max(one.step_s for one in recording.runs) <= 1.0 / LEAST_RATE_HZ + 1e-9


def test_white_noise_of_the_mean_is_less():
    assert average_blocks(pressed(noise={"voltage_V": 0.02}), 4).noise == {"voltage_V": pytest.approx(0.01)}


def test_a_block_with_a_missing_or_a_saturated_sample_is_missing_or_saturated():
    whole = pressed()
    missing, limit = np.arange(len(whole.time_s)) != 41, np.arange(len(whole.time_s)) == 82
    holed = {name: np.where(missing, values, np.nan) for name, values in whole.channels.items()}
    one = average_blocks(
        replace(whole, channels={**whole.channels, "voltage_V": holed["voltage_V"]},
                valid={**whole.valid, "voltage_V": missing}, saturated={**whole.saturated, "voltage_V": limit}), 4,
    )  # fmt: skip
    assert np.flatnonzero(~one.valid["voltage_V"]).tolist() == [10]
    assert np.flatnonzero(one.saturated["voltage_V"]).tolist() == [20]


def test_a_block_does_not_reach_over_a_gap():
    whole = pressed()
    time = whole.time_s + np.where(np.arange(len(whole.time_s)) >= 502, 3.0, 0.0)
    one = average_blocks(replace(whole, time_s=time), 4)
    assert not np.any((one.time_s > 0.502) & (one.time_s < 3.502))


def test_the_steps_of_a_converter_stay():
    whole = pressed()
    steps = {**whole.channels, "voltage_V": 0.01 * np.round(whole.channels["voltage_V"] / 0.01)}
    voltage = average_blocks(replace(whole, channels=steps), 4).channels["voltage_V"]
    np.testing.assert_allclose(voltage / 0.01, np.round(voltage / 0.01), atol=1e-6)
