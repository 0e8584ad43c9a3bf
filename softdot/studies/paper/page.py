"""The page of the study, which opens offline."""

import base64
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from export.page import page_environment
from export.report import number
from foundation.files import write_whole_text
from softdot.studies.paper.comparison import claims_table, inconsistencies_table, numbers_table
from softdot.studies.paper.section import Block, Figure, Heading, PaperTable, Section
from softdot.version import installed_version

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
