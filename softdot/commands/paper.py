"""softdot paper: the whole study, part after part, in one page that opens offline."""

import csv
from argparse import Namespace
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from foundation.executor import Executor
from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout, show
from softdot.executors import executor_for
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.studies.paper.comparison import claims_table, comparisons, inconsistencies_table, numbers_table
from softdot.studies.paper.page import write_report
from softdot.studies.paper.published import inconsistencies
from softdot.studies.paper.section import PaperTable, Section
from softdot.version import installed_version


def command(chosen: Namespace) -> int:
    """Make the whole study in chosen.output; 0, or 3 when a press gave no result. InputError."""
    from softdot.progress import progress_of
    from softdot.studies.paper.presses import NotSolvedError

    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_paper(Path(chosen.output), progress, chosen.scheduler)
    except NotSolvedError as error:
        complain(f"paper, {error}; nothing was written, solved presses are cached")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """The findings, and the path of the page."""
    return "\n".join([*(f"- {finding}" for finding in summary["findings"]), f"{output}/paper.html"])


PAPER = Product("softdot-paper/1", "paper.json", frozenset({"paper.json", "paper.html", "figures", "tables"}))
STUDY_PARTS = ("analytical", "calibration", "segments", "beyond")
"""Packages of softdot.studies.paper, in the order of the page; each has a module and in it a function `section`."""


def run_paper(out: Path, progress: Progress | None = None, scheduler: str | None = None) -> dict[str, Any]:
    """Solve what is not stored, write the study into the folder out and return the content of paper.json.

    Presses are done by processes of this computer, or on the Dask cluster of a scheduler (tcp://HOST:PORT). InputError
    before any work when out cannot be written; NotSolvedError when a press gives no result. In both cases nothing is
    written, and what was solved is stored.
    """
    with executor_for(scheduler) as executor, staged_folder(out, PAPER) as folder:
        (folder / "figures").mkdir()
        sections = [_part(name)(progress or Logged(), folder, executor) for name in STUDY_PARTS]
        summary: dict[str, Any] = plain(paper_content(sections))
        _write_tables(all_tables(sections), folder / "tables")
        write_report(sections, folder / "paper.html")
        write_json(folder / PAPER.summary, summary)
    return summary


def paper_content(sections: Sequence[Section]) -> dict[str, Any]:
    """The content of paper.json."""
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
    """The function that makes a part of the study."""
    part = import_module(f"softdot.studies.paper.{name}.section")
    section: Callable[[Progress, Path, Executor], Section] = part.section
    return section


def _write_tables(tables: Sequence[PaperTable], folder: Path) -> None:
    """Write each table as a CSV file."""
    folder.mkdir()
    for table in tables:
        with (folder / f"{table.name}.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(table.headers)
            writer.writerows(["" if cell is None else cell for cell in row] for row in table.rows)
