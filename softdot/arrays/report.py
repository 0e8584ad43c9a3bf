"""The files of an array's study: CAD, tables, pictures and the report."""

from __future__ import annotations

import base64
import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.files import write_whole_text

if TYPE_CHECKING:
    from softdot.arrays.kernel import ArrayKernel
    from softdot.arrays.study import ArrayStudy


HERE = Path(__file__).parent


def write_files(case: Any, found: ArrayStudy, summary: dict[str, Any], folder: Path) -> None:
    """Write all files but array.json; summary : its content."""
    from export.cad import write_array_cad
    from export.vtu import write_results
    from softdot.arrays.kernel_errors import with_about

    write_array_cad(case.layout, found.shown.parts, folder / "cad")
    write_results(found.result.tet_mesh, found.result, found.shown.dot, folder / "results")
    _write_csv(found, folder / "crosstalk.csv")
    if found.kernel is not None:
        said = {key: summary[key] for key in ("softdot_version", "config_hash", "config")}
        capacitance = found.matrix.press(0).capacitance_pF
        with_about(found.kernel, case, capacitance, found.checks, said).save(folder)
    captions = _draw(found, folder / "pictures")
    _write_report(found, summary, captions, folder)


COLUMNS = (
    "pressed", "read", "step", "indentation_mm", "reaction_force_N", "charge_pC", "open_circuit_voltage_V",
    "read_voltage_V", "share_percent",
)  # fmt: skip


def _write_csv(found: ArrayStudy, path: Path) -> None:
    """One row for each pressed segment, step and segment that is read."""
    matrix = found.matrix
    labels, ratio = [place.label for place in matrix.layout.places], 100.0 * matrix.ratio
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        for i, pressed in enumerate(labels):
            for step in range(matrix.depth_mm.shape[1]):
                for j, read in enumerate(labels):
                    numbers = (
                        matrix.depth_mm[i, step], matrix.force_N[i, step], matrix.charge_pC[i, step, j],
                        matrix.voltage_V[i, step, j], matrix.signal_V[i, step, j], ratio[i, step, j],
                    )  # fmt: skip
                    rows.writerow([pressed, read, step, *(f"{number:.9g}" for number in numbers)])


def _draw(found: ArrayStudy, folder: Path) -> list[tuple[str, str, str]]:
    """Draw all pictures; file, title and caption of each, in the order of the report."""
    import numpy as np

    from export.array.maps import draw_growth, draw_maps, draw_matrix
    from export.cutaway import draw_parts, open_scene
    from export.film_maps import film_figure
    from export.pictures import deepest
    from export.view import save_png
    from softdot.arrays.roles import representatives

    folder.mkdir()
    matrix, last = found.matrix, deepest(found.result)
    layout, percent = matrix.layout, matrix.crosstalk_percent
    draw_matrix([place.label for place in layout.places], percent, folder / "matrix.png")
    draw_maps(layout, list(matrix.solved), percent, folder / "maps.png")
    chosen = list(representatives(layout).values())
    own = np.array([matrix.signal_V[i, :, i] for i in chosen])
    shares = np.array([100.0 * np.abs(np.delete(matrix.ratio[i], i, axis=1)).max(axis=1, initial=0.0) for i in chosen])
    told = (matrix.depth_mm[chosen], matrix.force_N[chosen], own, shares)
    draw_growth([layout.places[i].label for i in chosen], *told, folder / "growth.png")
    scene = open_scene(found.result.tet_mesh, last, found.shown.dot)
    pressed = f"{found.shown_title}, {1e3 * last.indentation_m:.3g} mm deep with {last.reaction_force_N:.3g} N"
    draw_parts(scene, pressed, folder / "deformed.png")
    film = found.result.tet_mesh, last, found.result.film_peak, layout.whole.film.electrodes
    save_png(film_figure(*film), folder / "film.png")
    captions = [
        ("matrix.png", "The matrix.", "Each row is a press of one segment; colours are logarithmic above 1 %."),
        ("maps.png", "Where it goes.", "The array from above; the disc marks the pressed segment. "
         "Presses that are mirror images of these are left out."),
        ("growth.png", "With depth and force.", "The voltage of the pressed segment, and the largest of any other."),
        ("deformed.png", "The array cut open.", f"{pressed}."),
        ("film.png", "The film.", f"Strain and charge density; {pressed}."),
    ]  # fmt: skip
    if found.kernel is not None:
        captions.append(_draw_kernel(found, found.kernel, folder))
    return captions


def _draw_kernel(found: ArrayStudy, kernel: ArrayKernel, folder: Path) -> tuple[str, str, str]:
    from export.array.maps import draw_kernel
    from softdot.arrays.roles import representatives

    layout = found.matrix.layout
    number = next(iter(representatives(layout).values()))
    label, depth = layout.places[number].label, kernel.depth_mm[-1]
    told = (kernel.x_mm, kernel.y_mm, kernel.charge_pC[:, :, -1, number], kernel.force_N[:, :, -1])
    draw_kernel(layout, *told, label, folder / "kernel.png")
    text = f"What {label} reads of a dot at every place, {depth:.3g} mm deep, and the force on the dot."
    return "kernel.png", "The kernel.", text


def _write_report(
    found: ArrayStudy, summary: dict[str, Any], captions: list[tuple[str, str, str]], folder: Path
) -> None:
    from export.page import page_environment

    pictures = [
        (title, text, base64.b64encode((folder / "pictures" / name).read_bytes()).decode("ascii"))
        for name, title, text in captions
    ]
    page = page_environment(HERE).get_template("array.html")
    write_whole_text(folder / "report.html", page.render(a=summary, pictures=pictures, shown=found.shown_title))
