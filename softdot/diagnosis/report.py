"""The evidence of a diagnosis: report.html, with the verdict in sentences and its grounds, and plots."""

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diagnose.figures import figure, p_alone, percent, probability
from diagnose.findings import Findings, FittedModel, Grade
from diagnose.pictures.evidence import draw_gains, draw_shares
from diagnose.pictures.overview import draw_overview
from diagnose.pictures.run import draw_run
from diagnose.signals.recording import Recording
from diagnose.verdict.names import (
    component_words,
    interval_figures,
    interval_remark,
    mechanism_words,
    model_words,
    quantity_words,
    setting_words,
    unit_words,
)
from diagnose.verdict.resimulation import Resimulation
from diagnose.verdict.words import Sentence, detection_p_value, separation_words
from export.page import page_environment
from foundation.files import write_whole_text
from softdot.version import installed_version

HERE = Path(__file__).parent
MOST_DRAWN_RUNS = 4
MOST_SCREENED_ROWS = 12


@dataclass(frozen=True)
class Picture:
    """A picture of the report as PNG, with its caption and the section of the page that shows it."""

    section: str
    path: Path
    title: str
    text: str


def write_evidence(
    recording: Recording,
    findings: Findings,
    told: Sequence[Sentence],
    summary: dict[str, Any],
    resimulated: Sequence[Resimulation],
    folder: Path,
) -> None:
    """Write folder/plots/*.png and folder/report.html. summary : content of verdict.json in plain data."""
    pictures = list(_pictures(recording, findings, resimulated, folder / "plots"))
    write_whole_text(folder / "report.html", page_text(findings, told, summary, pictures))


def page_text(
    findings: Findings, told: Sequence[Sentence], summary: dict[str, Any], pictures: Sequence[Picture]
) -> str:
    """The text of report.html. Numbers are printed by diagnose.figures, as in the sentences of the verdict."""
    environment = page_environment(HERE)
    environment.filters |= {
        "figure": figure, "percent": percent, "p_value": p_alone, "probability": probability, "where": component_words
    }  # fmt: skip
    environment.globals |= {"what": mechanism_words, "separation": separation_words}
    return environment.get_template("verdict.html").render(
        v=summary,
        version=installed_version(),
        verdict_class=HEADLINES[findings.grade][0],
        title=_title(findings),
        told=told,
        detected=detection_p_value(findings),
        parameters=list(_parameter_rows(findings.best)) if findings.best else [],
        explanations=_explanation_rows(findings),
        pictures=[(picture, base64.b64encode(picture.path.read_bytes()).decode("ascii")) for picture in pictures],
        screened=summary["screened"][:MOST_SCREENED_ROWS],
        noise=_noise_rows(summary),
    )


def _parameter_rows(best: FittedModel) -> Iterator[list[str]]:
    """Rows of the table of parameters: mechanism, quantity, value, low, high, unit and remark."""
    for setting, intervals in zip(best.settings, best.parameters, strict=True):
        what = setting_words(setting)
        for name, interval in intervals.items():
            value, low, high = interval_figures(interval)
            ends = ["–", "–"] if interval.fixed else [low, high]
            unit, remark = unit_words(interval.unit), interval_remark(interval)
            yield [what, quantity_words(name, interval.unit), value, *ends, unit, remark]
            what = ""
        if not intervals:
            yield [what, "–", "–", "–", "–", "", "has no parameter"]


def _explanation_rows(findings: Findings) -> list[tuple[bool, str, FittedModel]]:
    """Rows of the explanations: whether each is the named one, its words, and the model."""
    return [(model is findings.best, model_words(model), model) for model in findings.models]


HEADLINES = {
    Grade.AGREEMENT: ("good", "Simulation and recordings agree"),
    Grade.IDENTIFIED: ("found", "What your simulation left out"),
    Grade.MAIN_PART: ("found", "Most of what your simulation left out"),
    Grade.KIND_ONLY: ("unknown", "What kind of thing your simulation left out"),
    Grade.UNEXPLAINED: ("unknown", "Simulation and recordings differ, and no known mechanism explains it"),
}
"""Grade -> class of the box of the verdict, and headline of the page."""
AMBIGUOUS_HEADLINE = "Simulation and recordings differ, and several known mechanisms explain it alike"


def _title(findings: Findings) -> str:
    several = findings.ambiguous and findings.grade is Grade.UNEXPLAINED
    return AMBIGUOUS_HEADLINE if several else HEADLINES[findings.grade][1]


def _pictures(
    recording: Recording, findings: Findings, resimulated: Sequence[Resimulation], folder: Path
) -> Iterator[Picture]:
    overview = draw_overview(recording, findings, folder / "where.png")
    if overview is not None:
        text = (
            "Each cell is one phase of the presses in one band of frequencies; the redder it is, the larger its share "
            "of the excess over noise. Grey cells show no more than noise."
        )
        yield Picture("where", overview, "Where recording and simulation differ", text)
    shares = draw_shares(findings, folder / "components.png") if findings.mismatch else None
    if shares is not None:
        text = "How much of the excess over noise has the shape that a change of each part would give it."
        yield Picture("where", shares, "Which part the excess resembles", text)
    for count, (label, full) in enumerate(runs_to_draw(recording, findings, resimulated), start=1):
        path = draw_run(recording.run(label), findings, full, folder / f"run-{count}.png")
        text = "Top: signals. Bottom: residuals, with a grey band of two standard deviations of the noise."
        yield Picture("runs", path, f"Run “{label}”", text)
    gains = draw_gains(findings, folder / "gains.png") if findings.mismatch else None
    if gains is not None:
        text = (
            "How much better each explanation predicts held-out presses than your simulation does. Black lines reach "
            "down to the lower bound. The black box is a flexible model without mechanics."
        )
        yield Picture("gains", gains, "Which explanation predicts best", text)


def runs_to_draw(
    recording: Recording, findings: Findings, resimulated: Sequence[Resimulation]
) -> list[tuple[str, Any]]:
    """Label and signals of the full model for the runs pressed again; then labels of those with the largest excess."""
    pressed = {one.run: one.signals for one in resimulated}
    excess = {run.label: 0.0 for run in recording.runs}
    for place in findings.places:
        excess[place.run] += place.share
    others = sorted((label for label in excess if label not in pressed), key=lambda label: -excess[label])
    return [(label, pressed.get(label)) for label in [*pressed, *others]][:MOST_DRAWN_RUNS]


def _noise_rows(summary: dict[str, Any]) -> list[tuple[str, str, dict[str, Any]]]:
    noise = summary["detection"]["noise_model"]
    return [(label, channel, its) for label, channels in noise.items() for channel, its in channels.items()]
