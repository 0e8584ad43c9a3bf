"""Every published number beside ours, every statement with its verdict, and the misprints, as tables."""

from collections.abc import Sequence
from typing import Any

from softdot.studies.paper.published import Published, inconsistencies, published_numbers
from softdot.studies.paper.section import Answer, Cell, PaperTable, Section

UNANSWERED = Answer(None, "not calculated here")


def answers(sections: Sequence[Section]) -> dict[str, Answer]:
    """Our value of every published number, by its key."""
    found = {key: answer for section in sections for key, answer in section.answers.items()}
    return {key: found.get(key, UNANSWERED) for key in published_numbers()}


def comparisons(sections: Sequence[Section]) -> list[dict[str, Any]]:
    """Every published number with ours, their ratio and the remark, for paper.json."""
    ours = answers(sections)
    return [
        {
            "key": key, "place": number.place, "quantity": number.quantity, "kind": number.kind,
            "unit": number.unit, "paper": number.value, "misprint": number.misprint,
            "ours": ours[key].ours, "ratio": _ratio(number, ours[key]), "remark": ours[key].remark,
        }
        for key, number in published_numbers().items()
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
    """Table of every statement that was tested."""
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
