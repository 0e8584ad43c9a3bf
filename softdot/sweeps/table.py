"""The table of a sweep as Apache Parquet and CSV, with a picture and a page for people."""

import base64
import csv
import json
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from export.page import page_environment
from export.report import number
from export.view import INK
from geometry.base import InputError
from geometry.files import whole_file, write_whole_text
from softdot.console import plain
from softdot.sweeps.points import SOLVED, Record

if TYPE_CHECKING:
    import pyarrow as pa

CURVES = (
    "indentation_mm", "reaction_force_N", "film_charge_pC", "open_circuit_voltage_V", "readout_voltage_V",
)  # fmt: skip
HEAD = ("status", "reason", "seconds", "config_hash")
LEFT_OUT = ("format", "softdot_version", "key", "config", *HEAD)


def row(number: int, values: Mapping[str, Any], record: Record) -> dict[str, Any]:
    """Number, values of the axes, how it ended, peaks of the curves, and every number of the summary.

    Nested keys are joined by dots. The peak of a curve is its value of largest magnitude, with its sign.
    """
    numbers = {key: value for key, value in record.items() if key not in LEFT_OUT}
    return {
        "point": number,
        **values,
        **{key: record.get(key) for key in HEAD},
        **{f"peak.{name}": max(record[name], key=abs) for name in CURVES if record.get(name)},
        **_flat(plain(numbers)),
    }


def _flat(tables: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """{'film': {'capacitance_pF': 24}} -> {'film.capacitance_pF': 24}."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        flat |= _flat(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value}
    return flat


def check_tables() -> None:
    """InputError, before any work, where the library of Parquet tables is not installed."""
    if find_spec("pyarrow") is None:
        raise InputError("Parquet tables need pyarrow, which softdot alone does not: pip install 'softdot[sweep]'")


def write_table(path: Path, rows: list[dict[str, Any]]) -> None:
    """Write Parquet that never exists half-written; a row lacks what other rows have: null."""
    import pyarrow as pa
    from pyarrow import parquet

    names = list(dict.fromkeys(name for one in rows for name in one))
    columns = {name: _column([one.get(name) for one in rows]) for name in names}
    with whole_file(path) as beside:
        parquet.write_table(pa.table(columns), beside)


def _column(values: list[Any]) -> "pa.Array":
    """Numbers, texts or lists of them with their own type; what has no common type as JSON."""
    import pyarrow as pa

    try:
        return pa.array(values)
    except (pa.ArrowInvalid, pa.ArrowTypeError):
        return pa.array([None if value is None else json.dumps(value) for value in values])


def read_table(out: Path | str) -> "pa.Table":
    """The table in the folder of a complete sweep: .to_pylist() gives rows, .to_pandas() a frame. InputError."""
    check_tables()
    from pyarrow import ArrowException, parquet

    from softdot.sweeps.points import TABLE

    path = Path(out) / TABLE
    try:
        return parquet.read_table(path)
    except FileNotFoundError:
        raise InputError(f"'{out}': holds no table '{TABLE}'; the sweep is not complete") from None
    except (OSError, ArrowException) as error:
        raise InputError(f"'{path}': cannot be read ({error})") from None


HERE = Path(__file__).parent
SHOWN_ROWS, SHOWN_AXES = 200, 6
RESULTS = (("peak.reaction_force_N", "largest force (N)"), ("peak.open_circuit_voltage_V", "largest voltage (V)"))
COLOUR, LONG = "#b5263b", 28


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """The table of a sweep as CSV, whole or not at all; lists and tables in a cell as JSON, None as an empty cell."""
    names = list(dict.fromkeys(name for one in rows for name in one))
    with whole_file(path) as beside, beside.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        writer.writerows([[_cell(one.get(name)) for name in names] for one in rows])


def _cell(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, list | dict) else value


def _place(row: Mapping[str, Any], axes: Sequence[str]) -> str:
    return ", ".join(f"{axis} = {number(row.get(axis))}" for axis in axes)


def draw(path: Path, rows: Sequence[Mapping[str, Any]], axes: Sequence[str]) -> None:
    """Force and voltage of the solved points over each axis, at most six, as PNG; whole or not at all."""
    from matplotlib.figure import Figure

    solved, shown = [one for one in rows if one["status"] == SOLVED], list(axes[:SHOWN_AXES])
    figure = Figure(figsize=(max(5.0, 3.2 * len(shown)), 6.4), dpi=150, facecolor="white", layout="constrained")
    cells = figure.subplots(len(RESULTS), len(shown), squeeze=False, sharey="row")
    for line, (name, label) in zip(cells, RESULTS, strict=True):
        for cell, axis in zip(line, shown, strict=True):
            _points(cell, [(one[axis], one[name]) for one in solved if one.get(name) is not None], len(axes) == 1)
            cell.tick_params(labelsize=9)
            cell.grid(alpha=0.3)
        line[0].set_ylabel(label, fontsize=11, color=INK)
    for cell, axis in zip(cells[-1], shown, strict=True):
        cell.set_xlabel(axis.replace(".", ".\n", 1) if len(axis) > LONG else axis, fontsize=9, color=INK)
    with whole_file(path) as beside:
        figure.savefig(beside, format="png")


def _points(cell: Any, pairs: Sequence[tuple[Any, float]], joined: bool) -> None:
    """Dots, joined by a line where there is one axis only; what is no number stands by its name."""
    numbers = all(isinstance(x, int | float) and not isinstance(x, bool) for x, _ in pairs)
    places = sorted(pairs) if numbers else [(_name(x), y) for x, y in pairs]
    cell.plot(
        [x for x, _ in places], [y for _, y in places], "o-" if joined and numbers else "o", color=COLOUR,
        ms=5 if len(pairs) <= SHOWN_ROWS else 2, alpha=0.8, lw=1.2,
    )  # fmt: skip


def _name(value: Any) -> str:
    """A value that is no number, cut where it is long."""
    text = str(value)
    return text if len(text) <= LONG else f"{text[: LONG - 3]}..."


def write_report(
    path: Path, rows: Sequence[Mapping[str, Any]], axes: Sequence[str], summary: Mapping[str, Any], picture: Path
) -> None:
    """A page that opens offline: how the points ended, the picture, the first 200 rows and every failure's reason."""
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
            (one["point"], _place(one, axes), one["status"], one["reason"]) for one in rows if one["status"] != SOLVED
        ][:SHOWN_ROWS],
        picture=base64.b64encode(picture.read_bytes()).decode("ascii"),
    )
    write_whole_text(path, page)
