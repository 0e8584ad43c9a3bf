"""softdot kit: refuse, build, check and write the kit at once or not at all; then its tolerance budget."""

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from export.build_sheet.contents import Contents, bill, components
from export.build_sheet.page import capacitance_pF, checks, traces, write_page
from export.build_sheet.pictures import draw_all
from export.build_sheet.steps import steps
from export.cad import write_3mf, write_step, write_stl
from export.cut_files.folder import write_cut_files
from export.printability import check_part, printer_profile
from export.rendering import ensure_rendering
from geometry.base import InputError
from geometry.executor import Executor
from geometry.fabrication.device import Device, array_device, lone_device
from geometry.fabrication.kit import solid_kit
from geometry.fabrication.part import ROUNDING_MM, FabricationPart
from geometry.flat.flat_kit import FlatKit, flat_kit
from geometry.flat.pattern import FlatPattern, compensated
from mesh.types import MeshingError
from softdot.arrays.case import ArrayCase
from softdot.case import Case
from softdot.checks import design_warnings
from softdot.config import Config, config_hash
from softdot.console import (
    GOOD,
    LOG_FILE,
    NOT_CONVERGED,
    Logged,
    Progress,
    complain,
    installed_version,
    json_text,
    log_file,
    only_the_summary_on_stdout,
    plain,
    show,
    warn,
    write_json,
)
from softdot.executors import AwayError, executor_for
from softdot.machine import named_when_missing
from softdot.output import Product, staged_folder
from softdot.tolerances.budget import UNFINISHED, BudgetOutcome, budget_of, failed
from solve.materials.parameters import PiezoelectricFilm
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError

ROWS = 5


def command(chosen: Namespace) -> int:
    """Write the kit of chosen.config into chosen.output; 0, or 3 when its press did not converge. InputError."""
    from softdot.config import load_config
    from softdot.console import progress_of

    config = load_config(chosen.config, chosen.set)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = make_kit(config, Path(chosen.output), progress, chosen.scheduler)
    show(summary, chosen, short_text)
    if summary["failure"] is None:
        return GOOD
    complain(f"not converged, {summary['failure']}; the rest of the kit is in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """What there is to make, what matters most, and where to look."""
    lines = [f"{len(summary['parts'])} parts to print, {len(summary['flat_patterns'])} to cut"]
    budget = summary["tolerance_budget"]
    if budget and summary["config"]["array"] is not None:
        lines.append(f"tolerances of {summary['tolerance_budget_of']}:")
    for row in budget["rows"][:ROWS] if budget else []:
        change = f"{row['voltage_percent']:+.0f} % voltage, {row['force_percent']:+.0f} % force"
        lines.append(f"{row['label']} ±{row['plus_minus']:.3g} {row['unit']}: {change}")
    return "\n".join([*lines, f"{output}/kit.html"])


APART_MM, ROW_MM = 5.0, 150.0


def side_by_side(parts: Sequence[FabricationPart]) -> list[FabricationPart]:
    """The parts in rows along x, their undersides at z = 0, in mm."""
    from build123d import Pos

    found, x, y, depth = [], 0.0, 0.0, 0.0
    for part in parts:
        box = part.solid.bounding_box()
        if x > 0.0 and x + box.size.X > ROW_MM:
            x, y, depth = 0.0, y + depth + APART_MM, 0.0
        moved = Pos(x - box.min.X, y - box.min.Y, -box.min.Z) * part.solid
        moved.label, moved.color = part.solid.label, part.solid.color
        found.append(replace(part, solid=moved))
        x, depth = x + box.size.X + APART_MM, max(depth, box.size.Y)
    return found


def heading(config: Config, product: Product) -> dict[str, Any]:
    """What names a kit."""
    return {
        "format": product.format,
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "config": config.model_dump(mode="json"),
        "from_default": list(config.from_default),
    }


def pressed(config: Config) -> str:
    """The press in words."""
    press, dot = config.press, config.dot
    how_far = f"{press.force_N:g} N" if press.force_N is not None else f"{press.depth_mm:g} mm deep"
    return f"the {dot.shape} pressed {how_far}"


def summary_of(contents: Contents, state: str, failure: str | None) -> dict[str, Any]:
    """Every number of the kit with its unit in its name, in plain data.

    state : of the tolerance budget, "unfinished", "complete" or "failed"; failure : why it failed, else None.
    """
    return {
        "failure": failure,
        "warnings": contents.warnings,
        "tolerance_budget_state": state,
        "components": [asdict(one) for one in components(contents)],
        "bill_of_materials": [asdict(item) for item in bill(contents)],
        "parts": [
            {
                "label": part.label, "file": f"parts/{part.label}.stl", "copies": part.copies, "process": part.process,
                "size_mm": part.size_mm, "volume_mm3": part.volume_mm3, "purpose": part.purpose,
            }
            for part in contents.solid.parts
        ],
        "printability": [answer.as_dict() for answer in contents.printability],
        "pours": [asdict(pour) for pour in contents.solid.pours],
        "cavity_checks": [asdict(one) for one in contents.solid.cavity_checks],
        "flat_patterns": [_flat(pattern) for pattern in contents.flat.patterns],
        "film": {
            "capacitance_pF": dict(capacitance_pF(contents)),
            "traces": [asdict(trace) for trace in traces(contents)],
        },
        "steps": [{"title": step.title, "actions": step.actions} for step in steps(contents)],
        "checks": [asdict(check) for check in checks(contents)],
        "tolerance_budget": contents.budget,
        "tolerance_budget_of": contents.pressed,
    }  # fmt: skip


def _flat(pattern: FlatPattern) -> dict[str, Any]:
    """Sizes of the finished pattern and the length of its cuts, kerf compensated."""
    return {
        "name": pattern.name,
        "files": [f"cut/{pattern.name}.dxf", f"cut/{pattern.name}.svg"],
        "material": pattern.material,
        "thickness_mm": pattern.thickness_mm,
        "pieces": pattern.count,
        "sheet_mm": pattern.size_mm,
        "kerf_mm": pattern.kerf_mm,
        "cut_length_mm": sum(cut.length_mm for cut in compensated(pattern).cuts),
    }


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
    stays without it, and failure says why. Where it is interrupted the kit stays too. The budget's presses are done by
    processes of this computer, or on the Dask cluster of a scheduler (tcp://HOST:PORT).
    """
    progress = progress or Logged()
    with named_when_missing(), executor_for(scheduler) as executor:
        warnings = _checked(config)
        ensure_rendering()
        with staged_folder(out, KIT) as folder:
            contents = contents_of(config, warnings)
            warn(list(contents.warnings))
            progress.stage("export")
            _write_parts(contents, folder)
            first = _write_sheet(config, contents, UNFINISHED, folder)
        with log_file(out / LOG_FILE):
            progress.stage("tolerances")
            outcome = _outcome(config, progress, executor)
        if json_text(first) != _kit_json(out):
            raise InputError(f"output '{out}': another kit was written there meanwhile; this one's budget has no place")
        return _write_sheet(config, contents, outcome, out)


def _kit_json(out: Path) -> str | None:
    try:
        return (out / KIT.summary).read_text("utf-8")
    except OSError:
        return None


def _checked(config: Config) -> list[str]:
    """What a user should know about the design. InputError for what cannot be built, or pressed for the budget."""
    array = [] if config.array is None else ArrayCase(config).built
    case = Case(budget_config(config))
    return list(dict.fromkeys([*array, *case.checked[1], *design_warnings(case.model)]))


def device_of(config: Config) -> Device:
    """What the kit makes: one segment, or the array of the table [array]. InputError for what a kit cannot make."""
    if config.array is None:
        return lone_device(config.segment)
    return array_device(ArrayCase(config).layout, config.fabrication)


def budget_config(config: Config) -> Config:
    """What the tolerance budget presses: of an array one segment alone, held where a grid holds it."""
    if config.array is None:
        return config
    segment, held = config.segment, config.array.grid_layers
    if held:
        segment = segment.model_copy(update={"boundary": "clamped", "held_layers": held})
    return ArrayCase(config).lone(segment).config.model_copy(update={"array": None})


def contents_of(config: Config, warnings: list[str]) -> Contents:
    """All but the budget. InputError."""
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
        budget_note="",
        press=pressed(budget_config(config)),
        pressed=_pressed_segment(config),
        warnings=(*warnings, *_loose_film(device, flat), *notes, *unprintable),
    )


def _loose_film(device: Device, flat: FlatKit) -> list[str]:
    """What the simulation of a free rim does not know."""
    if device.stack.boundary != "free" or flat.layout.beyond < ROUNDING_MM:
        return []
    return [
        f"the film reaches up to {flat.layout.beyond:.3g} mm beyond the free rim, for the traces that go around the "
        "array; the simulated film ends at the rim"
    ]


def _pressed_segment(config: Config) -> str:
    """What the budget is of, in words."""
    if config.array is None:
        return "the segment"
    held = config.array.grid_layers
    sides = f"held at {', '.join(held)} as by the grid" if held else f"{config.segment.boundary} at its own sides"
    return f"one segment of the array alone, {sides}"


def _outcome(config: Config, progress: Progress, executor: Executor) -> BudgetOutcome:
    """The tolerance budget, or why there is none."""
    try:
        budget = budget_of(budget_config(config), progress.step, executor)
        return BudgetOutcome("complete", budget=plain(budget.as_dict()))
    except AwayError:
        raise
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
