"""softdot sweep: from a space of designs to a table, with the time that remains."""

import sys
import time
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geometry.cache import check_folder
from geometry.executor import Executor
from geometry.files import release
from softdot.config import Config, config_hash
from softdot.console import (
    GOOD,
    INTERRUPTED,
    LOG_FILE,
    NOT_CONVERGED,
    Logged,
    Progress,
    complain,
    log_file,
    only_the_summary_on_stdout,
    show,
)
from softdot.executors import executor_for, hardware
from softdot.sweeps import points as point_files
from softdot.sweeps.points import REFUSED, STATUSES, Record, failed, solve_all
from softdot.sweeps.space import Point, Space, sampling_warnings
from softdot.sweeps.table import check_tables, row

if TYPE_CHECKING:
    from rich.progress import Progress as Bars


def run_sweep(
    space: Space, out: Path | str, scheduler: str | None = None, progress: Progress | None = None
) -> dict[str, Any]:
    """Solve every point of a space into the folder out and return the summary (sweep.json).

    On one process per core, or on the Dask cluster of a scheduler (tcp://HOST:PORT). Points that an earlier sweep
    left in out are not solved again. InputError before any work for a folder that cannot be written, for a
    scheduler that does not answer, and without pyarrow. After Ctrl-C, or when killed, the finished points stay.
    """
    check_tables()
    check_folder()
    place = point_files.check_folder(Path(out))
    configs = {config_hash(point.config): point.config for point in space.points if point.config is not None}
    records = {
        name: found for name, config in configs.items() if (found := point_files.kept(place, config)) is not None
    }
    missing = {name: config for name, config in configs.items() if name not in records}
    where = executor_for(scheduler, space.sweep.workers)
    with ExitStack() as stack:
        measured = _measured(0, len(records))
        if missing:
            measured = _solve(missing, records, where, place, progress or Logged(), stack)
        ends = [_record(point, records) for point in space.points]
        summary = {**_heading(space, ends), "scheduler": scheduler, **measured, "hardware": hardware()}
        rows = [row(number, space.points[number].values, record) for number, record in enumerate(ends)]
        point_files.finish(place, rows, list(space.points[0].values), space.text, summary)
    return summary


def _solve(
    missing: Mapping[str, Config],
    records: dict[str, Record],
    where: AbstractContextManager[Executor],
    place: Path,
    progress: Progress,
    stack: ExitStack,
) -> dict[str, Any]:
    """Add what is missing to the records and to the folder, which is made once somebody can work.

    stack : gives the folder up at its end, so that no other sweep writes it meanwhile.
    """
    reused, count = len(records), len(records) + len(missing)
    begun = time.perf_counter()
    with where as executor:
        point_files.begin(place)
        stack.callback(release, point_files.take(place))
        point_files.sweep_up(place)
        stack.callback(point_files.sweep_up, place)
        workers = executor.places
        ready = time.perf_counter()
        with log_file(place / LOG_FILE):
            progress.stage("solve")
            progress.step(reused, count, "")
            for name, record in solve_all(executor, missing):
                records[name] = point_files.keep(place, missing[name], record)
                progress.step(len(records), count, record["reason"] or "")
        end = time.perf_counter()
    return _measured(len(missing), reused, workers, ready - begun, end - ready)


def _measured(solved: int, reused: int, workers: int = 0, start_s: float = 0.0, solve_s: float = 0.0) -> dict[str, Any]:
    """What this call did, and how fast."""
    return {
        "solved_now": solved,
        "reused": reused,
        "workers": workers,
        "timing_s": {"start": start_s, "solve": solve_s},
        "points_per_minute": 60.0 * solved / solve_s if solved else None,
    }


def _record(point: Point, records: Mapping[str, Record]) -> Record:
    """The record of a point; one without configuration has its reason."""
    if point.config is None:
        return failed(REFUSED, point.reason or "")
    return records[config_hash(point.config)]


def _heading(space: Space, ends: list[Record]) -> dict[str, Any]:
    """Format, design and how the points ended."""
    from softdot.console import installed_version

    ended = Counter(record["status"] for record in ends)
    return {
        "format": point_files.SWEEP.format,
        "complete": True,
        "softdot_version": installed_version(),
        "sampling": space.sweep.sampling,
        "seed": space.sweep.seed,
        "points": len(ends),
        "ended": {status: ended[status] for status in STATUSES},
        "warnings": sampling_warnings(space.sweep),
        "space": space.tables,
    }


def command(chosen: Namespace) -> int:
    """Sweep chosen.space into chosen.output; 0, or 3 when not one point could be solved, or 130. InputError."""
    from softdot.sweeps.points import POINTS
    from softdot.sweeps.space import load_space

    space = load_space(chosen.space, chosen.set)
    try:
        with only_the_summary_on_stdout(), progress_of_points(chosen) as progress:
            summary = run_sweep(space, Path(chosen.output), chosen.scheduler, progress)
    except KeyboardInterrupt:
        if not (Path(chosen.output) / POINTS).exists():
            raise
        kept = f"finished points are kept in '{chosen.output}', the same command continues with the others"
        complain(f"interrupted; {kept}")
        return INTERRUPTED
    show(summary, chosen, short_text)
    if summary["ended"]["solved"]:
        return GOOD
    complain(f"not one of {summary['points']} points could be solved; the reasons are in '{chosen.output}'")
    return NOT_CONVERGED


def short_text(summary: dict[str, Any], output: str) -> str:
    """How the points ended, how fast, and where the table is."""
    ended = ", ".join(f"{count} {status}" for status, count in summary["ended"].items() if count)
    lines = [f"{summary['points']} points: {ended}"]
    if summary["solved_now"]:
        rate = f"{summary['points_per_minute']:.3g} points per minute on {summary['workers']} workers"
        lines.append(f"{summary['solved_now']} solved now, {rate}; {summary['reused']} were there")
    return "\n".join([*lines, f"{output}/report.html"])


MEMORY_S = 3600.0
"""The rate is that of the last hour: a point may take longer than the half minute that rich looks back."""


@contextmanager
def progress_of_points(chosen: Namespace) -> Iterator[Progress]:
    """A bar of points where standard error is a terminal and --quiet was not given, else lines alone."""
    if chosen.quiet or not sys.stderr.isatty():
        yield Logged()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("points,"),
        TimeElapsedColumn(), TextColumn("passed,"), TimeRemainingColumn(), TextColumn("to go"),
    )  # fmt: skip
    with Bars(*columns, console=Console(stderr=True), speed_estimate_period=MEMORY_S) as bars:
        yield _Points(bars)


class _Points(Logged):
    """One bar; the points of an earlier sweep do not count for the rate."""

    def __init__(self, bars: "Bars") -> None:
        super().__init__()
        self._bars = bars
        self._failures = 0
        self._task = bars.add_task("start", total=None)

    def stage(self, name: str) -> None:
        """Begin the bar anew."""
        super().stage(name)
        self._bars.remove_task(self._task)
        self._task = self._bars.add_task(name, total=None)

    def step(self, number: int, count: int, text: str) -> None:
        """So many of the points are there; text is the reason of one that failed."""
        super().step(number, count, text)
        self._failures += bool(text)
        named = f"solve, {self._failures} failed" if self._failures else "solve"
        self._bars.update(self._task, total=count, completed=number, description=named)
