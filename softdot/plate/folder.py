"""The folder of a plate: solid, picture, printability and plate.json, all at once or not at all."""

from pathlib import Path
from typing import Any

from export.cad import write_3mf, write_step, write_stl
from export.printability import CriticalSize, Printability, draw_findings, printer_names, printer_profile
from export.printability.check import check_on_printers
from export.rendering import ensure_rendering
from geometry.braille_standards import QuantityName
from softdot.json_files import write_json
from softdot.output import Product, staged_folder
from softdot.plate.build import BuiltPlate, build_plate
from softdot.plate.options import PlateRequest
from softdot.plate.picture import draw_plate
from softdot.plate.summary import summary_of
from softdot.progress import Logged, Progress
from softdot.system_libraries import name_missing_library

DEFLECTION_MM, ANGULAR_DEFLECTION = 0.003, 0.2
"""Deviation of facets in mm and in radians: tip and flank of a dot of radius 0.8 mm stay within 0.005 mm, a tenth of a
layer of SLA.
"""
CAD_AND_PICTURE = ("plate.step", "plate.3mf", "plate.stl", "plate.png")
PRINTABILITY = {name: f"printability-{name}.png" for name in printer_names()}
PLATE = Product("softdot-plate/1", "plate.json", frozenset({"plate.json", *CAD_AND_PICTURE, *PRINTABILITY.values()}))
TOLERANCE_TITLES: dict[QuantityName, str] = {"base_diameter_mm": "dot diameter", "height_mm": "dot height"}
"""Size with a tolerance in the standard -> its name in the table of printability."""


def make_plate(request: PlateRequest, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Build, check and write one plate into the folder out; the content of plate.json. InputError."""
    progress = progress or Logged()
    with name_missing_library():
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
    """The printability of a plate on every printer of the table."""
    plate, first = built.plate, built.plate.dots[0]
    top = (first.x_mm, first.y_mm, first.base_z_mm + first.height_mm)
    sizes = [
        CriticalSize(title, size.value_mm, size.deviation_mm, top)
        for name, title in TOLERANCE_TITLES.items()
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
