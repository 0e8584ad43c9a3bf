"""The folder of a kit: checked, built and written at once or not at all; then its tolerance budget."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from export.build_sheet.contents import Contents
from export.build_sheet.page import write_page
from export.build_sheet.pictures import draw_all
from export.cad import write_3mf, write_step, write_stl
from export.cut_files.folder import write_cut_files
from export.printability import check_part, printer_profile
from export.rendering import ensure_rendering
from foundation.errors import InputError
from foundation.executor import Executor
from geometry.fabrication.device import Device, array_device, lone_device
from geometry.fabrication.kit import solid_kit
from geometry.fabrication.part import ROUNDING_MM
from geometry.flat.flat_kit import FlatKit, flat_kit
from mesh.types import MeshingError
from softdot.arrays.case import ArrayCase
from softdot.config.schema import Config
from softdot.dask_cluster import AwayError
from softdot.executors import executor_for
from softdot.json_files import json_text, plain, write_json
from softdot.kit.layout import side_by_side
from softdot.kit.summary import heading, press_words, summary_of
from softdot.log import LOG_FILE, log_file, warn
from softdot.output import Product, staged_folder
from softdot.prepared_press import PreparedPress
from softdot.progress import LaterSteps, Logged, Progress
from softdot.system_libraries import name_missing_library
from softdot.tolerances.budget import tolerance_budget
from softdot.tolerances.budget_outcome import UNFINISHED, BudgetOutcome, failed_budget
from softdot.tolerances.crosstalk import crosstalk_budget
from solve.materials.parameters import PiezoelectricFilm
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError

KIT = Product(
    "softdot-kit/1",
    "kit.json",
    frozenset({"kit.json", "kit.html", "kit.step", "kit.3mf", "parts", "cut", "pictures"}),
)


def make_kit(
    config: Config, out: Path, progress: Progress | None = None, scheduler: str | None = None
) -> dict[str, Any]:
    """Write the kit of a configuration into the folder out and return what kit.json says.

    InputError with one sentence, before anything is written, for what cannot be made. The kit appears without its
    tolerance budget; kit.json and kit.html are replaced when that is known. Where it fails nothing is raised: the kit
    stays without it, and failure says why. Where it is interrupted the kit stays too. The budget's presses are done,
    while parts and pictures are made, by processes of this computer, or on the Dask cluster of a scheduler
    (tcp://HOST:PORT).
    """
    progress = progress or Logged()
    # the executor ends first: what is asked in the background then ends too
    with name_missing_library(), ThreadPoolExecutor(1) as background, executor_for(scheduler) as executor:
        warnings = _kit_warnings(config)
        ensure_rendering()
        steps = LaterSteps(progress)
        budget = background.submit(_budget_outcome, config, steps, executor)  # other processes press beside this one
        with staged_folder(out, KIT) as folder:
            contents = contents_of(config, warnings)
            warn(list(contents.warnings))
            progress.stage("export")
            _write_files(contents, folder)
            first = _write_sheet(config, contents, UNFINISHED, folder)
        with log_file(out / LOG_FILE):
            progress.stage("tolerances")
            steps.show()
            outcome = budget.result()
        if json_text(first) != _kit_json(out):
            raise InputError(f"output '{out}': another kit was written there meanwhile; this one's budget has no place")
        return _write_sheet(config, contents, outcome, out)


def _kit_json(out: Path) -> str | None:
    """The text of kit.json in a folder, None where it cannot be read."""
    try:
        return (out / KIT.summary).read_text("utf-8")
    except OSError:
        return None


def _kit_warnings(config: Config) -> list[str]:
    """Warnings of the design, without repetition. InputError for what cannot be built, or pressed for the budget."""
    array = [] if config.array is None else ArrayCase(config).design_warnings
    case = PreparedPress(budget_config(config))
    return list(dict.fromkeys([*array, *case.warnings]))


def device_of(config: Config) -> Device:
    """The device that a kit makes: one segment, or the array of [array]. InputError for one that a kit cannot make."""
    layout = PreparedPress(config).layout
    return lone_device(config.segment) if layout is None else array_device(layout, config.fabrication)


def budget_config(config: Config) -> Config:
    """The configuration that the budget presses: of an array one segment alone, held where a grid holds it."""
    if config.array is None:
        return config
    segment, held = config.segment, config.array.grid_layers
    if held:
        segment = segment.model_copy(update={"boundary": "clamped", "held_layers": held})
    return ArrayCase(config).lone(segment).config.model_copy(update={"array": None})


def contents_of(config: Config, warnings: list[str]) -> Contents:
    """The contents of the build sheet without the tolerance budget. InputError."""
    fabrication, device = config.fabrication, device_of(config)
    flat = flat_kit(device, fabrication)  # the quicker one first: it refuses too
    solid = solid_kit(device, fabrication)
    profile, materials = printer_profile(fabrication.printer), config.layer_materials()
    film = materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    notes = dict.fromkeys(pour.note for pour in solid.pours if pour.note)
    printability = tuple(check_part(part.label, part.solid, profile) for part in solid.parts)
    unprintable = [f"{answer.label}: {answer.advice}" for answer in printability if not answer.printable]
    return Contents(
        device=device,
        fabrication=fabrication,
        solid=solid,
        flat=flat,
        densities_g_cm3={layer: 1e-3 * material.density_kg_m3 for layer, material in materials.items()},
        permittivity=film.relative_permittivity,
        printability=printability,
        budget=None,
        crosstalk=None,
        budget_note="",
        press=press_words(budget_config(config)),
        pressed=_budget_subject(config),
        readout=config.readout,
        warnings=(*warnings, *_loose_film_warnings(device, flat), *notes, *unprintable),
    )


def _loose_film_warnings(device: Device, flat: FlatKit) -> list[str]:
    """A warning where the film reaches beyond a free rim, which the simulation does not know."""
    if device.stack.boundary != "free" or flat.layout.beyond < ROUNDING_MM:
        return []
    return [
        f"the film reaches up to {flat.layout.beyond:.3g} mm beyond the free rim, for the traces that go around the "
        "array; the simulated film ends at the rim"
    ]


def _budget_subject(config: Config) -> str:
    """The segment that the budget is of, in words."""
    if config.array is None:
        return "the segment"
    held = config.array.grid_layers
    sides = f"held at {', '.join(held)} as by the grid" if held else f"{config.segment.boundary} at its own sides"
    return f"one segment of the array alone, {sides}"


def _budget_outcome(config: Config, on_step: Callable[[int, int, str], None], executor: Executor) -> BudgetOutcome:
    """The tolerance budget, or the reason why there is none. AwayError."""
    try:
        budget = tolerance_budget(budget_config(config), on_step, executor)
    except AwayError:
        raise
    except (InputError, LinearSolveError, MeshingError, StoppedShortError) as error:
        return failed_budget(error)
    alone = BudgetOutcome("complete", budget=plain(budget.as_dict()))
    if config.array is None:
        return alone
    try:
        beside = crosstalk_budget(config, lambda n, of, text: on_step(n, of, f"crosstalk, {text}"), executor)
    except InputError as error:  # such as a medium with memory, whose path matters
        return replace(alone, note=f"There is no budget of the crosstalk: {error}.")
    except (LinearSolveError, MeshingError, StoppedShortError) as error:
        return replace(failed_budget(error), budget=alone.budget, failure=f"budget of the crosstalk: {error}")
    return replace(alone, crosstalk=None if beside is None else plain(beside.as_dict()))


def _write_files(contents: Contents, folder: Path) -> None:
    """Write solids, cut files and pictures."""
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
    """Write the build sheet and kit.json, each replaced whole, kit.json last; the content of kit.json."""
    contents = replace(contents, budget=outcome.budget, crosstalk=outcome.crosstalk, budget_note=outcome.note)
    named = heading(config, KIT)
    write_page(contents, named, folder / "pictures", folder / "kit.html")
    summary: dict[str, Any] = plain(named | summary_of(contents, outcome.state, outcome.failure))
    write_json(folder / KIT.summary, summary)
    return summary
