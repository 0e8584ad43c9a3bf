"""The folder of a quick fit: a table as text, the same as JSON, and a picture of what is left."""

from pathlib import Path
from typing import Any

import numpy as np

from foundation.cache import check_cache_folder
from softdot.config.rig import load_rig
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.quick_fit.readout import ReadoutFit, fit_readout

FIT = Product("softdot-fit/1", "fit.json", frozenset({"fit.json", "fit.txt", "residuals.png"}))
CORRELATED, MISFIT = 0.1, 1.5
"""Correlations from which the table shows them; what is left over the noise from which the fit is doubted."""


def run_fit(recording: Path, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Fit the read-out to a recording into the folder out; the content of fit.json. InputError, NoEquilibriumError."""
    from softdot.quick_fit.picture import draw_residuals

    progress = progress or Logged()
    check_cache_folder()
    rig = load_rig(recording)
    with staged_folder(out, FIT) as folder:
        progress.stage("baseline")
        fit = fit_readout(rig, lambda what, done, count: progress.step(done, count, what))
        progress.stage("write")
        (folder / "fit.txt").write_text(table_text(fit) + "\n", "utf-8")
        draw_residuals(fit, folder / "residuals.png")
        summary: dict[str, Any] = plain({"format": FIT.format, **_content(fit), "text": table_text(fit)})
        write_json(folder / FIT.summary, summary)
    return summary


def _content(fit: ReadoutFit) -> dict[str, Any]:
    rows = zip(fit.names, fit.values, fit.sigmas, fit.priors, strict=True)
    return {
        "only": "readout",
        "samples": fit.samples,
        "misfit": fit.misfit,
        "parameters": [
            {"name": name, "value": value, "sigma": sigma, "prior_sigma": prior} for name, value, sigma, prior in rows
        ],
        "intervals": {
            name: {"low": one.low, "high": one.high, "unit": one.unit} for name, one in fit.intervals.items()
        },
        "stated": fit.stated,
        "correlation": fit.correlation,
        "warnings": warnings(fit),
    }


def warnings(fit: ReadoutFit) -> list[str]:
    """What is to be doubted, a sentence each."""
    told = []
    if fit.misfit > MISFIT:
        told.append(
            f"what the fit leaves is {fit.misfit:.3g} times the noise: something else than the read-out is different "
            "too, and the values stand in for it; softdot diagnose looks for it"
        )
    rows = zip(fit.names, fit.values, fit.priors, strict=True)
    strained = [f"{name} = {value:.3g}" for name, value, prior in rows if abs(value) > 3.0 * prior]
    if strained:
        told.append(f"more than three of the stated widths from 0: {', '.join(strained)}")
    return told


def table_text(fit: ReadoutFit) -> str:
    """The fit as a table: statistics, variables, correlations."""
    largest = max(map(len, fit.names))
    lines = [
        "[[Fit statistics]]",
        f"    data points       = {fit.samples}",
        f"    variables         = {len(fit.names)}",
        f"    left over noise   = {fit.misfit:.4g} (1: noise alone)",
        "[[Variables]]",
    ]
    for name, value, sigma, prior in zip(fit.names, fit.values, fit.sigmas, fit.priors, strict=True):
        lines.append(f"    {name + ':':<{largest + 1}}  {value:.6g} +/- {sigma:.2g}{_remark(fit, name, prior)}")
    lines.append(f"[[Correlations]] (unreported correlations are < {CORRELATED:.3f})")
    lines += _correlations(fit, largest)
    return "\n".join([*lines, *(f"[[Warning]] {one}" for one in warnings(fit))])


def _remark(fit: ReadoutFit, name: str, prior: float) -> str:
    """Interval and stated value of R and C; the width of the others."""
    if name not in fit.intervals:
        return f" (prior 0 +/- {prior:.2g})"
    one = fit.intervals[name]
    percent = f"{50.0 * (one.high - one.low) / one.value:.2g} %, " if one.value else ""
    stated = fit.stated[name]
    told = "none" if np.isinf(stated) else f"{stated:.6g}"
    return f" ({percent}90 % interval {one.low:.6g} to {one.high:.6g} {one.unit}; rig.toml: {told})"


def _correlations(fit: ReadoutFit, largest: int) -> list[str]:
    """Pairs by the size of their correlation."""
    upper = [(i, j) for i in range(len(fit.names)) for j in range(i + 1, len(fit.names))]
    shown = [(i, j) for i, j in upper if abs(fit.correlation[i, j]) >= CORRELATED]
    shown.sort(key=lambda pair: -abs(fit.correlation[pair]))
    names = {pair: f"C({fit.names[pair[0]]}, {fit.names[pair[1]]})" for pair in shown}
    wide = max(map(len, names.values()), default=largest)
    return [f"    {name:<{wide}} = {fit.correlation[pair]:+.4f}" for pair, name in names.items()]
