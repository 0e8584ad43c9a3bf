"""How large a hidden effect is: its projected signal-to-noise ratio over the smallest visible one, which is 4."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, solve

from benchmarks.made_elsewhere.chain import HUM_HZ, Noise, Signal, Widths
from benchmarks.made_elsewhere.drives import RATE

VISIBLE = 4.0
CODES_SHARE = 0.005  # by which two codes differ in force and voltage
CODES_MM = 5e-4  # and in the first touch
HUM_SHARE = 0.2  # of the noise: the most that is in every recording


@dataclass(frozen=True)
class Pair:
    """One run without noise: what the stated rig gives, what the true one gives, and the former at a deeper zero."""

    stated: tuple[Signal, Signal]  # force, voltage
    true: tuple[Signal, Signal]
    deeper: tuple[Signal, Signal]  # by CODES_MM


def whitened(signal: Signal, sd: float, memory: float, step: float) -> Signal:
    """One-step errors over their standard deviation; a converter's step adds its variance."""
    scale = np.sqrt((sd**2 + step**2 / 12) * (1 - memory**2))
    return (signal - memory * np.concatenate([[0.0], signal[:-1]])) / scale


def multiple(pairs: list[Pair], noise: Noise, widths: Widths) -> float:
    """The size left where gains, lag and zeros of each run, faint hum and what codes differ by may absorb it."""

    def rows(force: Signal, volts: Signal) -> Signal:
        f = whitened(force, noise.force_sd_N, noise.force_ar1, 0.0)
        return np.concatenate([f, whitened(volts, noise.voltage_sd_V, noise.voltage_ar1, noise.adc_step_V)])

    own, common, effects = [], [], []
    for pair in pairs:
        force, volts = pair.stated
        none, one = np.zeros_like(force), np.ones_like(force)
        wave = 2 * np.pi * HUM_HZ * np.arange(len(force)) / RATE
        hum = HUM_SHARE * noise.voltage_sd_V
        touch = [(moved - kept) / CODES_MM for moved, kept in zip(pair.deeper, pair.stated, strict=True)]
        own.append(
            np.column_stack(
                [
                    rows(none, widths.gain * volts),
                    rows(none, widths.lag_s * RATE * np.gradient(volts)),
                    rows(none, widths.offset_V * one),
                    rows(widths.force_gain * force, none),
                    rows(widths.offset_N * one, none),
                    rows(*(widths.offset_mm * part for part in touch)),
                    rows(none, hum * np.sin(wave)),
                    rows(none, hum * np.cos(wave)),
                ]
            )
        )
        floor = [rows(CODES_SHARE * force, none), rows(none, CODES_SHARE * volts)]
        common.append(np.column_stack([*floor, rows(*(CODES_MM * part for part in touch))]))
        effects.append(rows(*(true - stated for true, stated in zip(pair.true, pair.stated, strict=True))))
    effect = np.concatenate(effects)
    absorbed = np.column_stack([block_diag(*own), np.vstack(common)])
    inner = np.eye(absorbed.shape[1]) + absorbed.T @ absorbed
    left = effect @ effect - (absorbed.T @ effect) @ solve(inner, absorbed.T @ effect, assume_a="pos")
    return float(np.sqrt(max(left, 0.0)) / VISIBLE)
