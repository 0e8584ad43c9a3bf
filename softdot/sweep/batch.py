"""Many presses at once for other studies: configurations in, outcomes out, in order."""

from collections.abc import Mapping, Sequence
from typing import Any

from softdot.config import Config
from softdot.outcome import outcome_key, remembered
from softdot.progress import Logged, Progress
from softdot.sweep.cluster import local_cluster
from softdot.sweep.point import Record, solve_point
from softdot.sweep.stream import solve_all


def solve_points(
    configs: Sequence[Config], progress: Progress | None = None, workers: int | None = None
) -> list[dict[str, Any]]:
    """The outcome of every configuration, in order, solved on one process per core (or as many as workers).

    Each is a new dict with status ("solved", "refused", "not-converged", "crashed" or "lost"), reason (one line,
    None when solved), seconds, and all of softdot.outcome.outcome(config), as far as there is any. No point stops the
    others and nothing is raised for one. Equal configurations are solved once; outcomes that are remembered need no
    worker. progress.step(done, count, reason or "") is called after each point.
    A script needs `if __name__ == "__main__":` around the call.
    """
    progress = progress or Logged()
    keys = [outcome_key(config) for config in configs]
    distinct = dict(zip(keys, configs, strict=True))
    records = {key: solve_point(config) for key, config in distinct.items() if remembered(config) is not None}
    missing = {key: config for key, config in distinct.items() if key not in records}
    if missing:
        _solve(missing, records, progress, workers)
    return [dict(records[key]) for key in keys]


def _solve(missing: Mapping[str, Config], records: dict[str, Record], progress: Progress, workers: int | None) -> None:
    """Fill records with what is missing."""
    count = len(records) + len(missing)
    with local_cluster(workers) as client:
        for key, record in solve_all(client, missing):
            records[key] = record
            progress.step(len(records), count, record["reason"] or "")
