"""The results of a sweep for people: a CSV file, a picture and a page."""

import base64
import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from export.page import page_environment
from export.report import number
from export.view import INK
from foundation.files import whole_file, write_whole_text
from softdot.sweeps.points import SOLVED

HERE = Path(__file__).parent
SHOWN_ROWS, SHOWN_AXES = 200, 6
"""Most rows on the page, and most axes in the picture."""
RESULTS = (("peak.reaction_force_N", "largest force (N)"), ("peak.open_circuit_voltage_V", "largest voltage (V)"))
"""Column of the table -> its label, for the results that are drawn."""
COLOUR, LONGEST_LABEL = "#b5263b", 28


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """The table of a sweep as CSV, whole or not at all; lists and tables in a cell as JSON, None as an empty cell."""
    names = list(dict.fromkeys(name for one in rows for name in one))
    with whole_file(path) as beside, beside.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        writer.writerows([[_csv_cell(one.get(name)) for name in names] for one in rows])


def _csv_cell(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, list | dict) else value


def _axis_values(row: Mapping[str, Any], axes: Sequence[str]) -> str:
    """The values of the axes at a point, in words."""
    return ", ".join(f"{axis} = {number(row.get(axis))}" for axis in axes)


def draw(path: Path, rows: Sequence[Mapping[str, Any]], axes: Sequence[str]) -> None:
    """Force and voltage of the solved points over each axis, at most six, as PNG; whole or not at all."""
    from matplotlib.figure import Figure

    solved, shown = [one for one in rows if one["status"] == SOLVED], list(axes[:SHOWN_AXES])
    figure = Figure(figsize=(max(5.0, 3.2 * len(shown)), 6.4), dpi=150, facecolor="white", layout="constrained")
    cells = figure.subplots(len(RESULTS), len(shown), squeeze=False, sharey="row")
    for line, (name, label) in zip(cells, RESULTS, strict=True):
        for cell, axis in zip(line, shown, strict=True):
            _draw_points(cell, [(one[axis], one[name]) for one in solved if one.get(name) is not None], len(axes) == 1)
            cell.tick_params(labelsize=9)
            cell.grid(alpha=0.3)
        line[0].set_ylabel(label, fontsize=11, color=INK)
    for cell, axis in zip(cells[-1], shown, strict=True):
        cell.set_xlabel(axis.replace(".", ".\n", 1) if len(axis) > LONGEST_LABEL else axis, fontsize=9, color=INK)
    with whole_file(path) as beside:
        figure.savefig(beside, format="png")


def _draw_points(cell: Any, pairs: Sequence[tuple[Any, float]], joined: bool) -> None:
    """Draw results over one axis, joined by a line where it is the only one; a value that is no number by its name."""
    numbers = all(isinstance(x, int | float) and not isinstance(x, bool) for x, _ in pairs)
    places = sorted(pairs) if numbers else [(_value_label(x), y) for x, y in pairs]
    cell.plot(
        [x for x, _ in places], [y for _, y in places], "o-" if joined and numbers else "o", color=COLOUR,
        ms=5 if len(pairs) <= SHOWN_ROWS else 2, alpha=0.8, lw=1.2,
    )  # fmt: skip


def _value_label(value: Any) -> str:
    """The text of a value that is no number, with at most LONGEST_LABEL characters."""
    text = str(value)
    return text if len(text) <= LONGEST_LABEL else f"{text[: LONGEST_LABEL - 3]}..."


def write_report(
    path: Path, rows: Sequence[Mapping[str, Any]], axes: Sequence[str], summary: Mapping[str, Any], picture: Path
) -> None:
    """Write a page that opens offline: how the points ended, picture, first SHOWN_ROWS rows, reasons of failures."""
    environment = page_environment(HERE)
    columns = [(axis, axis) for axis in axes] + [(name, label) for name, label in RESULTS]
    page = environment.get_template("report.html").render(
        s=summary,
        ended={name: count for name, count in summary["ended"].items() if count},
        heads=["point", *(label for _, label in columns)],
        rows=[
            [one["point"], *(number(one.get(name)) for name, _ in columns)]
            for one in rows[:SHOWN_ROWS]
            if one["status"] == SOLVED
        ],
        more=max(0, len(rows) - SHOWN_ROWS),
        failures=[
            (one["point"], _axis_values(one, axes), one["status"], one["reason"])
            for one in rows
            if one["status"] != SOLVED
        ][:SHOWN_ROWS],
        picture=base64.b64encode(picture.read_bytes()).decode("ascii"),
    )
    write_whole_text(path, page)
