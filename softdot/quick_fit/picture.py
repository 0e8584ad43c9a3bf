"""Picture of a quick fit: recorded and fitted voltages of every run, and below them what is left, over the noise."""

from pathlib import Path

import numpy as np

from diagnose.pictures.style import AFTER, RECORDED, SOFT, new_figure, save
from softdot.quick_fit.readout import ReadoutFit

RUN_HEIGHT_IN, MOST_RUNS = 2.6, 12
BAND = 2.0


def draw_residuals(fit: ReadoutFit, path: Path) -> None:
    """Draw the first channel of each run; of many runs the first MOST_RUNS."""
    runs = fit.recording.runs[:MOST_RUNS]
    figure, panels = new_figure(len(runs), 2, RUN_HEIGHT_IN * len(runs), sharex="row")
    for run, (above, left) in zip(runs, panels, strict=True):
        name = run.voltages[0]
        there = run.usable(name)
        recorded = np.where(there, run.channels[name], np.nan)
        shown = fit.shown[run.label][name]
        above.plot(run.time_s, recorded, color=RECORDED, lw=2.4, alpha=0.45, label="recorded")
        above.plot(run.time_s, shown, color=AFTER, lw=1.2, label="fit")
        above.set_ylabel(f"{name.removesuffix('_V')} (V)", fontsize=9)
        above.set_title(run.label, fontsize=9, loc="left")
        noise = fit.noise_rms[run.label, name]
        left.axhspan(-BAND, BAND, color=SOFT, alpha=0.25, lw=0)
        left.plot(run.time_s, (recorded - shown) / noise, color=RECORDED, lw=0.8)
        left.set_ylabel("left / noise", fontsize=9)
    panels[0, 0].legend(frameon=False, fontsize=8)
    for panel in panels[-1]:
        panel.set_xlabel("time (s)", fontsize=9)
    save(figure, path)
