"""The page of a family: responses, what moves them, the trade-off of force and voltage, presses and their errors."""

import base64
from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import sobol_indices, uniform

from export.page import page_environment
from export.report import number
from export.view import INK
from foundation.arrays import Floats
from foundation.files import write_whole_text
from softdot.families.family import Family
from softdot.families.fit import FORCE, VOLTAGE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HERE = Path(__file__).parent
LABELS = {FORCE: "force (N)", VOLTAGE: "open-circuit voltage (V)"}
COLOURS = {FORCE: "#b5263b", VOLTAGE: "#1f5fa8"}
CURVE_POINTS, FRONT_DESIGNS, SOBOL_DESIGNS = 41, 4096, 1024
MOST_SHOWN, MOST_COLUMNS = 12, 3
"""Points of a response, designs of the trade-off and of each column of Sobol's matrices; rows of the front, curves side
by side.
"""


def write_page(path: Path, family: Family, summary: Mapping[str, Any]) -> None:
    """Write the page, which opens offline, whole or not at all."""
    indices = {name: sobol_table(family, name) for name in LABELS}
    places, answers = _drawn_answers(family)
    front = trade_off(answers[FORCE], np.abs(answers[VOLTAGE]))
    shown = front[np.unique(np.linspace(0, len(front) - 1, min(MOST_SHOWN, len(front))).round().astype(int))]
    values = np.column_stack([one.values(column) for one, column in zip(family.space.ranges, places.T, strict=True)])
    page = page_environment(HERE).get_template("family.html").render(
        s=summary,
        number=number,
        labels=LABELS,
        indices=indices,
        keys=[one.name for one in family.space.ranges],
        presses=_press_rows(family),
        front=[[*map(number, values[row]), *(number(float(answers[name][row])) for name in LABELS)] for row in shown],
        curves=_data(_curves_figure(family)),
        trade_off=_data(_front_figure(answers, front)),
        held=_held_rows(summary),
    )  # fmt: skip
    write_whole_text(path, page)


def sobol_table(family: Family, name: str, seed: int = 0) -> list[dict[str, Any]]:
    """First-order and total Sobol index of each axis for a quantity at full load, each with its 95 % interval.

    The interval is of the sampling, from resamples (Saltelli et al., Comput. Phys. Commun. 181, 2010).
    """
    quantity, space = family.quantities[name], family.space

    def answer(shares: Floats) -> Floats:
        return quantity.course_values(space.places_of_shares(np.atleast_2d(shares.T)))[:, -1]

    found = sobol_indices(
        func=_varying(answer), n=SOBOL_DESIGNS, dists=[uniform()] * space.count, rng=np.random.default_rng(seed)
    )
    ends = found.bootstrap(n_resamples=200)
    rows = []
    for axis, one in enumerate(space.ranges):
        rows.append({
            "key": one.keys[0],
            **{
                kind: [float(getattr(found, part)[axis]), *(
                    float(getattr(getattr(ends, part).confidence_interval, end)[axis]) for end in ("low", "high")
                )]
                for kind, part in (("first", "first_order"), ("total", "total_order"))
            },
        })  # fmt: skip
    return sorted(rows, key=lambda row: -row["total"][0])


def _varying(answer: Callable[[Floats], Floats]) -> Callable[[Floats], Floats]:
    """An answer in the shape that scipy asks for."""
    return lambda shares: np.atleast_1d(answer(shares))


def trade_off(force: Floats, voltage: Floats) -> Any:
    """Numbers of the designs (q,) than which none has less force and more voltage, in order of their force.

    >>> trade_off(np.array([1.0, 2.0, 3.0, 1.5]), np.array([1.0, 3.0, 2.0, 0.5])).tolist()
    [0, 1]
    """
    order = np.lexsort((-voltage, force))
    best = np.maximum.accumulate(voltage[order])
    first = np.concatenate([[True], best[1:] > best[:-1]])
    return order[first]


def _drawn_answers(family: Family) -> tuple[Floats, dict[str, Floats]]:
    """Places (q, d) of drawn designs that can be pressed, and their answers (q,) at full load."""
    places = family.space.drawn_places(FRONT_DESIGNS, 0)
    places = places[family.region.holds(places)]
    return places, {name: family.quantities[name].course_values(places)[:, -1] for name in LABELS}


def _curves_figure(family: Family) -> "Figure":
    """Force and voltage over each axis, the others at their middle, with their intervals."""
    from matplotlib.figure import Figure

    count = family.space.count
    columns, blocks = min(count, MOST_COLUMNS), -(-count // MOST_COLUMNS)
    size = (max(5.0, 2.7 * columns), 5.6 * blocks)
    figure = Figure(figsize=size, dpi=110, facecolor="white", layout="constrained")
    cells = figure.subplots(len(LABELS) * blocks, columns, squeeze=False, sharey="row")
    along = np.linspace(-1.0, 1.0, CURVE_POINTS)
    for axis, one in enumerate(family.space.ranges):
        places = np.zeros((CURVE_POINTS, count))
        places[:, axis] = along
        shown = family.region.holds(places)
        block = cells[len(LABELS) * (axis // columns) :, axis % columns]
        for cell, name in zip(block, LABELS, strict=False):
            course = family.quantities[name].course(places)
            low, value, high = (
                np.where(shown, part[:, -1], np.nan) for part in (course.low, course.value, course.high)
            )
            cell.fill_between(one.values(along), low, high, color=COLOURS[name], alpha=0.25, lw=0)
            cell.plot(one.values(along), value, color=COLOURS[name], lw=1.6)
            cell.grid(alpha=0.3)
            cell.tick_params(labelsize=8)
        block[len(LABELS) - 1].set_xlabel(one.keys[0].replace(".", ".\n", 1), fontsize=8, color=INK)
    for unused in cells[-len(LABELS) :, count - columns * (blocks - 1) :].ravel():
        unused.set_axis_off()
    for line, label in zip(cells, [*LABELS.values()] * blocks, strict=True):
        line[0].set_ylabel(label, fontsize=10, color=INK)
    return figure


def _front_figure(answers: Mapping[str, Floats], front: Any) -> "Figure":
    """Voltage over force of drawn designs, and the front than which none is better."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.6, 3.8), dpi=110, facecolor="white", layout="constrained")
    axes = figure.subplots()
    axes.plot(answers[FORCE], np.abs(answers[VOLTAGE]), ".", color="#9aa5b1", ms=2, alpha=0.6, label="designs")
    axes.plot(answers[FORCE][front], np.abs(answers[VOLTAGE][front]), "o-", color=COLOURS[FORCE], ms=3, label="front")
    axes.set(xlabel=LABELS[FORCE], ylabel=LABELS[VOLTAGE])
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    return figure


def _data(figure: "Figure") -> str:
    """A figure as PNG in base64."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png")
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def _press_rows(family: Family) -> list[list[str]]:
    """Values of the keys, force and voltage at full load of each press."""
    ranges = family.space.ranges
    values = np.column_stack([one.values(column) for one, column in zip(ranges, family.places.T, strict=True)])
    last = [family.quantities[name].values[:, -1] for name in LABELS]
    return [
        [number(float(cell)) for cell in (*row, *ends)] for row, ends in zip(values, np.transpose(last), strict=True)
    ]


def _held_rows(summary: Mapping[str, Any]) -> list[list[str]]:
    """Values of the keys of each press that took no part; pressed, answered, error and interval of each quantity."""
    rows = []
    for one in summary["held_out"]:
        row = [number(value) for value in one["values"].values()]
        for name in LABELS:
            cell = one[name]
            row += [number(cell["pressed"]), number(cell["family"]), f"{cell['error_percent']:.2f}"]
            row.append("yes" if cell["within"] else "no")
        rows.append(row)
    return rows
