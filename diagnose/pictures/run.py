"""Picture of a run over time: recorded, simulated before and after, and what is left against the noise."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.findings import Findings
from diagnose.forward import Signals
from diagnose.pictures.style import AFTER, BEFORE, CLOSEST, FULL, RECORDED, SOFT, new_figure, save
from diagnose.signals.recording import Run
from foundation.arrays import Floats

MOST_CHANNELS = 4
BAND_SIGMAS = 2.0


def draw_run(run: Run, findings: Findings, full: Signals | None, path: Path) -> Path:
    """Draw the signals of each channel, and below them the residuals with a band of two sigma of the noise.

    full : signals by the full model, where it pressed this run again.
    """
    channels = channels_to_draw(run, findings)
    height = 3.6 if len(channels) == 1 else 3.3
    figure, panels = new_figure(2, len(channels), height, sharex=True, gridspec_kw={"height_ratios": [2.2, 1.0]})
    for number, channel in enumerate(channels):
        _draw_signals(panels[0, number], run, channel, findings, full)
        _draw_residuals(panels[1, number], run, channel, findings)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels), fontsize=9, frameon=False)
    return save(figure, path)


def channels_to_draw(run: Run, findings: Findings) -> Sequence[str]:
    """Channels to draw, in the order of the recording; of many those with the largest residual over noise."""
    sizes = {
        name: np.nanmean((run.channels[name] - findings.baseline[run.label][name]) ** 2)
        / _noise_rms(run, name, findings) ** 2
        for name in run.answers
    }
    chosen = sorted(sizes, key=lambda name: -float(sizes[name]))[:MOST_CHANNELS]
    return [name for name in run.answers if name in chosen]


def _noise_rms(run: Run, channel: str, findings: Findings) -> float:
    noise = findings.detection.noise.get((run.label, channel), {})
    return float(noise.get("rms", 1.0)) or 1.0


def _draw_signals(panel: Any, run: Run, channel: str, findings: Findings, full: Signals | None) -> None:
    """Draw recorded and simulated signals of a channel, and those of the full model where it pressed the run."""
    panel.plot(run.time_s, _usable_samples(run, channel), color=RECORDED, lw=2.6, alpha=0.45, label="recorded")
    for colour, values in _model_signals(run, channel, findings).items():
        panel.plot(run.time_s, values, color=colour, lw=1.2, label=MODEL_LABELS[colour])
    if full is not None and channel in full:
        panel.plot(run.time_s, full[channel], color=FULL, lw=2.0, ls=":", label="the same with the full model")
    panel.set_ylabel(_axis_label(channel), fontsize=10)
    limits = [_usable_samples(run, channel), *_model_signals(run, channel, findings).values()]
    low, high = (f(np.concatenate(limits)) for f in (np.nanmin, np.nanmax))
    panel.set_ylim(low - 0.06 * (high - low), high + 0.06 * (high - low))


def _draw_residuals(panel: Any, run: Run, channel: str, findings: Findings) -> None:
    """Draw recorded less simulated signals of a channel, over a band of BAND_SIGMAS of the noise."""
    band = BAND_SIGMAS * _noise_rms(run, channel, findings)
    panel.axhspan(-band, band, color=SOFT, alpha=0.35, lw=0)
    for colour, values in _model_signals(run, channel, findings).items():
        panel.plot(run.time_s, _usable_samples(run, channel) - values, color=colour, lw=0.8)
    panel.set_ylabel("recorded\n− simulated", fontsize=9)
    panel.set_xlabel("time (s)", fontsize=10)


MODEL_LABELS = {BEFORE: "your simulation", AFTER: "with what was left out", CLOSEST: "closest explanation, not named"}


def _model_signals(run: Run, channel: str, findings: Findings) -> Mapping[str, Floats]:
    """Signals (t,) of each model by its colour."""
    closest = findings.closest if findings.comes_closer else None
    each = {BEFORE: findings.baseline, AFTER: findings.improved, CLOSEST: closest}
    return {colour: signals[run.label][channel] for colour, signals in each.items() if signals is not None}


def _usable_samples(run: Run, channel: str) -> Floats:
    """Recorded samples (t,), NaN where they were not used."""
    return np.where(run.usable(channel), run.channels[channel], np.nan)


def _axis_label(channel: str) -> str:
    name, _, unit = channel.rpartition("_")
    return f"{name.replace('_', ' ')} ({unit})"
