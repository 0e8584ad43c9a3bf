"""Picture and page of a search for designs: force, crosstalk and characters that were not read."""

import base64
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from export.page import page_environment
from export.report import number
from export.view import DPI, INK, save_png
from foundation.files import write_whole_text

HERE = Path(__file__).parent
TRIED_COLOUR, FRONT_COLOUR, BEST_COLOUR = "#9aa5b1", "#2a7f62", "#c0392b"
COMPARED_COLOURS = ("#2b62a8", "#c98a1b", "#7a4fa3", "#3f8f9c", "#8c5a3c")
COMPARED_MARKERS = ("s", "^", "v", "P", "X")
LINEAR_PERCENT = 0.3
"""Error below which its axis is linear, so that zero can be drawn."""


def draw_designs(designs: Sequence[Mapping[str, Any]], accuracy: float, path: Path) -> None:
    """Draw the errors over the force of every design, and crosstalk over the least force, and write a PNG.

    designs : each with its name, readings and least as of design.json, whether it is compared, best, and on the front.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.5, 5.4), dpi=DPI, facecolor="white", layout="constrained")
    errors, trade = figure.subplots(1, 2)
    styles = _styles(designs)
    for design in sorted(designs, key=lambda one: styles[one["name"]]["zorder"]):
        _draw_curve(errors, design, styles[design["name"]])
        _draw_least_force(trade, design, styles[design["name"]])
    errors.axhline(100.0 * (1.0 - accuracy), color=INK, lw=1.0, ls="--")
    errors.set_yscale("symlog", linthresh=LINEAR_PERCENT, linscale=0.4)
    errors.set_yticks([0.0, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0], ["0", "0.3", "1", "3", "10", "30", "100"])
    errors.set_ylim(-0.05, 130.0)
    errors.set_ylabel("characters not read (%)", fontsize=11, color=INK)
    _draw_front(trade, designs)
    trade.set_yscale("log")
    trade.set_ylabel("largest crosstalk (%)", fontsize=11, color=INK)
    for axes, title in ((errors, "Each design at several depths"), (trade, "At the least force that is enough")):
        axes.set_xscale("log")
        axes.set_xlabel("mean force on the line (mN)", fontsize=11, color=INK)
        axes.set_title(title, fontsize=12, color=INK)
        axes.grid(alpha=0.3, which="both")
        axes.spines[["top", "right"]].set_visible(False)
        _set_plain_ticks(axes.xaxis)
    _set_plain_ticks(trade.yaxis)
    figure.legend(*trade.get_legend_handles_labels(), fontsize=9.5, frameon=False, loc="outside lower center", ncols=3)
    save_png(figure, path)


def _set_plain_ticks(axis: Any) -> None:
    """Give an axis plain numbers, three to a power of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def _styles(designs: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Name of the design -> keywords of matplotlib: colour, marker, label and order of drawing."""
    compared = iter(
        [
            (COMPARED_COLOURS[k % len(COMPARED_COLOURS)], COMPARED_MARKERS[k % len(COMPARED_MARKERS)])
            for k in range(len(designs))
        ]
    )
    found: dict[str, dict[str, Any]] = {}
    for design in designs:
        colour, marker, label, zorder = TRIED_COLOUR, "o", None, 2
        if design["compared"]:
            (colour, marker), label, zorder = next(compared), design["name"], 4
        if design["best"]:
            colour, label, zorder = BEST_COLOUR, f"least force: {design['name']}", 5
        found[design["name"]] = {"color": colour, "marker": marker, "label": label, "zorder": zorder}
    return found


def _draw_curve(axes: Any, design: Mapping[str, Any], style: Mapping[str, Any]) -> None:
    points = [
        (1e3 * one["mean_force_N"], 100.0 * (1.0 - one["accuracy"]))
        for one in design["readings"]
        if one["mean_force_N"]
    ]
    if points:
        wide = 0.9 if style["label"] is None else 1.8
        axes.plot(*np.array(points).T, "-", lw=wide, ms=3.5, alpha=0.85, **{**style, "label": None})


def _draw_least_force(axes: Any, design: Mapping[str, Any], style: Mapping[str, Any]) -> None:
    least = design["least"]
    if least is not None:
        axes.plot(1e3 * least["mean_force_N"], least["crosstalk_percent"], ls="none", ms=8, **style)


def _draw_front(axes: Any, designs: Sequence[Mapping[str, Any]]) -> None:
    """Draw the designs of which no other has less of both, joined by steps."""
    front = sorted(
        (1e3 * one["least"]["mean_force_N"], one["least"]["crosstalk_percent"]) for one in designs if one["front"]
    )
    if front:
        force, crosstalk = np.array(front).T
        axes.step(force, crosstalk, where="post", color=FRONT_COLOUR, lw=1.4, zorder=1, label="Pareto front")


TABLE_COLUMNS = (
    ("depth_mm", "depth (mm)", 1.0),
    ("mean_force_N", "mean force (mN)", 1e3),
    ("peak_force_N", "peak force (mN)", 1e3),
    ("crosstalk_percent", "crosstalk (%)", 1.0),
    ("accuracy", "characters read (%)", 100.0),
    ("low", "95 % from", 100.0),
    ("high", "to", 100.0),
)


def write_designs_page(path: Path, summary: Mapping[str, Any], picture: Path) -> None:
    """Write a page that opens offline: the picture, every design, and the least force at which it reads.

    summary : the content of design.json.
    """
    page = page_environment(HERE).get_template("designs.html").render(
        s=summary,
        heads=[head for _, head, _ in TABLE_COLUMNS],
        read=[(one, _row_texts(one["least"])) for one in _sorted_by_force(summary["designs"])],
        silent=[one for one in summary["designs"] if one["status"] == "solved" and one["least"] is None],
        failed=[one for one in summary["designs"] if one["status"] != "solved"],
        value_text=value_text,
        picture=base64.b64encode(picture.read_bytes()).decode("ascii"),
    )  # fmt: skip
    write_whole_text(path, page)


def _sorted_by_force(designs: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    read = [one for one in designs if one["least"] is not None]
    return sorted(read, key=lambda one: float(one["least"]["mean_force_N"]))


def _row_texts(least: Mapping[str, Any]) -> list[str]:
    numbers = [(scale * least[key], scale == 100.0) for key, _, scale in TABLE_COLUMNS]
    return [f"{value:.2f}" if share else number(value, 3) for value, share in numbers]


def value_text(value: Any) -> str:
    """A value of an axis as text for people: tables and lists without brackets.

    >>> value_text({"shape": "layer", "height_mm": 0.4})
    'shape layer, height_mm 0.4'
    """
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {value_text(inner)}" for key, inner in value.items())
    if isinstance(value, list | tuple):
        return (
            " + ".join(f"({value_text(one)})" if isinstance(one, Mapping) else value_text(one) for one in value)
            or "none"
        )
    return str(number(value)) if isinstance(value, int | float) else str(value)
