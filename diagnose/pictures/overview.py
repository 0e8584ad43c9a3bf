"""Picture of where the simulation is off: runs by phases and frequencies."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from diagnose.findings import Findings, LocatedExcess
from diagnose.pictures.style import new_figure, save
from diagnose.signals.phases import PHASES
from diagnose.signals.recording import Recording
from foundation.arrays import Floats

BAND_EDGES_HZ = (0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, np.inf)
MOST_ROWS, LABEL_CHARACTERS = 40, 24


def draw_overview(recording: Recording, findings: Findings, path: Path) -> Path | None:
    """Draw the share of the excess in each cell of run and channel by phase and band; None without a place."""
    if not findings.places:
        return None
    from matplotlib.colors import PowerNorm

    whole = [(run.label, channel) for run in recording.runs for channel in run.answers]
    rows = whole[:MOST_ROWS]
    labels = dict(
        zip((run.label for run in recording.runs), short_labels([run.label for run in recording.runs]), strict=True)
    )
    phases = list(PHASES)
    bands = sorted({band_number(place) for place in findings.places})
    tables = {phase: excess_percent(findings.places, rows, phase, bands) for phase in phases}
    largest = max(float(np.nanmax(table, initial=0.0)) for table in tables.values())
    scale = PowerNorm(0.5, 0.0, largest or 1.0)  # the weak must show beside the strong
    figure, panels = new_figure(1, len(phases), 1.6 + 0.28 * len(rows), sharey=True)
    for panel, phase in zip(panels[0], phases, strict=True):
        image = panel.imshow(tables[phase], cmap="Reds", norm=scale, aspect="auto")
        panel.set_title(phase, fontsize=11)
        panel.set_xticks(range(len(bands)), [_band_text(band) for band in bands], rotation=60, fontsize=8)
        panel.set_yticks(range(len(rows)), [_row_text(labels[run], channel) for run, channel in rows], fontsize=8)
        panel.tick_params(length=0)
        panel.set_facecolor("#eef0f2")
        panel.spines[:].set_visible(False)
    cut = "" if rows == whole else f"; the first {len(rows)} of {len(whole)} rows"
    figure.supxlabel(f"frequency (Hz){cut}", fontsize=10)
    bar = figure.colorbar(image, ax=list(panels[0]), pad=0.01, aspect=30)
    bar.set_label("share of all excess (%)", fontsize=10)
    return save(figure, path)


def excess_percent(
    places: Sequence[LocatedExcess], rows: Sequence[tuple[str, str]], phase: str, bands: Sequence[int]
) -> Floats:
    """Excess in per cent (rows, bands), summed over presses; NaN where nothing stands out."""
    table = np.full((len(rows), len(bands)), np.nan)
    for place in places:
        if place.phase == phase and (place.run, place.channel) in rows:
            cell = rows.index((place.run, place.channel)), bands.index(band_number(place))
            table[cell] = np.nansum([table[cell], 100.0 * place.share])
    return table


def band_number(place: LocatedExcess) -> int:
    """Number of the column that holds the (logarithmic) middle of a place's band."""
    low, high = place.band_Hz
    middle = float(np.sqrt(max(low, 0.25 * high) * high)) if np.isfinite(high) else low
    return int(np.searchsorted(BAND_EDGES_HZ, middle, side="right")) - 1


def _band_text(band: int) -> str:
    low, high = BAND_EDGES_HZ[band], BAND_EDGES_HZ[band + 1]
    return f"< {high:g}" if low == 0.0 else f"> {low:g}" if np.isinf(high) else f"{low:g}–{high:g}"


def short_labels(labels: Sequence[str]) -> list[str]:
    """Labels of at most LABEL_CHARACTERS, which differ where the whole ones do: numbered where what is cut made the
    difference.
    """
    cut = [label if len(label) <= LABEL_CHARACTERS else f"{label[: LABEL_CHARACTERS - 1]}…" for label in labels]
    numbered = [f"{number} {label}" for number, label in enumerate(cut, 1)]
    return numbered if len(set(cut)) < len(set(labels)) else cut


def _row_text(run: str, channel: str) -> str:
    return f"{run} · {channel.rpartition('_')[0].replace('_', ' ')}"
