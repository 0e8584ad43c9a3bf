"""An error of the drive, which all channels of a run show together: noise that they share.

A stage trembles about where its encoder says it is. The error is taken as a random function over each press of one root
mean square up to one frequency: cosines over the press. A channel shows it by its own tangent, so that force and
voltage tell it from their own noise, and from laws that are not quite right in one of them. Root mean square and band
are those that make what an explanation leaves likeliest, as variances of random effects (Dempster, Laird and Rubin,
J. R. Stat. Soc. B 39, 1977, 1-38), beside noise of each channel that may be larger than stated.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.stats import chi2

from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import SharedNoise
from diagnose.fit.signal_discrepancy import VISIBLE_ERROR
from diagnose.forward import Setting
from diagnose.signals.phases import PressPhases
from diagnose.signals.recording import Run
from foundation.arrays import Bools, Floats, Ints

BANDS_HZ = (2.0, 5.0, 10.0, 20.0)
MOST_WAVES_PER_PRESS = 100
TANGENT_STEP_SHARE, START_RMS_SHARE = 2e-3, 1e-3  # of the deepest drive: steps of tangents, and first guess
MAX_EM_ITERATIONS, EM_TOLERANCE = 200, 1e-3  # tolerance: relative change of a variance


@dataclass(frozen=True)
class DriveError:
    """Error of the drive about its column. rms_mm : its root mean square, below band_Hz.

    noise : what it makes of the channels of each run.
    """

    rms_mm: float
    band_Hz: float
    noise: SharedNoise


def likeliest_drive_error(
    model: ObservedModel, values: Floats, on: Sequence[Setting], level: float
) -> DriveError | None:
    """Likeliest error of the drive beside nuisances (p,) and mechanisms.

    None where no displacement drives, where only one channel answers, where the model has no answer, where channels
    that err each for itself are as likely by a likelihood-ratio test of this level, or where it is larger than an
    ordinary rig's.
    """
    if not _two_channels_answer(model.runs):
        return None
    try:
        residual = model.samples.recorded_vector - model.vector(values, on)
        waves = [_DriveWaves(model, run, values, on, residual) for run in range(len(model.runs))]
    except ValueError:
        return None
    deepest = max(float(run.drive_values.max()) for run in model.runs)
    seen = _ChannelSquares.from_residual(model, residual)
    every, each = np.ones((1, len(seen.count))), np.eye(len(seen.count))
    start = (START_RMS_SHARE * deepest) ** 2
    band = max(BANDS_HZ, key=lambda band: _maximise_likelihood(seen, _band_equations(waves, band, every), start)[1])
    apart = _maximise_likelihood(seen, _band_equations(waves, band, each), start)[1]
    variances, gain = _maximise_likelihood(seen, _band_equations(waves, band, np.vstack([every, each])), start)
    rms = float(np.sqrt(variances[0]))
    if 2.0 * (gain - apart) < chi2.isf(level, 1) or rms > VISIBLE_ERROR * deepest:
        return None
    return DriveError(rms, band, tuple(one.shared_noise(band, rms) for one in waves))


def _two_channels_answer(runs: Sequence[Run]) -> bool:
    """Whether all runs are driven by a displacement, and two channels answer in at least one."""
    by_displacement = all(run.drive == "displacement_mm" and float(run.drive_values.max()) > 0.0 for run in runs)
    return by_displacement and any(len(run.answers) > 1 for run in runs)


class _DriveWaves:
    """Cosines of unit root mean square over the presses of one run, and the answer of the run to them.

    frequency_Hz, press : (w,) of each wave. change : channel -> (t, w) per mm. gram : (c, w, w) inner products of
    these, whitened, by the number of the channel; moment : (c, w) of these with the residual.
    """

    def __init__(self, model: ObservedModel, run: int, values: Floats, on: Sequence[Setting], residual: Floats) -> None:
        samples, recorded = model.samples, model.runs[run]
        self.press, self.frequency_Hz, drives = _drive_cosines(recorded, samples.recording.phases[run].presses)
        step_mm = TANGENT_STEP_SHARE * float(recorded.drive_values.max())
        drive = recorded.drive_values * (
            1.0 - np.sqrt(2.0) * TANGENT_STEP_SHARE
        )  # no wave goes deeper than the recording
        still = model.imagined_signals(run, drive, values, on)
        moved = [model.imagined_signals(run, drive + step_mm * wave, values, on) for wave in drives]
        self.change = {
            name: np.array([(one[name] - still[name]) / step_mm for one in moved]).reshape(-1, len(still[name])).T
            for name in recorded.answers
        }
        channels, count = len(samples.channels), len(drives)
        self.gram, self.moment = np.zeros((channels, count, count)), np.zeros((channels, count))
        for block in samples.blocks:
            if block.run == run:
                columns = samples.block_vector(block, block.whitening(self.change[block.channel]))[block.rows]
                number = samples.channels.index(block.channel)
                self.gram[number], self.moment[number] = columns.T @ columns, columns.T @ residual[block.rows]

    def within_band(self, band_Hz: float) -> tuple[Bools, Floats]:
        """Flags (w,) of the waves up to a frequency, and factors by which each counts, so that presses are alike."""
        which = self.frequency_Hz <= band_Hz
        return which, 1.0 / np.sqrt(np.bincount(self.press[which])[self.press[which]])

    def shared_noise(self, band_Hz: float, rms_mm: float) -> dict[str, Floats]:
        """Noise that channels share by name: (t, w) times unit normal amplitudes."""
        which, scale = self.within_band(band_Hz)
        return {name: rms_mm * scale * change[:, which] for name, change in self.change.items()}


def _drive_cosines(run: Run, presses: Sequence[PressPhases]) -> tuple[Ints, Floats, Floats]:
    """Press (w,), frequency (w,) in Hz and values (w, t) of cosines over the presses of a run."""
    found: list[tuple[int, float, Floats]] = []
    for number, press in enumerate(presses):
        own = slice(press.touch, press.clear)
        time = run.time_s[own] - run.time_s[press.touch]
        for order in range(min(MOST_WAVES_PER_PRESS, len(time))):
            frequency = 0.5 * order / max(float(time[-1]), run.step_s)
            if frequency <= BANDS_HZ[-1]:
                wave = np.zeros(len(run.time_s))
                wave[own] = np.cos(2.0 * np.pi * frequency * time) * (np.sqrt(2.0) if order else 1.0)
                found.append((number, frequency, wave))
    waves = np.array([wave for _, _, wave in found]).reshape(len(found), len(run.time_s))
    return np.array([n for n, _, _ in found], dtype=np.int64), np.array([f for _, f, _ in found]), waves


@dataclass(frozen=True)
class _Equations:
    """Normal equations of one run: gram (c, w, w), moment (c, w), and of which kind of error each wave is, (w,)."""

    gram: Floats
    moment: Floats
    kind: Ints


def _band_equations(waves: Sequence[_DriveWaves], band_Hz: float, shows: Floats) -> list[_Equations]:
    """Normal equations of each run for waves up to a frequency.

    shows : (kinds, channels) 1 where a channel shows an error of a kind, else 0.
    """
    found = []
    for one in waves:
        which, scale = one.within_band(band_Hz)
        gram, moment = one.gram[:, which][:, :, which] * np.outer(scale, scale), one.moment[:, which] * scale
        if which.any():
            of_all = [np.kron(np.outer(own, own), block) for own, block in zip(shows.T, gram, strict=True)]
            along = [np.kron(own, block) for own, block in zip(shows.T, moment, strict=True)]
            kind = np.repeat(np.arange(len(shows)), int(which.sum()))
            found.append(_Equations(np.array(of_all), np.array(along), kind))
    return found


@dataclass(frozen=True)
class _ChannelSquares:
    """Number of coefficients, and sum of squares of the residual, of each channel, (c,)."""

    count: Floats
    total: Floats

    @classmethod
    def from_residual(cls, model: ObservedModel, residual: Floats) -> Self:
        """Squares of a whitened residual (n,)."""
        channel: Ints = model.samples.kind[model.samples.block_of]
        count, total = np.bincount(channel), np.bincount(channel, residual**2)
        return cls(np.asarray(count, dtype=np.float64), np.asarray(total, dtype=np.float64))

    def noise_variances(self, left: Floats) -> Floats:
        """Variances (c,) of the noise, at least 1, where left (c,) is left of the squares."""
        return np.maximum(left / self.count, 1.0)

    def log_likelihood(self, noise: Floats) -> float:
        """Log-likelihood with noise of these variances (c,) alone, but for a constant."""
        return -0.5 * float((self.count * np.log(noise) + self.total / noise).sum())


def _maximise_likelihood(seen: _ChannelSquares, equations: Sequence[_Equations], start: float) -> tuple[Floats, float]:
    """Variances (kinds,) of the drive in mm2, and the logarithm of their likelihood over that of noise alone."""
    count = sum((np.bincount(one.kind) for one in equations), np.zeros(1))
    noise, variance, gain = seen.noise_variances(seen.total), np.full(len(count), start), 0.0
    alone = seen.log_likelihood(noise)
    for _ in range(MAX_EM_ITERATIONS if equations else 0):
        gain, square, left = seen.log_likelihood(noise) - alone, np.zeros(len(count)), seen.total.copy()
        for one in equations:
            prior = variance[one.kind]
            precision = np.tensordot(1.0 / noise, one.gram, 1) + np.diag(1.0 / prior)
            along, factor = one.moment.T @ (1.0 / noise), cho_factor(precision, lower=True)
            mean = cho_solve(factor, along)
            second = np.outer(mean, mean) + cho_solve(factor, np.eye(len(mean)))
            square += np.bincount(one.kind, np.diag(second))
            left += np.einsum("cij,ij->c", one.gram, second) - 2.0 * one.moment @ mean
            gain += 0.5 * float(along @ mean - np.log(prior).sum()) - float(np.log(np.diag(factor[0])).sum())
        before, variance = variance, square / count
        noise = seen.noise_variances(left)
        if np.all(np.abs(variance - before) < EM_TOLERANCE * before):
            break
    return variance, gain
