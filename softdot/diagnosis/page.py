"""report.html and plots: the verdict in sentences, then the evidence, in one file that opens offline."""

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diagnose.findings import Findings
from diagnose.recording import Recording
from diagnose.report.bars import draw_gains, draw_shares
from diagnose.report.overview import draw_overview
from diagnose.report.series import draw_run
from diagnose.verdict.names import component_words, mechanism_words, quantity_words, unit_words
from diagnose.verdict.resimulation import Resimulated
from diagnose.verdict.words import Sentence
from export.files import write_whole_text
from export.page.environment import page_environment
from export.report import number
from softdot.version import installed_version

HERE = Path(__file__).parent
MOST_RUNS = 4
MOST_SCREENED = 12


@dataclass(frozen=True)
class Picture:
    """A PNG with its caption. section : of the page."""

    section: str
    path: Path
    title: str
    text: str


def write_evidence(
    recording: Recording,
    findings: Findings,
    told: Sequence[Sentence],
    summary: dict[str, Any],
    resimulated: Sequence[Resimulated],
    folder: Path,
) -> None:
    """folder/plots/*.png and folder/report.html. summary : content of verdict.json in plain data."""
    environment = page_environment(HERE)
    environment.filters |= {
        "number": lambda value: number(value, 3), "where": component_words, "unit": unit_words,
        "percent": lambda value: number(value if value is None else 100.0 * value, 2),
    }  # fmt: skip
    environment.globals |= {"what": mechanism_words, "quantity": quantity_words}
    pictures = list(_pictures(recording, findings, resimulated, folder / "plots"))
    page = environment.get_template("report.html").render(
        v=summary,
        version=installed_version(),
        verdict_class=_verdict_class(findings),
        title=_title(findings),
        told=told,
        pictures=[(picture, base64.b64encode(picture.path.read_bytes()).decode("ascii")) for picture in pictures],
        screened=summary["screened"][:MOST_SCREENED],
        noise=_noise_rows(summary),
    )
    write_whole_text(folder / "report.html", page)


def _verdict_class(findings: Findings) -> str:
    if not findings.mismatch:
        return "good"
    return "unknown" if findings.unexplained or findings.best is None else "found"


def _title(findings: Findings) -> str:
    titles = {
        "good": "Simulation and recordings agree",
        "unknown": "A mismatch that no known mechanism explains",
        "found": "What your simulation left out",
    }
    return titles[_verdict_class(findings)]


def _pictures(
    recording: Recording, findings: Findings, resimulated: Sequence[Resimulated], folder: Path
) -> Iterator[Picture]:
    overview = draw_overview(recording, findings, folder / "where.png")
    if overview is not None:
        text = (
            "Each cell is one phase of the presses in one range of frequencies; the redder, the more of the excess. "
            "Grey cells are no more than noise."
        )
        yield Picture("where", overview, "Where recording and simulation differ", text)
    shares = draw_shares(findings, folder / "components.png") if findings.mismatch else None
    if shares is not None:
        text = "As far as the model's answer to each part looks like the excess."
        yield Picture("where", shares, "Which part the excess looks like", text)
    for count, (label, full) in enumerate(runs_to_draw(recording, findings, resimulated), start=1):
        path = draw_run(recording.run(label), findings, full, folder / f"run-{count}.png")
        text = "Above: signals. Below: what is left, with a grey band of two sigma of the noise."
        yield Picture("runs", path, f"Run “{label}”", text)
    gains = draw_gains(findings, folder / "gains.png") if findings.mismatch else None
    if gains is not None:
        text = (
            "How much better each explanation predicts presses that it was not fitted to, than your simulation does; "
            "black lines go to the lower bound. The black box knows no mechanics."
        )
        yield Picture("gains", gains, "Which explanation predicts", text)


def runs_to_draw(recording: Recording, findings: Findings, resimulated: Sequence[Resimulated]) -> list[tuple[str, Any]]:
    """Labels and signals of the full model: runs that were pressed again, then those with the largest excess."""
    pressed = {one.run: one.signals for one in resimulated}
    excess = {run.label: 0.0 for run in recording.runs}
    for place in findings.places:
        excess[place.run] += place.share
    others = sorted((label for label in excess if label not in pressed), key=lambda label: -excess[label])
    return [(label, pressed.get(label)) for label in [*pressed, *others]][:MOST_RUNS]


def _noise_rows(summary: dict[str, Any]) -> list[tuple[str, str, dict[str, Any]]]:
    noise = summary["detection"]["noise_model"]
    return [(label, channel, its) for label, channels in noise.items() for channel, its in channels.items()]
