"""A discrepancy proportional to the signal: its size is what a reader would call the error, whatever the sampling."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.fit.samples import Samples
from diagnose.fit.signal_discrepancy import SignalDiscrepancy, condition_labels, with_white_noise
from diagnose.noise.estimate import noise_models
from diagnose.signals.reading import average_blocks
from diagnose.signals.recording import Recording
from tests.cases import for_each
from tests.diagnose.inference.toy import Sensor, small

OFF = 0.03


def samples_of(recording):
    return with_white_noise(Samples(recording, noise_models(recording)))


def off_by(samples, share):
    """A residual, whitened, that is this share of every press's signal about its mean."""
    signals = []
    for run, found in zip(samples.recording.runs, samples.recording.phases, strict=True):
        own = {}
        for name in run.answers:
            values = run.channels[name].copy()
            for press in np.unique(found.press):
                values[found.press == press] -= values[found.press == press].mean()
            own[name] = share * values
        signals.append(own)
    return samples.coefficients(signals)


@for_each("factor", [1, 2])
def test_an_error_of_three_per_cent_has_the_size_of_three_per_cent(factor):
    recording = small(3, Sensor(), runs=4, noise=1e-4)
    recording = Recording(tuple(average_blocks(run, factor) for run in recording.runs))
    samples = samples_of(recording)
    sizes = SignalDiscrepancy(samples).sizes(off_by(samples, OFF))
    assert sizes == pytest.approx([OFF, OFF], rel=0.1)


def test_noise_alone_has_a_size_far_below_its_own():
    """Only what is above the noise counts; how well a mean square is known from 2400 samples is left."""
    recording = small(3, Sensor(), runs=4, noise=0.01)
    samples = samples_of(recording)
    white = np.random.default_rng(5).standard_normal(len(samples))
    signal = [min(float(np.std(run.channels[name])) for run in recording.runs) for name in samples.channels]
    assert (SignalDiscrepancy(samples).sizes(white) < 0.4 * 0.01 / np.array(signal)).all()


def test_a_press_that_drowns_in_noise_counts_next_to_nothing():
    """Noise that is a tenth stronger than was known is no discrepancy, though it is as large as the weakest signal."""
    recording = small(3, Sensor(), runs=4, noise=0.005)
    first = recording.runs[0]
    weak = replace(first, channels=first.channels | {name: 0.01 * first.channels[name] for name in first.answers})
    noise = noise_models(recording)
    samples = with_white_noise(Samples(Recording((weak, *recording.runs[1:])), noise))
    stronger = 1.1 * np.random.default_rng(5).standard_normal(len(samples))
    assert (SignalDiscrepancy(samples).sizes(stronger) < 0.01).all()


def test_each_phase_counts_as_one_however_many_samples_it_has():
    """Of an error as large as tolerated, the square in units of its variance is the number of phases."""
    samples = samples_of(small(3, Sensor(), runs=4, noise=1e-4))
    tolerance = SignalDiscrepancy(samples)
    residual = off_by(samples, OFF)
    square = float((residual**2 / tolerance.variance(np.full(2, OFF))).sum())
    phases = len(np.unique(np.column_stack([samples.block_of, samples.press, samples.phase]), axis=0))
    assert square == pytest.approx(phases, rel=0.1)


def test_runs_that_repeat_each_other_are_one_condition():
    recording = small(3, Sensor(), runs=3)
    again = small(4, Sensor(), runs=3)
    runs = [*recording.runs, *(run.__class__(**{**vars(run), "label": f"{run.label} again"}) for run in again.runs)]
    samples = samples_of(Recording(tuple(runs)))
    assert len(samples.presses) == 6
    assert len(np.unique(condition_labels(samples))) == 3
