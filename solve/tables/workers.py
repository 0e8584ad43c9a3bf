"""Presses that are not on disk yet, by an executor where they are worth it."""

from collections.abc import Mapping, Sequence

import numpy as np

from foundation.arrays import Floats
from foundation.executor import HERE, Executor, completed_calls
from foundation.progress import Report
from solve.reduced.model import ReducedModel
from solve.solution.errors import NoEquilibriumError
from solve.tables import cache
from solve.tables.depth_press import DepthPress
from solve.tables.reduction import Reduction


def answer(job: DepthPress | Reduction) -> Floats | ReducedModel | str:
    """Answer of a job: outputs, a reduced model, or a sentence why there is none."""
    try:
        return job.build_model() if isinstance(job, Reduction) else _outputs_of(job)
    except (NoEquilibriumError, ValueError) as error:
        return str(error)


def _outputs_of(job: DepthPress) -> Floats:
    """Outputs of a press; its equilibria are left where other presses find them."""
    outputs, found = job.solve(cache.recall_equilibria(job.guided_by) if job.guided_by else None)
    if found is not None:
        cache.keep_equilibria(cache.key(job), found)
    return outputs


WORTH_A_PROCESS = 4  # presses: a process takes seconds to start
LARGE_MESH_NODES = 3000  # nodes: one such press is worth a process, as are the many of a reduction
PROGRESS_WORDS = "pressing the 3D model"


def run_all(
    jobs: Sequence[DepthPress], report: Report, first: Sequence[Reduction] = (), executor: Executor = HERE
) -> list[Floats]:
    """Outputs of all jobs in order, each kept as soon as it is there; empty (0,) for a press without equilibrium.

    first : what takes longest, and can be recalled afterwards. NoEquilibriumError for one of these.
    """
    names = [cache.key(job) for job in jobs]
    found = {name: table for name in names if (table := cache.recall(name)) is not None}
    left = sorted(
        ((name, job) for name, job in zip(names, jobs, strict=True) if name not in found),
        key=lambda one: -_effort(one[1]),  # the longest last would keep one core only
    )
    missing: dict[str, DepthPress | Reduction] = {f"reduction {n}": job for n, job in enumerate(first)}
    missing |= dict(left)
    if missing:
        report(PROGRESS_WORDS, 0, len(missing))
    places = executor if _are_worth_processes(missing) else HERE
    calls = {name: (job,) for name, job in missing.items()}
    for number, (name, future) in enumerate(completed_calls(places, answer, calls), start=1):
        job, outputs = missing[name], future.result()
        if isinstance(job, DepthPress):
            found[name] = np.zeros(0) if isinstance(outputs, str) else outputs
            cache.keep(name, found[name])
        elif isinstance(outputs, str):
            raise NoEquilibriumError(outputs, np.zeros(0), None)
        else:
            job.keep(outputs)
        report(PROGRESS_WORDS, number, len(missing))
    return [found[name] for name in names]


def _effort(job: DepthPress) -> float:
    """Rough effort of a press: steps down and back, of which slip takes as many more, by nodes."""
    return len(job.tet_mesh.points_mm) * job.parts * (len(job.shares) + len(job.back) * len(job.returns))


def _are_worth_processes(jobs: Mapping[str, DepthPress | Reduction]) -> bool:
    """Whether these presses take longer than two processes to start."""
    large = sum(isinstance(job, Reduction) or len(job.tet_mesh.points_mm) > LARGE_MESH_NODES for job in jobs.values())
    return max(large, len(jobs) // WORTH_A_PROCESS) > 1
