"""Pictures of the evidence: which explanation predicts held-out presses, which component the excess belongs to."""

from pathlib import Path

from diagnose.figures import figure
from diagnose.findings import Findings, FittedModel
from diagnose.pictures.style import AFTER, BEFORE, RECORDED, SOFT, new_figure, save
from diagnose.verdict.names import component_words, short_name

MOST_BARS = 10


def draw_gains(findings: Findings, path: Path) -> Path | None:
    """Draw the held-out gain of each fitted model over your simulation, with its lower bound; None without a model."""
    models = findings.models[:MOST_BARS]
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
    """Draw the share of the excess that belongs to each component; None where no component stands out."""
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
