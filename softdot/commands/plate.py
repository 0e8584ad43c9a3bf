"""softdot plate: the files of a plate with their picture and plate.json; all appear at once or not at all."""

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from textwrap import shorten
from typing import Any

import numpy as np

from export.cad import write_3mf, write_step, write_stl
from export.printability import CriticalSize, Printability, draw_findings, printer_names, printer_profile
from export.printability.check import check_on_printers
from export.printability.surface import surface_of
from export.rendering import ensure_rendering
from export.view import INK, DrawnBody, View, frame, page, render, save
from geometry.base import InputError
from geometry.braille_standards import QUANTITIES, QuantityName
from softdot.console import (
    GOOD,
    Logged,
    Progress,
    installed_version,
    only_the_summary_on_stdout,
    plain,
    show,
    write_json,
)
from softdot.machine import named_when_missing
from softdot.output import Product, staged_folder
from softdot.printed_braille.request import BuiltPlate, PlateRequest, build_plate


def command(chosen: Namespace) -> int:
    """Write the plate that is asked for into chosen.output. InputError."""
    from softdot.console import progress_of

    request = request_of(chosen)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = make_plate(request, Path(chosen.output), progress)
    show(summary, chosen, short_text)
    return GOOD


def request_of(chosen: Namespace) -> PlateRequest:
    """The request of the command line. InputError for a list of heights that is none."""
    given = {name: value for name in QUANTITIES if (value := getattr(chosen, name)) is not None}
    return PlateRequest(
        standard=chosen.standard,
        kind=chosen.kind,
        text=chosen.text,
        given=given,
        table=chosen.table,
        width_cells=chosen.width_cells,
        heights_mm=None if chosen.heights_mm is None else _heights(chosen.heights_mm),
        thickness_mm=chosen.thickness_mm,
        margin_mm=chosen.margin_mm,
        thread=chosen.thread,
    )


def short_text(summary: dict[str, Any], output: str) -> str:
    """Cells, size, advice and where to look, in a few lines."""
    size = " x ".join(f"{value:.4g}" for value in summary["size_mm"])
    advice = [f"{answer['profile']}: {answer['advice']}" for answer in summary["printability"]]
    return "\n".join([*summary.get("cells", []), f"{size} mm", *advice, f"{output}/plate.stl"])


def _heights(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(value) for value in text.split(","))
    except ValueError:
        raise InputError(f"--heights-mm = '{text}': must be numbers in mm separated by commas") from None


VIEW = View(0.0, 50.0)
TITLES = {"text": "Braille plate", "dot": "Single dot", "height-series": "Dots that grow", "tip": "Indenter tip"}


def draw_plate(built: BuiltPlate, path: Path) -> None:
    """Write a PNG. InputError without OpenGL."""
    import pyvista

    surface = surface_of(built.plate.part.solid)
    box = frame(VIEW.flat(np.asarray(surface.vertices)))
    red, green, blue = (round(255 * value) for value in built.plate.part.colour)
    body = DrawnBody(pyvista.wrap(surface), f"#{red:02x}{green:02x}{blue:02x}")
    figure, axes, pixels_per_mm = page(box, _title(built))
    axes.imshow(render([body], VIEW, box, pixels_per_mm), extent=box, aspect="equal")
    if built.translation is not None:
        cells = "\n".join(built.translation.lines[:4])
        middle, below = (box[0] + box[1]) / 2, box[2] - 0.03 * (box[1] - box[0])
        axes.text(middle, below, cells, fontsize=14, color=INK, ha="center", va="top", multialignment="left")
    _write_sizes(figure, built)
    save(figure, path)


def _title(built: BuiltPlate) -> str:
    text = shorten(built.request.text or "", 26, placeholder="…")
    return f"{TITLES[built.request.kind]}{f' “{text}”' if text else ''}, {built.sizes.standard}"


def _write_sizes(figure: Any, built: BuiltPlate) -> None:
    """Sizes in a column at the right."""
    plate, first = built.plate, built.plate.dots[0]
    heights = sorted({dot.height_mm for dot in plate.dots})
    known = {name: size.value_mm for name, size in built.sizes.known.items() if name.endswith("pitch_mm")}
    rows = [
        ("plate", " × ".join(f"{size:.4g}" for size in plate.size_mm)),
        ("dot diameter", f"{first.base_diameter_mm:g}"),
        ("dot height", " to ".join(f"{height:g}" for height in dict.fromkeys((heights[0], heights[-1])))),
    ]
    if built.translation is not None:
        rows += [(name.removesuffix("_mm").replace("_", " "), f"{value:g}") for name, value in known.items()]
    for number, (name, value) in enumerate(rows):
        figure.text(
            0.75, 0.85 - 0.065 * number, f"{name}\n{value} mm", fontsize=9, color=INK, va="top", linespacing=1.3
        )


def summary_of(built: BuiltPlate, answers: Sequence[Printability], product: Product) -> dict[str, Any]:
    """Every number of the plate with its unit in its name, in plain data."""
    plate, sizes = built.plate, built.sizes
    words: dict[str, Any] = plain(
        {
            "format": product.format,
            "softdot_version": installed_version(),
            "kind": built.request.kind,
            **_text(built),
            "standard": {"name": sizes.standard, "title": sizes.title},
            "dimensions": {name: asdict(size) for name, size in sizes.known.items()},
            "size_mm": plate.size_mm,
            "volume_mm3": plate.part.volume_mm3,
            "dots": [asdict(dot) for dot in plate.dots],
            "printability": [answer.as_dict() for answer in answers],
            "files": sorted(product.entries),
            "warnings": _warnings(built),
        }
    )
    return words


def _text(built: BuiltPlate) -> dict[str, Any]:
    translation = built.translation
    if translation is None:
        return {}
    return {
        "text": built.request.text,
        "cells": translation.lines,
        "translation": {"table": translation.table, "liblouis": translation.liblouis},
    }


def _warnings(built: BuiltPlate) -> list[str]:
    """Sizes that the standard leaves open or that were only recalled."""
    return [
        f"{name} = {size.value_mm:g} is the {size.basis} of the standard {built.sizes.standard}"
        for name, size in built.sizes.known.items()
        if size.basis in ("middle of the range", "minimum")
    ]


DEFLECTION_MM, ANGULAR_DEFLECTION = 0.003, 0.2
"""Facets of the files: tip and flank of a dot of radius 0.8 mm stay within 0.005 mm, a tenth of a layer of SLA."""
CAD_AND_PICTURE = ("plate.step", "plate.3mf", "plate.stl", "plate.png")
PRINTABILITY = {name: f"printability-{name}.png" for name in printer_names()}
PLATE = Product("softdot-plate/1", "plate.json", frozenset({"plate.json", *CAD_AND_PICTURE, *PRINTABILITY.values()}))
TOLERATED: dict[QuantityName, str] = {"base_diameter_mm": "dot diameter", "height_mm": "dot height"}


def make_plate(request: PlateRequest, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Build, check and write one plate into the folder out; return what plate.json says. InputError."""
    progress = progress or Logged()
    with named_when_missing():
        built = build_plate(request)
        ensure_rendering()
        with staged_folder(out, PLATE) as folder:
            progress.stage("printability")
            answers = check_plate(built)
            progress.stage("export")
            _write_files(built, answers, folder)
            summary: dict[str, Any] = summary_of(built, answers, PLATE)
            write_json(folder / PLATE.summary, summary)
    return summary


def check_plate(built: BuiltPlate) -> tuple[Printability, ...]:
    """The printability of a plate by every printer of the table."""
    plate, first = built.plate, built.plate.dots[0]
    top = (first.x_mm, first.y_mm, first.base_z_mm + first.height_mm)
    sizes = [
        CriticalSize(title, size.value_mm, size.deviation_mm, top)
        for name, title in TOLERATED.items()
        if (size := built.sizes.known.get(name)) is not None and size.deviation_mm is not None
    ]
    profiles = [printer_profile(name) for name in printer_names()]
    return check_on_printers(plate.part.label, plate.part.solid, profiles, sizes)


def _write_files(built: BuiltPlate, answers: tuple[Printability, ...], folder: Path) -> None:
    part = built.plate.part
    write_step([part], folder / "plate.step")
    write_3mf([part], folder / "plate.3mf", ANGULAR_DEFLECTION)
    write_stl(part, folder / "plate.stl", DEFLECTION_MM, ANGULAR_DEFLECTION)
    draw_plate(built, folder / "plate.png")
    for answer in answers:
        draw_findings(part.solid, answer, folder / PRINTABILITY[answer.profile])
