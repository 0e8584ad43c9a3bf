"""softdot array: crosstalk of several segments, what stands for one of them, and the press of a cell."""

from __future__ import annotations

import base64
import csv
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geometry.files import write_whole_text
from softdot.console import (
    GOOD,
    NOT_CONVERGED,
    Logged,
    Progress,
    complain,
    installed_version,
    only_the_summary_on_stdout,
    plain,
    show,
    warn,
    write_json,
)
from softdot.machine import named_when_missing
from softdot.output import Product, staged_folder

if TYPE_CHECKING:
    from argparse import Namespace

    from softdot.arrays.kernel import ArrayKernel
    from softdot.arrays.study import ArrayStudy, Part
    from softdot.config import Config

ARRAY = Product(
    "softdot-array/1",
    "array.json",
    frozenset(
        {"array.json", "crosstalk.csv", "report.html", "cad", "pictures", "results", "kernel.npz", "kernel.json"}
    ),
)
HERE = Path(__file__).parent


def run_array(
    config: Config,
    out: Path,
    progress: Progress | None = None,
    parts: frozenset[Part] = frozenset(),
    scheduler: str | None = None,
) -> dict[str, Any]:
    """Study the array of a configuration into the folder out and return what array.json says; parts : asked for beside
    the matrix.

    Presses are done by processes of this computer, or on the Dask cluster of a scheduler (tcp://HOST:PORT).
    InputError before any work for what cannot be built or written. Where a press does not converge, StoppedPressError
    or MeshingError: nothing is written, and presses that were solved are kept in the cache.
    """
    from export.rendering import ensure_rendering
    from geometry.cache import check_folder
    from softdot.arrays.case import ArrayCase
    from softdot.arrays.study import study
    from softdot.executors import executor_for

    progress = progress or Logged()
    with named_when_missing():
        check_folder()
        case = ArrayCase(config)
        warnings = case.checked
        if "kernel" in parts:
            case.refuse_kernel()
        ensure_rendering()
        with executor_for(scheduler) as executor, staged_folder(out, ARRAY) as folder:
            warn(warnings)
            begun = time.perf_counter()
            found = study(case, executor, progress, parts)
            solve_s = time.perf_counter() - begun
            progress.stage("export")
            summary: dict[str, Any] = plain({**_summary(config, found, warnings), "timing_s": {"solve": solve_s}})
            _write(case, found, summary, folder)
            write_json(folder / ARRAY.summary, summary)
    return summary


def _summary(config: Config, found: ArrayStudy, warnings: list[str]) -> dict[str, Any]:
    """The content of array.json but for its times."""
    from softdot.arrays.kernel_errors import worst
    from softdot.arrays.side_stiffness import ROLES, as_dict
    from softdot.config import config_hash

    matrix, layout = found.matrix, found.matrix.layout
    presses = matrix.solved.values()
    late = [text for press in presses for text in press.warnings]
    return {
        "format": ARRAY.format,
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "config": config.model_dump(mode="json"),
        "from_default": list(config.from_default),
        "pitch_mm": layout.pitch_mm,
        "gap_mm": [gap if gap < layout.pitch_mm + layout.cell_pitch_mm else None for gap in layout.gap_mm],
        "size_mm": [2 * half for half in layout.half_mm],
        **matrix.summary(),
        "effective_side_stiffness_N_per_mm3": {
            role: found.sides[role].stiffness_N_per_mm3 if role in found.sides else None for role in ROLES
        },
        "effective_sides": {role: as_dict(sides) for role, sides in found.sides.items()},
        "cell_press": None if found.cell is None else found.cell.summary(),
        "variants": [vars(one) for one in found.variants],
        "kernel_error": worst(found.checks) if found.checks else None,
        "kernel_checks": [vars(one) for one in found.checks],
        "solver": {
            "presses": len(matrix.solved),
            "unknowns": max(press.unknowns for press in presses),
            "newton_iterations": sum(press.newton_iterations for press in presses),
            "max_relative_residual": max(press.max_relative_residual for press in presses),
            "solve_s": [press.solve_s for press in presses],
        },
        "warnings": list(dict.fromkeys([*warnings, *late])),
    }


def _write(case: Any, found: ArrayStudy, summary: dict[str, Any], folder: Path) -> None:
    from export.cad import write_array_cad
    from export.vtu import write_results
    from geometry.array.parts import array_parts
    from softdot.arrays.kernel_errors import with_about

    write_array_cad(case.layout, array_parts(case.layout, found.shown.dot), folder / "cad")
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
    """All pictures; of each its file, title and caption, in the order of the report."""
    import numpy as np

    from export.array.maps import draw_growth, draw_maps, draw_matrix
    from export.cutaway import draw_parts, open_scene
    from export.film_maps import film_figure
    from export.pictures import deepest
    from export.view import save
    from softdot.arrays.side_stiffness import representatives

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
    save(film_figure(found.result.tet_mesh, last, found.result.film_peak), folder / "film.png")
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
    from softdot.arrays.side_stiffness import representatives

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


def command(chosen: Namespace) -> int:
    """Study chosen.config into chosen.output; 0, or 3 when a press did not converge. InputError."""
    from mesh.types import MeshingError
    from softdot.arrays.presses import StoppedPressError
    from softdot.config import load_config
    from softdot.console import progress_of

    config = load_config(chosen.config, chosen.set)
    try:
        with only_the_summary_on_stdout(), progress_of(chosen) as progress:
            summary = run_array(config, Path(chosen.output), progress, frozenset(chosen.parts), chosen.scheduler)
    except (StoppedPressError, MeshingError) as error:
        complain(f"{error}; nothing was written, presses that were solved are kept in the cache")
        return NOT_CONVERGED
    show(summary, chosen, short_text)
    return GOOD


def short_text(summary: dict[str, Any], output: str) -> str:
    """Crosstalk, what stands for a segment, and where to look, in a few lines."""
    lines = [
        f"{len(summary['segments'])} segments, {summary['solver']['presses']} presses solved: largest crosstalk "
        f"{summary['largest_crosstalk_percent']:.3g} %"
    ]
    for role, sides in summary["effective_sides"].items():
        best = sides["best"]
        answer = "depth" if best["force_percent"] is None else "force"
        lines.append(
            f"{role} segment: sides of {sides['stiffness_N_per_mm3']:.3g} N/mm3, off by "
            f"{best[f'{answer}_percent']:+.1f} % in {answer} and {best['voltage_percent']:+.1f} % in voltage"
        )
    if summary["kernel_error"]:
        error = summary["kernel_error"]
        lines.append(
            f"kernel: charges within {error['charge_percent']:.2g} %, force within {error['force_percent']:.2g} %"
        )
    return "\n".join([*lines, f"{output}/report.html"])
