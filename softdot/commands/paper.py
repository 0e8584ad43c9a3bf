"""softdot paper: the whole study, its parts one after the other, in one page that opens offline."""

import base64
import csv
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

from export.page import page_environment
from export.report import number
from geometry.executor import Executor
from geometry.files import write_whole_text
from softdot.console import (
    GOOD,
    NOT_CONVERGED,
    Logged,
    Progress,
    complain,
    installed_version,
    only_the_summary_on_stdout,
    plain,
    show,
    write_json,
)
from softdot.executors import executor_for
from softdot.output import Product, staged_folder
from softdot.studies.paper.published import Published, inconsistencies, published
from softdot.studies.paper.section import Answer, Block, Cell, Figure, Heading, PaperTable, Section


def command(chosen: Namespace) -> int:
    """Make the whole study in chosen.output; 0, or 3 when a press gave no result. InputError."""
    from softdot.console import progress_of
    from softdot.studies.paper.section import NotSolvedError

    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_paper(Path(chosen.output), progress, chosen.scheduler)
    except NotSolvedError as error:
        complain(f"paper, {error}; nothing was written, solved presses are cached")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The findings and where to look."""
    return "\n".join([*(f"- {finding}" for finding in summary["findings"]), f"{output}/paper.html"])


UNANSWERED = Answer(None, "not calculated here")


def answers(sections: Sequence[Section]) -> dict[str, Answer]:
    """Our value of every published number, by its key."""
    found = {key: answer for section in sections for key, answer in section.answers.items()}
    return {key: found.get(key, UNANSWERED) for key in published()}


def comparisons(sections: Sequence[Section]) -> list[dict[str, Any]]:
    """Every published number with ours, their ratio and the remark, for paper.json."""
    ours = answers(sections)
    return [
        {
            "key": key, "place": number.place, "quantity": number.quantity, "kind": number.kind,
            "unit": number.unit, "paper": number.value, "misprint": number.misprint,
            "ours": ours[key].ours, "ratio": _ratio(number, ours[key]), "remark": ours[key].remark,
        }
        for key, number in published().items()
    ]  # fmt: skip


def numbers_table(sections: Sequence[Section], kinds: Sequence[str], name: str, title: str) -> PaperTable:
    """The published numbers of some kinds."""
    return PaperTable(
        name,
        title,
        ["place", "quantity", "unit", "paper", "ours", "ours / paper", "remark"],
        [_row(entry) for entry in comparisons(sections) if entry["kind"] in kinds],
    )


def claims_table(sections: Sequence[Section]) -> PaperTable:
    """Every statement that was tested."""
    return PaperTable(
        "claims",
        "Statements of the paper, put to the test",
        ["statement", "reading", "holds", "evidence"],
        [[claim.text, claim.reading, _verdict(claim.holds), claim.evidence] for s in sections for claim in s.claims],
    )


def inconsistencies_table() -> PaperTable:
    """Slips and gaps of the paper."""
    return PaperTable(
        "misprints",
        "Misprints and gaps",
        ["place", "in the paper", "comment"],
        [[slip.place, slip.printed, slip.comment] for slip in inconsistencies()],
    )


def _row(entry: dict[str, Any]) -> list[Cell]:
    misprint = f"Misprint: {entry['misprint']}. " if entry["misprint"] else ""
    return [
        entry["place"], entry["quantity"], entry["unit"], entry["paper"], _short(entry["ours"]), _short(entry["ratio"]),
        (misprint + entry["remark"]).strip(),
    ]  # fmt: skip


def _ratio(number: Published, answer: Answer) -> float | None:
    return None if answer.ours is None or not number.value else answer.ours / number.value


def _verdict(holds: bool | None) -> Cell:
    return "undecided" if holds is None else holds


def _short(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.3g}")


HERE = Path(__file__).parent


def write_report(sections: Sequence[Section], path: Path) -> None:
    """Write the page with every section, figures within it. The file appears whole or not at all."""
    environment = page_environment(HERE)
    environment.filters["cell"] = cell
    page = environment.get_template("paper.html").render(
        version=installed_version(),
        sections=[_section(section) for section in sections],
        findings=[finding for section in sections for finding in section.findings],
        claims=_without_repeats(claims_table(sections)),
        results=numbers_table(sections, ("result",), "", ""),
        formulas=numbers_table(sections, ("formula",), "", ""),
        inputs=numbers_table(sections, ("input",), "", ""),
        slips=inconsistencies_table(),
    )
    write_whole_text(path, page)


def cell(value: Any) -> str:
    """A cell of a table for people."""
    return number(value) if value != "" else ""


def _without_repeats(table: PaperTable) -> PaperTable:
    """A first cell that repeats the one above is left empty."""
    firsts = [None, *(row[0] for row in table.rows)]
    rows = [["" if row[0] == above else row[0], *row[1:]] for above, row in zip(firsts, table.rows, strict=False)]
    return replace(table, rows=rows)


def _section(section: Section) -> dict[str, Any]:
    return {"name": section.name, "title": section.title, "blocks": [_block(block) for block in section.blocks]}


def _block(block: Block) -> dict[str, Any]:
    """A block with its kind, as the template wants it."""
    if isinstance(block, PaperTable):
        return {"kind": "table", "table": block}
    if isinstance(block, Heading):
        return {"kind": "heading", "text": block.text}
    if isinstance(block, Figure):
        data = base64.b64encode(block.path.read_bytes()).decode("ascii")
        return {"kind": "figure", "title": block.title, "text": block.caption, "data": data}
    return {"kind": "text", "text": block}


PAPER = Product("softdot-paper/1", "paper.json", frozenset({"paper.json", "paper.html", "figures", "tables"}))
PARTS = ("analytical", "calibration", "segments", "beyond")
"""Packages of softdot.studies.paper, in the order of the page; each has a function section."""


def run_paper(out: Path, progress: Progress | None = None, scheduler: str | None = None) -> dict[str, Any]:
    """Solve what is not remembered, write the study into the folder out and return the content of paper.json.

    Presses are done by processes of this computer, or on the Dask cluster of a scheduler (tcp://HOST:PORT).
    InputError before any work when out cannot be written; NotSolvedError when a press gives no result. In both
    cases nothing is written, and what was solved is remembered.
    """
    with executor_for(scheduler) as executor, staged_folder(out, PAPER) as folder:
        (folder / "figures").mkdir()
        sections = [_part(name)(progress or Logged(), folder, executor) for name in PARTS]
        summary: dict[str, Any] = plain(content(sections))
        _write_tables(all_tables(sections), folder / "tables")
        write_report(sections, folder / "paper.html")
        write_json(folder / PAPER.summary, summary)
    return summary


def content(sections: Sequence[Section]) -> dict[str, Any]:
    """What paper.json holds."""
    return {
        "format": PAPER.format,
        "softdot_version": installed_version(),
        "findings": [finding for section in sections for finding in section.findings],
        "published": comparisons(sections),
        "claims": [vars(claim) for section in sections for claim in section.claims],
        "inconsistencies": [vars(slip) for slip in inconsistencies()],
        "sections": {section.name: section.numbers for section in sections},
    }


def all_tables(sections: Sequence[Section]) -> list[PaperTable]:
    """Every table of the page."""
    return [
        *(table for section in sections for table in section.tables),
        claims_table(sections),
        numbers_table(sections, ("input", "formula", "result"), "published-numbers", ""),
        inconsistencies_table(),
    ]


def _part(name: str) -> Callable[[Progress, Path, Executor], Section]:
    found: Callable[[Progress, Path, Executor], Section] = import_module(f"softdot.studies.paper.{name}").section
    return found


def _write_tables(tables: Sequence[PaperTable], folder: Path) -> None:
    """One CSV a table."""
    folder.mkdir()
    for table in tables:
        with (folder / f"{table.name}.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(table.headers)
            writer.writerows(["" if cell is None else cell for cell in row] for row in table.rows)
