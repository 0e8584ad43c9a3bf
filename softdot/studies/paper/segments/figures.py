"""The paper's Figs. 7, 8 and 10 again, forces, and voltage against depth."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from softdot.studies.paper.drawing import CLAMPED, FREE, PAPER, bars, label, new_figure, save
from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.segments.answers import FORCE_CASES
from softdot.studies.paper.segments.cases import ADDED_PAIRS, CASES, LATER_PAIRS, title, together
from softdot.studies.paper.segments.presses import SolvedPress, Study
from softdot.studies.paper.segments.trends import READING_NAMES

Presses = Mapping[str, SolvedPress]
COLOURS = {"free": FREE, "clamped": CLAMPED}
RATE = "voltage over 337 per depth (V/mm)"


def draw_cases(study: Study, names: Sequence[str], folder: Path, name: str) -> Path:
    """One bar a case, as in the paper's Figs. 7 and 8; both readings."""
    figure, panels = new_figure(2)
    for panel, (reading, presses) in zip(panels, study.readings.items(), strict=True):
        heights = [presses[case].calibrated_V_per_mm for case in names]
        bars(panel, list(names), heights, [COLOURS[CASES[case].boundary] for case in names], "{:.2g}")
        label(panel, "case", RATE if panel is panels[0] else "", READING_NAMES[reading])
    return save(figure, folder, name)


def draw_selected(study: Study, folder: Path) -> Path:
    """Free and clamped voltage of the selected designs, as in the paper's Fig. 10."""
    figure, panels = new_figure(2, height_in=4.0)
    for panel, (reading, presses) in zip(panels, study.readings.items(), strict=True):
        _draw_stacked_bars(panel, presses)
        label(panel, "layers", "voltage over 337 (mV)" if panel is panels[0] else "", READING_NAMES[reading])
        panel.axhline(
            published_numbers()["section4.criterion"].value, color=PAPER, lw=1, ls=":", label="50 mV criterion"
        )
    _draw_printed_sums(panels[0])
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False)
    return save(figure, folder, "fig10-selected")


def _draw_stacked_bars(panel: Any, presses: Presses) -> None:
    """Draw the calibrated voltage of a clamped case on that of a free one, pair by pair."""
    pairs = [*ADDED_PAIRS, *LATER_PAIRS]
    names = [together(pair).replace(" + ", "\n+ ").replace(" at ", "\nat ") for pair in pairs]
    free = [presses[pair[1]].calibrated_mV for pair in pairs]
    clamped = [presses[pair[0]].calibrated_mV for pair in pairs]
    panel.bar(names, free, color=FREE, width=0.6, label="free")
    panel.bar(names, clamped, bottom=free, color=CLAMPED, width=0.6, label="clamped")
    panel.margins(y=0.1)
    panel.tick_params(axis="x", labelsize=9)


def _draw_printed_sums(panel: Any) -> None:
    """Draw the sums that the paper states."""
    numbers = published_numbers()
    sums = [numbers[f"section4.sum.{'+'.join(pair)}"].value for pair in ADDED_PAIRS]
    final = sum(numbers[f"fig10.{name}"].value for name in LATER_PAIRS[1])
    panel.plot([0, 1, 2, 4], [*sums, final], "D", color=PAPER, ms=7, mfc="white", mew=1.6, label="paper, sum")


def draw_forces(study: Study, folder: Path) -> Path:
    """The six forces that the paper states, and ours."""
    figure, (panel,) = new_figure()
    presses = study.readings["plane-strain"]
    names = [title(name).replace(" ", "\n", 1) for name in FORCE_CASES]
    colours = [COLOURS[CASES[name].boundary] for name in FORCE_CASES]
    bars(panel, names, [presses[name].force_N for name in FORCE_CASES], colours)
    paper = [published_numbers()[f"section4.force.{name}"].value for name in FORCE_CASES]
    beside = [place + 0.41 for place in range(len(names))]
    panel.plot(beside, paper, "D", color=PAPER, ms=7, mfc="white", mew=1.6, label="paper")
    label(panel, "", "force at 0.3 mm (N)", READING_NAMES["plane-strain"])
    panel.legend(frameon=False, fontsize=10, loc="upper left")
    return save(figure, folder, "forces")


def draw_depth(study: Study, folder: Path) -> Path:
    """Voltage against depth on logarithmic axes: the slope is the exponent."""
    figure, panels = new_figure(2)
    for panel, (reading, presses) in zip(panels, study.readings.items(), strict=True):
        for name, style in {"F1": "o--", "final-free": "s-", "C1": "o--", "final-clamped": "s-"}.items():
            press = presses[name]
            words = f"{title(name)} (n = {press.exponent:.1f})"
            colour = COLOURS[CASES[name].boundary]
            panel.loglog(press.depth_mm[1:], press.voltage_history_V[1:], style, color=colour, ms=4, label=words)
        panel.set_xticks([0.1, 0.2, 0.3], ["0.1", "0.2", "0.3"])
        panel.minorticks_off()
        label(panel, "depth (mm)", "open-circuit voltage (V)" if panel is panels[0] else "", READING_NAMES[reading])
        panel.legend(frameon=False, fontsize=9)
    return save(figure, folder, "voltage-against-depth")
