"""What one part of the study hands to the report: headings, tables, figures, claims and answers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

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
