"""What one part of the study hands to the report, how its figures are drawn, and how its presses are solved."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from geometry.executor import Executor
from softdot.config import Config
from softdot.console import Progress

Cell = str | float | int | bool | None


@dataclass(frozen=True)
class Heading:
    """A title inside a section."""

    text: str


@dataclass(frozen=True)
class PaperTable:
    """A table of the page, written as tables/<name>.csv too. Units stand in the headers."""

    name: str
    """Lower case with hyphens, unique in the study."""
    title: str
    headers: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    note: str = ""
    """What a reader must know to read it; shown beneath."""


@dataclass(frozen=True)
class Figure:
    """A PNG that the part has written into folder / "figures"."""

    path: Path
    title: str
    caption: str
    """One or two sentences: what is drawn and what to see in it."""


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, or about it, put to the test."""

    text: str
    holds: bool | None
    """None: what we have does not decide it."""
    evidence: str
    """The numbers that decide, in one sentence."""
    reading: str = ""
    """Which reading of the paper was tested, where there are several; give these claims the same text."""


@dataclass(frozen=True)
class Answer:
    """Our value of a published number, in the unit of published.toml."""

    ours: float | None
    """None: it cannot be calculated; the remark says why."""
    remark: str = ""


Block = str | Heading | PaperTable | Figure


@dataclass(frozen=True)
class Section:
    """One part of the study. Text is plain; the page escapes it. A str block is one paragraph."""

    name: str
    """Key of the numbers in paper.json: lower case with hyphens."""
    title: str
    findings: Sequence[str]
    """One to three sentences for the top of the page, for a reader who does not know the paper."""
    blocks: Sequence[Block]
    numbers: Mapping[str, Any]
    """Everything that was calculated, for paper.json; units in the keys."""
    claims: Sequence[Claim] = ()
    answers: Mapping[str, Answer] = field(default_factory=dict)
    """Key of published.toml -> our value, for the table of every published number."""

    @property
    def tables(self) -> list[PaperTable]:
        """The tables among the blocks."""
        return [block for block in self.blocks if isinstance(block, PaperTable)]

    @property
    def figures(self) -> list[Figure]:
        """The figures among the blocks."""
        return [block for block in self.blocks if isinstance(block, Figure)]


FREE, CLAMPED, PAPER, SOFT = "#33658a", "#b5263b", "#26303a", "#8a949e"
"""Colours: free sides, clamped sides, the paper's own values, what matters less."""
LAYER_COLOURS = {"effector": "#e7cfa3", "medium1": "#9dbf9e", "film": "#b5263b", "medium2": "#b9cfe0"}
WIDTH_IN, HEIGHT_IN, DPI = 8.0, 3.6, 130


def new_figure(columns: int = 1, height_in: float = HEIGHT_IN, width_in: float = WIDTH_IN) -> tuple[Any, list[Any]]:
    """A figure and its axes, side by side."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    engine = ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.08)
    figure = Figure(figsize=(width_in, height_in), dpi=DPI, facecolor="white", layout=engine)
    panels = list(figure.subplots(1, columns, squeeze=False)[0])
    for panel in panels:
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelsize=10)
    return figure, panels


def label(panel: Any, below: str, beside: str, title: str = "") -> None:
    """Axis labels, and a title at the left."""
    panel.set_xlabel(below, fontsize=11)
    panel.set_ylabel(beside, fontsize=11)
    if title:
        panel.set_title(title, fontsize=11, loc="left")


def bars(panel: Any, names: list[str], heights: list[float], colours: list[str], text: str = "{:.3g}") -> None:
    """Bars with their value on top and room above it."""
    drawn = panel.bar(names, heights, color=colours, width=0.62)
    panel.bar_label(drawn, [text.format(height) for height in heights], fontsize=9, padding=2)
    panel.margins(y=0.18)


def save(figure: Any, folder: Path, name: str) -> Path:
    """Write folder/figures/name.png and return its path."""
    path = folder / "figures" / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path


Name = TypeVar("Name", bound=Hashable)


class NotSolvedError(Exception):
    """A press of the study gave no result; the message names it in one sentence."""


def solve_named(configs: Mapping[Name, Config], progress: Progress, executor: Executor) -> dict[Name, dict[str, Any]]:
    """Name -> outcome of every press, solved by an executor or remembered. NotSolvedError when one has none."""
    from softdot.sweeps.points import solve_points

    records = dict(zip(configs, solve_points(list(configs.values()), progress, executor=executor), strict=True))
    for name, record in records.items():
        if record["status"] != "solved":
            raise NotSolvedError(f"{_text(name)}: {record['status']}, {record['reason']}")
    return records


def _text(name: Hashable) -> str:
    return ", ".join(map(str, name)) if isinstance(name, tuple) else str(name)
