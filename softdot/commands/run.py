"""softdot run: check, geometry, mesh, solve, export; everything appears at once or not at all."""

import logging
import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from export.view import ensure_rendering
from geometry.arrays import Floats
from geometry.beside import Ask, beside
from geometry.dot import DotShape
from geometry.parameters import Segment
from geometry.solids import Part
from mesh.files.formats import check_formats, write_mesh
from mesh.types import MeshingError
from softdot.case import Case, OnStep
from softdot.checks import COMPILE_S, design_warnings, result_warnings
from softdot.config import Config
from softdot.config.toml import told
from softdot.console import (
    GOOD,
    NOT_CONVERGED,
    Logged,
    Progress,
    complain,
    lines_when_interactive,
    only_the_summary_on_stdout,
    plain,
    show,
    warn,
    write_json,
)
from softdot.machine import named_when_missing
from softdot.output import RUN, staged_folder
from softdot.summary import heading, mesh_part, press_part, stopped_solver
from softdot.uncertainty import prepare
from solve.result import PressResult, Step

LOG = logging.getLogger(__name__)


class StageClock:
    """Wall-clock seconds by stage."""

    def __init__(self) -> None:
        self.seconds = dict.fromkeys(("geometry", "mesh", "solve", "uncertainty", "export"), 0.0)

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Add the time of a block to a stage."""
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] += time.perf_counter() - start


def run_config(config: Config, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """As run_case, of a configuration."""
    return run_case(Case(config), out, progress)


def run_case(
    case: Case, out: Path, progress: Progress | None = None, mesh_formats: Sequence[str] = ()
) -> dict[str, Any]:
    """Run the whole pipeline of a case into the folder out and return its summary.

    mesh_formats : in which the mesh is written for other codes, see mesh.files.formats.
    InputError before any work for what cannot be built or written. Where a computation does not converge
    nothing is raised: solver.converged is False, solver.failure says why and what converged is written.
    """
    progress = progress or Logged()
    with named_when_missing(), lines_when_interactive():
        check_formats(mesh_formats)
        _ = case.checked
        ensure_rendering()
        with staged_folder(out, RUN) as folder, beside() as ask:
            summary: dict[str, Any] = heading(case.config) | plain(_fill(case, folder, progress, mesh_formats, ask))
            write_json(folder / RUN.summary, summary)
    return summary


def _fill(case: Case, folder: Path, progress: Progress, mesh_formats: Sequence[str], ask: Ask) -> dict[str, Any]:
    """Everything but summary.json; returns the summary. Parts and pictures are made beside mesh, press and files."""
    from solve.fem.kernels import compiled

    clock, config, model = StageClock(), case.config, case.model
    summary = {**heading(config), "warnings": [*case.checked[1], *design_warnings(model)]}
    warn(summary["warnings"])
    if config.from_default:
        LOG.info("%s", told(config.from_default, config.model_dump(mode="json")))
    if not compiled():
        LOG.info("the element kernels are compiled first, once on this machine: about %.0f s", COMPILE_S)
    cad = ask(make_cad, model.segment, case.dot, folder / "cad")
    progress.stage("mesh")
    try:
        with clock("mesh"):
            ask(prepare, case.sized)
            ask(ready_to_draw)
            quality = case.mesh_quality
    except MeshingError as error:
        clock.seconds["geometry"] = cad.result()
        return {**summary, "solver": stopped_solver(f"meshing: {error}"), "timing_s": clock.seconds}
    if mesh_formats:
        with clock("export"):
            write_mesh(case.mesh, mesh_formats, folder / "mesh")
    progress.stage("solve")
    with clock("solve"):
        result = case.press(_reporting(progress)).result
        readout, channels = case.amplified(result) or (None, None)
    clock.seconds["geometry"] = cad.result()
    summary |= {"mesh": mesh_part(quality, result.unknowns), **press_part(model.readout, result, readout, channels)}
    late = result_warnings(model, case.dot, result)
    warn(late)
    summary["warnings"] += late
    if result.converged:
        progress.stage("uncertainty")
        with clock("uncertainty"):
            summary |= case.uncertainty(summary)
    progress.stage("export")
    with clock("export"):
        so_far = {"timing_s": dict(clock.seconds)}
        write_outputs(case.dot, result, readout, plain(summary | so_far), folder, ask)
    return {**summary, "timing_s": clock.seconds}


def make_cad(segment: Segment, dot_shape: DotShape, folder: Path) -> float:
    """The parts and their files; returns how many seconds they took. InputError."""
    from geometry import assembly

    start = time.perf_counter()
    write_cad(assembly.build_parts(segment, dot_shape), folder)
    return time.perf_counter() - start


def write_cad(parts: Sequence[Part], folder: Path) -> None:
    """STEP, 3MF and STL files of the parts."""
    from export import cad

    cad.write_cad(parts, folder)


def write_outputs(
    dot_shape: DotShape,
    result: PressResult,
    readout_voltage_V: Floats | None,
    summary: dict[str, Any],
    folder: Path,
    ask: Ask,
) -> None:
    """ParaView files, pictures and the report of what converged; the pictures are made beside."""
    from export.report import write_report
    from export.viewer_data import viewer_data
    from export.vtu import write_results

    tet_mesh = result.tet_mesh
    pictures = ask(draw, tet_mesh, result, dot_shape, folder / "pictures", readout_voltage_V)
    write_results(tet_mesh, result, dot_shape, folder / "results")
    viewer = viewer_data(tet_mesh, result, dot_shape)
    write_report(summary, pictures.result(), viewer, folder / "report.html")


def ready_to_draw() -> None:
    """Load what draws, which takes two seconds."""
    for name in ("matplotlib.figure", "pyvista.plotting", "export.pictures"):
        import_module(name)


def draw(*arguments: Any) -> dict[str, Path]:
    """As export.pictures.write_pictures."""
    from export.pictures import write_pictures

    return write_pictures(*arguments)


def _reporting(progress: Progress) -> OnStep:
    """Pass the solver's steps on as text."""

    def on_step(step: Step, number: int, count: int) -> None:
        progress.step(number, count, f"{1e3 * step.indentation_m:.3f} mm, {step.reaction_force_N:.3g} N")

    return on_step


def command(chosen: Namespace) -> int:
    """Run chosen.config into chosen.output; 0, or 3 when a computation did not converge. InputError."""
    from softdot.config import load_config
    from softdot.console import progress_of

    config = load_config(chosen.config, chosen.set)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = run_case(Case(config), Path(chosen.output), progress, chosen.mesh_format)
    show(summary, chosen, short_text)
    if summary["solver"]["converged"]:
        return GOOD
    complain(f"not converged, {summary['solver']['failure']}; what converged is in '{chosen.output}'")
    return NOT_CONVERGED


PARTS = {1: "a half", 2: "a quarter"}


def _halved(planes: Sequence[str]) -> list[str]:
    """Told where a part was solved."""
    if not planes:
        return []
    return [f"symmetric about {' and '.join(planes)}: solved on {PARTS[len(planes)]}, all results are of the whole"]


def short_text(summary: dict[str, Any], output: str) -> str:
    """The deepest step and where to look, in a few lines."""
    from export.report import plus_minus

    lines = []
    if summary.get("indentation_mm"):
        force, voltage = (plus_minus(summary, name) for name in ("force_percent", "voltage_percent"))
        lines += _halved(summary["mesh"]["symmetry_planes"])
        lines.append(
            f"{summary['indentation_mm'][-1]:.3g} mm: force {summary['reaction_force_N'][-1]:.4g} N{force}, "
            f"charge {summary['film_charge_pC'][-1]:.4g} pC, "
            f"open-circuit voltage {summary['open_circuit_voltage_V'][-1]:.4g} V{voltage}"
        )
    if summary.get("from_default"):
        lines.append(told(summary["from_default"], summary["config"]))
    return "\n".join([*lines, f"{output}/report.html"])
