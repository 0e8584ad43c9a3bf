"""Presses that are not on disk yet, on all cores: one process a core, fed one press at a time."""

import os
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.base import Report
from geometry.beside import each_beside
from solve.solution.newton import NoEquilibriumError
from solve.tables import job as job_files
from solve.tables.job import RETURN, Job, Reduction


def answer(job: Job | Reduction) -> Floats | Exception:
    """Outputs, or the error that can be sent."""
    try:
        return job.run() if isinstance(job, Reduction) else _outputs_of(job)
    except (NoEquilibriumError, ValueError) as error:
        return RuntimeError(str(error))


def _outputs_of(job: Job) -> Floats:
    """Outputs; equilibria are left where other presses find them."""
    outputs, found = job.run(job_files.equilibria(job.guided_by) if job.guided_by else None)
    if found is not None:
        job_files.keep_equilibria(job_files.key(job), found)
    return outputs


WORTH_A_PROCESS = 4  # presses: a process takes seconds to start
LARGE = 3000  # nodes: one such press is worth a process, as are the many of a reduction
WHAT = "pressing the 3D model"


def run_all(jobs: Sequence[Job], report: Report, first: Sequence[Reduction] = ()) -> list[Floats]:
    """Outputs of all jobs in order, each kept as soon as it is there; empty (0,) for a press without equilibrium.

    first : what takes longest, and is kept where it is made. NoEquilibriumError for one of these.
    """
    names = [job_files.key(job) for job in jobs]
    found = {name: table for name in names if (table := job_files.recall(name)) is not None}
    left = sorted(
        ((name, job) for name, job in zip(names, jobs, strict=True) if name not in found),
        key=lambda one: -_effort(one[1]),  # the longest last would keep one core only
    )
    missing: dict[str, Job | Reduction] = {f"reduction {n}": job for n, job in enumerate(first)}
    missing |= dict(left)
    if missing:
        report(WHAT, 0, len(missing))
    for number, (name, table) in enumerate(_pressed(missing), start=1):
        if isinstance(missing[name], Job):
            found[name] = np.zeros(0) if isinstance(table, Exception) else table
            job_files.keep(name, found[name])
        elif isinstance(table, Exception):
            raise NoEquilibriumError(str(table), np.zeros(0), None) from table
        report(WHAT, number, len(missing))
    return [found[name] for name in names]


def _effort(job: Job) -> float:
    """What a press takes, roughly: steps down and back, of which slip takes as many more, by nodes."""
    return len(job.tet_mesh.points_mm) * job.parts * (len(job.shares) + len(job.back) * len(RETURN))


def _pressed(jobs: dict[str, Job | Reduction]) -> Iterator[tuple[str, Any]]:
    """Name and outputs, or the error, of each job as it is done."""
    large = sum(isinstance(job, Reduction) or len(job.tet_mesh.points_mm) > LARGE for job in jobs.values())
    count = min(os.cpu_count() or 1, max(large, len(jobs) // WORTH_A_PROCESS))
    if count < 2:
        for name, job in jobs.items():
            yield name, answer(job)
        return
    yield from each_beside(answer, jobs, count)
