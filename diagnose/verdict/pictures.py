"""Where the simulation is off, at a glance: runs by phases and frequencies.

A run over time: recorded, simulated before and after, and what is left against the noise.

Which explanation predicts held-out presses, and which component the excess belongs to.

What all pictures of a diagnosis share: colours, size, frame.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.figures import figure
from diagnose.findings import Findings, FittedModel, LocatedExcess
from diagnose.forward import Signals
from diagnose.signals.phases import PHASES
from diagnose.signals.recording import Recording, Run
from diagnose.verdict.names import component_words, short_name
from geometry.arrays import Floats

RECORDED, BEFORE, AFTER, FULL, SOFT = "#26303a", "#b5263b", "#2f7a4d", "#d08a00", "#8a949e"
"""Colours: what was recorded, your simulation, with what was left out, by the full model, what matters less."""
CLOSEST = "#3a6ea8"
"""Colour of an explanation that is not named."""
WIDTH_IN, DPI = 8.0, 130


def new_figure(rows: int, columns: int, height_in: float, **subplots: Any) -> tuple[Any, Any]:
    """A figure and its panels (rows, columns)."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    engine = ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.05)
    figure = Figure(figsize=(WIDTH_IN, height_in), dpi=DPI, facecolor="white", layout=engine)
    panels = figure.subplots(rows, columns, squeeze=False, **subplots)
    for panel in panels.flat:
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelsize=9)
    return figure, panels


def save(figure: Any, path: Path) -> Path:
    """Write a PNG and return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path


EDGES_HZ = (0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, np.inf)
MOST_ROWS = 40


def draw_overview(recording: Recording, findings: Findings, path: Path) -> Path | None:
    """The share of the excess in each cell of run and channel by phase and band; None where no place stands out."""
    if not findings.places:
        return None
    from matplotlib.colors import PowerNorm

    rows = [(run.label, channel) for run in recording.runs for channel in run.answers][:MOST_ROWS]
    phases = list(PHASES)
    bands = sorted({band_of(place) for place in findings.places})
    tables = {phase: shares(findings.places, rows, phase, bands) for phase in phases}
    largest = max(float(np.nanmax(table, initial=0.0)) for table in tables.values())
    scale = PowerNorm(0.5, 0.0, largest or 1.0)  # the weak must show beside the strong
    figure, panels = new_figure(1, len(phases), 1.6 + 0.28 * len(rows), sharey=True)
    for panel, phase in zip(panels[0], phases, strict=True):
        image = panel.imshow(tables[phase], cmap="Reds", norm=scale, aspect="auto")
        panel.set_title(phase, fontsize=11)
        panel.set_xticks(range(len(bands)), [_band_text(band) for band in bands], rotation=60, fontsize=8)
        panel.set_yticks(range(len(rows)), [_row_text(*row) for row in rows], fontsize=8)
        panel.tick_params(length=0)
        panel.set_facecolor("#eef0f2")
        panel.spines[:].set_visible(False)
    figure.supxlabel("frequency (Hz)", fontsize=10)
    bar = figure.colorbar(image, ax=list(panels[0]), pad=0.01, aspect=30)
    bar.set_label("share of all excess (%)", fontsize=10)
    return save(figure, path)


def shares(
    places: Sequence[LocatedExcess], rows: Sequence[tuple[str, str]], phase: str, bands: Sequence[int]
) -> Floats:
    """Per cent, (rows, bands), summed over presses; NaN where nothing stands out."""
    table = np.full((len(rows), len(bands)), np.nan)
    for place in places:
        if place.phase == phase and (place.run, place.channel) in rows:
            cell = rows.index((place.run, place.channel)), bands.index(band_of(place))
            table[cell] = np.nansum([table[cell], 100.0 * place.share])
    return table


def band_of(place: LocatedExcess) -> int:
    """Number of the column that holds the (logarithmic) middle of a band."""
    low, high = place.band_Hz
    middle = float(np.sqrt(max(low, 0.25 * high) * high)) if np.isfinite(high) else low
    return int(np.searchsorted(EDGES_HZ, middle, side="right")) - 1


def _band_text(band: int) -> str:
    low, high = EDGES_HZ[band], EDGES_HZ[band + 1]
    return f"< {high:g}" if low == 0.0 else f"> {low:g}" if np.isinf(high) else f"{low:g}–{high:g}"


def _row_text(run: str, channel: str) -> str:
    short = run if len(run) <= 24 else f"{run[:23]}…"
    return f"{short} · {channel.rpartition('_')[0].replace('_', ' ')}"


MOST_CHANNELS = 4
SIGMAS = 2.0


def draw_run(run: Run, findings: Findings, full: Signals | None, path: Path) -> Path:
    """For each channel the signals above and the residuals below, with a band of two sigma of the noise.

    full : by the full model, where it pressed this run again.
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
    """The channels to draw, in the order of the recording; of many those with the largest residual over noise."""
    sizes = {
        name: np.nanmean((run.channels[name] - findings.baseline[run.label][name]) ** 2)
        / _rms(run, name, findings) ** 2
        for name in run.answers
    }
    chosen = sorted(sizes, key=lambda name: -float(sizes[name]))[:MOST_CHANNELS]
    return [name for name in run.answers if name in chosen]


def _rms(run: Run, channel: str, findings: Findings) -> float:
    noise = findings.detection.noise.get((run.label, channel), {})
    return float(noise.get("rms", 1.0)) or 1.0


def _draw_signals(panel: Any, run: Run, channel: str, findings: Findings, full: Signals | None) -> None:
    panel.plot(run.time_s, _shown(run, channel), color=RECORDED, lw=2.6, alpha=0.45, label="recorded")
    for colour, values in _models(run, channel, findings).items():
        panel.plot(run.time_s, values, color=colour, lw=1.2, label=MODELS[colour])
    if full is not None and channel in full:
        panel.plot(run.time_s, full[channel], color=FULL, lw=2.0, ls=":", label="the same with the full model")
    panel.set_ylabel(_axis(channel), fontsize=10)
    limits = [_shown(run, channel), *_models(run, channel, findings).values()]
    low, high = (f(np.concatenate(limits)) for f in (np.nanmin, np.nanmax))
    panel.set_ylim(low - 0.06 * (high - low), high + 0.06 * (high - low))


def _draw_residuals(panel: Any, run: Run, channel: str, findings: Findings) -> None:
    band = SIGMAS * _rms(run, channel, findings)
    panel.axhspan(-band, band, color=SOFT, alpha=0.35, lw=0)
    for colour, values in _models(run, channel, findings).items():
        panel.plot(run.time_s, _shown(run, channel) - values, color=colour, lw=0.8)
    panel.set_ylabel("recorded\n− simulated", fontsize=9)
    panel.set_xlabel("time (s)", fontsize=10)


MODELS = {BEFORE: "your simulation", AFTER: "with what was left out", CLOSEST: "closest explanation, not named"}


def _models(run: Run, channel: str, findings: Findings) -> Mapping[str, Floats]:
    """Colour -> signal of each model."""
    closest = findings.closest if findings.comes_closer else None
    each = {BEFORE: findings.baseline, AFTER: findings.improved, CLOSEST: closest}
    return {colour: signals[run.label][channel] for colour, signals in each.items() if signals is not None}


def _shown(run: Run, channel: str) -> Floats:
    """Recorded samples, NaN where they were not used."""
    return np.where(run.usable(channel), run.channels[channel], np.nan)


def _axis(channel: str) -> str:
    name, _, unit = channel.rpartition("_")
    return f"{name.replace('_', ' ')} ({unit})"


MOST = 10


def draw_gains(findings: Findings, path: Path) -> Path | None:
    """Held-out gain of each fitted model over your simulation, with its lower bound; None where none was fitted."""
    models = findings.models[:MOST]
    if not models:
        return None
    names = [short_name([setting.candidate for setting in model.settings]) for model in models]
    gains = [model.gain for model in models]
    colours = [_colour(model, findings) for model in models]
    if findings.black_box_gain:  # over the best model
        names, colours = [*names, "black box"], [*colours, SOFT]
        gains = [*gains, models[0].gain + findings.black_box_gain]
    drawing, panels = new_figure(1, 1, 0.9 + 0.3 * len(names))
    panel = panels[0, 0]
    panel.barh(names, gains, color=colours, height=0.62)
    for row, model in enumerate(models):
        panel.plot([model.gain_lower, model.gain], [row, row], color=RECORDED, lw=1.4, marker="|", ms=7)
    panel.invert_yaxis()
    panel.axvline(0.0, color=RECORDED, lw=0.8)
    panel.set_xscale("symlog", linthresh=1.0)
    panel.set_xlabel("gain on held-out presses (nats per press, logarithmic beyond 1)", fontsize=10)
    return save(drawing, path)


def _colour(model: FittedModel, findings: Findings) -> str:
    return AFTER if model is findings.best else "#b9cfe0"


def draw_shares(findings: Findings, path: Path) -> Path | None:
    """Share of the excess that belongs to each component; None where none was told apart."""
    shares = sorted(((share, name) for name, share in findings.shares.items() if share > 0.0), reverse=True)
    if not shares:
        return None
    drawing, panels = new_figure(1, 1, 0.9 + 0.3 * len(shares))
    panel = panels[0, 0]
    drawn = panel.barh(
        [component_words(name) for _, name in shares], [100.0 * share for share, _ in shares], color=BEFORE
    )
    panel.bar_label(drawn, [f"{figure(100.0 * share)} %" for share, _ in shares], fontsize=9, padding=3)
    panel.invert_yaxis()
    panel.margins(x=0.12)
    panel.set_xlabel("share of all excess (%)", fontsize=10)
    return save(drawing, path)
