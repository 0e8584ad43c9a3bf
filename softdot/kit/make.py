"""The kit: refuse, build, check, differentiate, write; everything appears at once or not at all."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from export.build_sheet.contents import Contents
from export.build_sheet.page import write_page
from export.build_sheet.pictures import draw_all
from export.cad import write_3mf, write_step, write_stl
from export.cut_files.write import write_cut_files
from export.headless import ensure_rendering
from export.printability import check_part, printer_profile
from geometry.fabrication.kit import solid_kit
from geometry.flat.patterns import flat_kit
from mesh.errors import MeshingError
from softdot import stages
from softdot.config import Config
from softdot.kit.budget import Budget, budget_of
from softdot.kit.layout import side_by_side
from softdot.kit.responses import StoppedShortError
from softdot.kit.summary import heading, pressed, summary_of
from softdot.numbers import plain, write_json
from softdot.output_folder import Product, staged_folder
from softdot.progress import Progress, Silent
from softdot.run_warnings import design_warnings
from softdot.system_libraries import named_when_missing
from solve.linear import LinearSolveError
from solve.materials.parameters import PiezoelectricFilm

KIT = Product(
    "softdot-kit/1",
    "kit.json",
    frozenset({"kit.json", "kit.html", "kit.step", "kit.3mf", "parts", "cut", "pictures"}),
)


def make_kit(config: Config, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Write the kit of a configuration into the folder out and return what kit.json says.

    InputError with one sentence, before any press, for what cannot be made. Where the press of the tolerance budget
    does not converge nothing is raised: the kit is written without it, and failure says why.
    """
    progress = progress or Silent()
    with named_when_missing():
        progress.stage("check")
        _, warnings = stages.check(config)
        ensure_rendering()
        with staged_folder(out, KIT) as folder:
            progress.stage("geometry")
            contents = _contents(config, [*warnings, *design_warnings(config)])
            budget, failure = _budget(config, progress)
            progress.stage("export")
            return _write(config, contents, budget, failure, folder)


def _contents(config: Config, warnings: list[str]) -> Contents:
    """All but the budget. InputError."""
    segment, fabrication = config.segment, config.fabrication
    flat = flat_kit(segment, fabrication)  # the quicker one first: it refuses too
    solid = solid_kit(segment, fabrication)
    profile, materials = printer_profile(fabrication.printer), config.layer_materials()
    film = materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    notes = dict.fromkeys(pour.note for pour in solid.pours if pour.note)
    return Contents(
        segment=segment,
        fabrication=fabrication,
        solid=solid,
        flat=flat,
        densities_g_cm3={layer: 1e-3 * material.density_kg_m3 for layer, material in materials.items()},
        permittivity=film.relative_permittivity,
        printability=tuple(check_part(part.label, part.solid, profile) for part in solid.parts),
        budget=None,
        press=pressed(config),
        warnings=(*warnings, *notes),
    )


def _budget(config: Config, progress: Progress) -> tuple[Budget | None, str | None]:
    """The tolerance budget, or why there is none. InputError."""
    progress.stage("tolerances")
    try:
        return budget_of(config, progress.step), None
    except (LinearSolveError, MeshingError, StoppedShortError) as error:
        return None, f"tolerance budget: {error}"


def _write(
    config: Config, contents: Contents, budget: Budget | None, failure: str | None, folder: Path
) -> dict[str, Any]:
    """All files, kit.json last."""
    told = plain(budget.as_dict()) if budget is not None else None
    warnings = contents.warnings if failure is None else (*contents.warnings, failure)
    contents = replace(contents, budget=told, warnings=warnings)
    (folder / "parts").mkdir()
    for part in contents.solid.parts:
        write_stl(part, folder / "parts" / f"{part.label}.stl")
    together = side_by_side(contents.solid.parts)
    write_step(together, folder / "kit.step")
    write_3mf(together, folder / "kit.3mf")
    write_cut_files(contents.flat.patterns, folder / "cut")
    (folder / "pictures").mkdir()
    draw_all(contents, folder / "cut", folder / "pictures")
    named = heading(config, KIT)
    write_page(contents, named, folder / "pictures", folder / "kit.html")
    summary: dict[str, Any] = plain(named | summary_of(contents, failure))
    write_json(folder / KIT.summary, summary)
    return summary
