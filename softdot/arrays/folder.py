"""The folder of an array's study: presses, crosstalk, what stands for a segment; all at once or not at all."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdot.arrays.report import write_files
from softdot.json_files import plain, write_json
from softdot.log import warn
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.system_libraries import name_missing_library
from softdot.version import installed_version

if TYPE_CHECKING:
    from softdot.arrays.study import ArrayStudy, Part
    from softdot.config.schema import Config


ARRAY = Product(
    "softdot-array/1",
    "array.json",
    frozenset(
        {"array.json", "crosstalk.csv", "report.html", "cad", "pictures", "results", "kernel.npz", "kernel.json"}
    ),
)


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
    or, of a kernel, MeshingError: nothing is written, and presses that were solved are kept in the cache.
    """
    from export.rendering import ensure_rendering
    from softdot.arrays.case import ArrayCase
    from softdot.arrays.study import study
    from softdot.executors import executor_for

    progress = progress or Logged()
    with name_missing_library():
        case = ArrayCase(config)
        warnings = case.warnings
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
            write_files(case, found, summary, folder)
            write_json(folder / ARRAY.summary, summary)
    return summary


def _summary(config: Config, found: ArrayStudy, warnings: list[str]) -> dict[str, Any]:
    """The content of array.json but for its times."""
    from softdot.arrays.kernel_errors import worst
    from softdot.arrays.roles import ROLES
    from softdot.arrays.side_stiffness import as_dict
    from softdot.config.hashes import config_hash

    matrix, layout = found.matrix, found.matrix.layout
    presses = matrix.solved.values()
    late = [text for press in presses for text in press.outcome["warnings"]]
    solvers = [press.outcome["solver"] for press in presses]
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
            "unknowns": max(press.outcome["mesh"]["unknowns"] for press in presses),
            "newton_iterations": sum(one["newton_iterations"] for one in solvers),
            "max_relative_residual": max(one["max_relative_residual"] for one in solvers),
            "solve_s": [press.solve_s for press in presses],
        },
        "warnings": list(dict.fromkeys([*warnings, *late])),
    }
