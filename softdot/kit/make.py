"""The kit: refuse, build, check and write it at once or not at all; then its tolerance budget, which takes longer."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from export.build_sheet.contents import Contents
from export.build_sheet.page import write_page
from export.build_sheet.pictures import draw_all
from export.cad import write_3mf, write_step, write_stl
from export.cut_files import write_cut_files
from export.headless import ensure_rendering
from export.printability import check_part, printer_profile
from geometry.base import InputError
from geometry.fabrication.kit import solid_kit
from geometry.flat.patterns import flat_kit
from mesh.types import MeshingError
from softdot import stages
from softdot.config import Config
from softdot.kit.budget import budget_of
from softdot.kit.budget_outcome import UNFINISHED, BudgetOutcome, failed
from softdot.kit.layout import side_by_side
from softdot.kit.summary import heading, pressed, summary_of
from softdot.log import LOG_FILE, log_file, warn
from softdot.numbers import json_text, plain, write_json
from softdot.output_folder import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.run_warnings import design_warnings
from softdot.system_libraries import named_when_missing
from solve.materials.parameters import PiezoelectricFilm
from solve.solution.linear import LinearSolveError
from solve.solution.sensitivity import StoppedShortError

KIT = Product(
    "softdot-kit/1",
    "kit.json",
    frozenset({"kit.json", "kit.html", "kit.step", "kit.3mf", "parts", "cut", "pictures"}),
)


def make_kit(config: Config, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Write the kit of a configuration into the folder out and return what kit.json says.

    InputError with one sentence, before anything is written, for what cannot be made. The kit appears without its
    tolerance budget; kit.json and kit.html are replaced when that is known. Where it fails nothing is raised: the kit
    stays without it, and failure says why. Where it is interrupted the kit stays too.
    """
    progress = progress or Logged()
    with named_when_missing():
        _, warnings = stages.check(config)
        ensure_rendering()
        with staged_folder(out, KIT) as folder:
            contents = contents_of(config, [*warnings, *design_warnings(config)])
            warn(list(contents.warnings))
            progress.stage("export")
            _write_parts(contents, folder)
            first = _write_sheet(config, contents, UNFINISHED, folder)
        with log_file(out / LOG_FILE):
            progress.stage("tolerances")
            outcome = _outcome(config, progress)
        if json_text(first) != _kit_json(out):
            raise InputError(f"output '{out}': another kit was written there meanwhile; this one's budget has no place")
        return _write_sheet(config, contents, outcome, out)


def _kit_json(out: Path) -> str | None:
    try:
        return (out / KIT.summary).read_text("utf-8")
    except OSError:
        return None


def contents_of(config: Config, warnings: list[str]) -> Contents:
    """All but the budget. InputError."""
    segment, fabrication = config.segment, config.fabrication
    flat = flat_kit(segment, fabrication)  # the quicker one first: it refuses too
    solid = solid_kit(segment, fabrication)
    profile, materials = printer_profile(fabrication.printer), config.layer_materials()
    film = materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    notes = dict.fromkeys(pour.note for pour in solid.pours if pour.note)
    printability = tuple(check_part(part.label, part.solid, profile) for part in solid.parts)
    unprintable = [f"{answer.label}: {answer.advice}" for answer in printability if not answer.printable]
    return Contents(
        segment=segment,
        fabrication=fabrication,
        solid=solid,
        flat=flat,
        densities_g_cm3={layer: 1e-3 * material.density_kg_m3 for layer, material in materials.items()},
        permittivity=film.relative_permittivity,
        printability=printability,
        budget=None,
        budget_note="",
        press=pressed(config),
        warnings=(*warnings, *notes, *unprintable),
    )


def _outcome(config: Config, progress: Progress) -> BudgetOutcome:
    """The tolerance budget, or why there is none."""
    try:
        return BudgetOutcome("complete", budget=plain(budget_of(config, progress.step).as_dict()))
    except (InputError, LinearSolveError, MeshingError, StoppedShortError) as error:
        return failed(error)


def _write_parts(contents: Contents, folder: Path) -> None:
    """Solids, cut files and pictures."""
    (folder / "parts").mkdir()
    for part in contents.solid.parts:
        write_stl(part, folder / "parts" / f"{part.label}.stl")
    together = side_by_side(contents.solid.parts)
    write_step(together, folder / "kit.step")
    write_3mf(together, folder / "kit.3mf")
    write_cut_files(contents.flat.patterns, folder / "cut")
    (folder / "pictures").mkdir()
    draw_all(contents, folder / "cut", folder / "pictures")


def _write_sheet(config: Config, contents: Contents, outcome: BudgetOutcome, folder: Path) -> dict[str, Any]:
    """The build sheet and kit.json, each replaced whole, kit.json last."""
    contents = replace(contents, budget=outcome.budget, budget_note=outcome.note)
    named = heading(config, KIT)
    write_page(contents, named, folder / "pictures", folder / "kit.html")
    summary: dict[str, Any] = plain(named | summary_of(contents, outcome.state, outcome.failure))
    write_json(folder / KIT.summary, summary)
    return summary
