"""The whole study: its parts one after the other, then one folder with the page, the numbers, figures and tables."""

import csv
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from softdot.numbers import plain, write_json
from softdot.output_folder import Product, staged_folder
from softdot.paper import collected
from softdot.paper.published import inconsistencies
from softdot.paper.report import write_report
from softdot.paper.section import Section, Table
from softdot.progress import Logged, Progress
from softdot.version import installed_version

PAPER = Product("softdot-paper/1", "paper.json", frozenset({"paper.json", "paper.html", "figures", "tables"}))
PARTS = ("analytical", "calibration", "segments", "beyond")
"""Packages of softdot.paper, in the order of the page; each has section.section."""


def run_paper(out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Solve what is not remembered, write the study into the folder out and return the content of paper.json.

    InputError before any work when out cannot be written; NotSolvedError when a press gives no result. In both
    cases nothing is written, and what was solved is remembered.
    """
    with staged_folder(out, PAPER) as folder:
        (folder / "figures").mkdir()
        sections = [_part(name)(progress or Logged(), folder) for name in PARTS]
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
        "published": collected.comparisons(sections),
        "claims": [vars(claim) for section in sections for claim in section.claims],
        "inconsistencies": [vars(slip) for slip in inconsistencies()],
        "sections": {section.name: section.numbers for section in sections},
    }


def all_tables(sections: Sequence[Section]) -> list[Table]:
    """Every table of the page."""
    return [
        *(table for section in sections for table in section.tables),
        collected.claims_table(sections),
        collected.numbers_table(sections, ("input", "formula", "result"), "published-numbers", ""),
        collected.inconsistencies_table(),
    ]


def _part(name: str) -> Callable[[Progress, Path], Section]:
    found: Callable[[Progress, Path], Section] = import_module(f"softdot.paper.{name}.section").section
    return found


def _write_tables(tables: Sequence[Table], folder: Path) -> None:
    """One CSV a table."""
    folder.mkdir()
    for table in tables:
        with (folder / f"{table.name}.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(table.headers)
            writer.writerows(["" if cell is None else cell for cell in row] for row in table.rows)
