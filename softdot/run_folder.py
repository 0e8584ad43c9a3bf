"""The folder of a run: check, geometry, mesh, solve, export; everything appears at once or not at all."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, wait
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdot.json_files import plain, write_json
from softdot.log import lines_when_interactive, warn
from softdot.output import RUN, staged_folder
from softdot.progress import Logged, Progress
from softdot.second_process import SecondProcess, draw, make_cad, warm_drawing
from softdot.system_libraries import name_missing_library

if TYPE_CHECKING:
    from geometry.dot import DotShape
    from softdot.config.schema import Config
    from softdot.prepared_press import OnStep, PreparedPress
    from solve.result import PressResult, Step

LOG = logging.getLogger(__name__)


class StageClock:
    """A clock that adds up wall-clock seconds by stage."""

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


def run_case(
    case: PreparedPress,
    out: Path,
    progress: Progress | None = None,
    mesh_formats: Sequence[str] = (),
    ask: SecondProcess | None = None,
) -> dict[str, Any]:
    """Check, mesh and press, write all files into the folder out and return summary.json.

    mesh_formats : in which the mesh is written for other codes, see mesh.files.formats. ask : a second process that is
    there already, which is ended here; else one is started. InputError before any work for what cannot be built or
    written. Where a computation does not converge nothing is raised: solver.converged is False, solver.failure says why
    and what converged is written.
    """
    from export.rendering import ensure_rendering
    from mesh.files.formats import check_formats
    from softdot.summary import heading

    progress = progress or Logged()
    with name_missing_library(), lines_when_interactive():
        check_formats(mesh_formats)
        _ = case.checked_design
        window = ensure_rendering()
        # the second process ends first: it must write nothing into a folder that is being removed
        with staged_folder(out, RUN) as folder, ask or SecondProcess() as second:
            second(ensure_rendering, window)
            filled = _fill_folder(case, folder, progress, mesh_formats, second)
            summary: dict[str, Any] = heading(case.config) | plain(filled)
            write_json(folder / RUN.summary, summary)
    return summary


def _fill_folder(
    case: PreparedPress, folder: Path, progress: Progress, mesh_formats: Sequence[str], ask: SecondProcess
) -> dict[str, Any]:
    """Make everything but summary.json and return the summary; parts and pictures are made beside mesh and press."""
    from mesh.files.formats import write_mesh
    from mesh.types import MeshingError
    from softdot.config.loading import unused_material_warnings
    from softdot.summary import heading, mesh_part, press_part, stopped_solver
    from softdot.tolerances.uncertainty import fill_cache, uncertainty
    from solve.fem.warm_up import compile_other_kernels

    clock, config, model = StageClock(), case.config, case.model
    summary = {**heading(config), "warnings": [*case.warnings, *unused_material_warnings(config)]}
    warn(summary["warnings"])
    _log_preliminaries(config)
    cad = ask(make_cad, model.segment, case.dot, folder / "cad")
    progress.stage("mesh")
    try:
        with clock("mesh"):
            # a slice is pressed before another process has loaded the solver
            ahead = ask(fill_cache, case.sized_config) if config.segment.section == "solid" else None
            ask(warm_drawing)
            quality = case.mesh_quality
    except MeshingError as error:
        clock.seconds["geometry"] = cad.result()
        return {**summary, "solver": stopped_solver(f"meshing: {error}"), "timing_s": clock.seconds}
    if mesh_formats:
        with clock("export"):
            write_mesh(case.mesh, mesh_formats, folder / "mesh")
    progress.stage("solve")
    with clock("solve"):
        if not ask.kernels.done():
            compile_other_kernels()
            wait((ask.kernels,))
        pressed = case.press(_report_steps_to(progress))
        result, along = pressed.result, pressed.course
    if ahead is not None and ahead.cancel():  # not begun: it is done here, while the second process draws
        ahead = None
    pictures = ask(draw, result.tet_mesh, result, case.dot, folder / "pictures", along, model.segment.film.electrodes)
    summary |= {"mesh": mesh_part(quality, result.unknowns), **press_part(model, result, along)}
    warn(pressed.doubts)
    summary["warnings"] += pressed.doubts
    if result.converged:
        progress.stage("uncertainty")
        with clock("uncertainty"):
            wait((ahead,) if ahead is not None else ())
            summary |= uncertainty(case.sized_config, summary)
    clock.seconds["geometry"] = cad.result()
    progress.stage("export")
    with clock("export"):
        so_far = {"timing_s": dict(clock.seconds)}
        write_outputs(case.dot, result, plain(summary | so_far), folder, pictures)
    return {**summary, "timing_s": clock.seconds}


def _log_preliminaries(config: Config) -> None:
    """Log, before the work begins, which keys were not stated and that kernels have yet to be compiled."""
    from softdot.checks import COMPILE_S
    from softdot.config.default_design import default_design_line
    from solve.fem.warm_up import is_compiled

    if config.from_default:
        LOG.info("%s", default_design_line(config.from_default, config.model_dump(mode="json")))
    if not is_compiled():
        LOG.info("compiling kernels beside the mesh, once on this machine: about %.0f s", COMPILE_S)


def write_outputs(
    dot_shape: DotShape, result: PressResult, summary: dict[str, Any], folder: Path, pictures: Future[dict[str, Path]]
) -> None:
    """Write ParaView files of what converged, and the report with the pictures, which another process makes."""
    from export.noise_figure import noise_figure
    from export.report import write_report
    from export.view import save_png
    from export.viewer_data import viewer_data
    from export.vtu import write_results

    write_results(result.tet_mesh, result, dot_shape, folder / "results")
    viewer = viewer_data(result.tet_mesh, result, dot_shape)
    drawn = pictures.result()
    if "noise" in summary:
        drawn = {**drawn, "noise": folder / "pictures" / "noise.png"}
        save_png(noise_figure(summary["noise"]), drawn["noise"])
    write_report(summary, drawn, viewer, folder / "report.html")


def _report_steps_to(progress: Progress) -> OnStep:
    """A function that passes the solver's steps on as text."""

    def on_step(step: Step, number: int, count: int) -> None:
        progress.step(number, count, f"{1e3 * step.indentation_m:.3f} mm, {step.reaction_force_N:.3g} N")

    return on_step
