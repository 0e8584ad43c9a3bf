"""One point of a sweep in a worker, tasks through a cluster, and the folder that keeps points as they are solved.

Points are added one whole file at a time, named by the hash of their configuration, so they fit any sweep. Table,
space and summary are replaced together when a sweep is complete: before that the folder has no table, or still that
of the sweep before, with its own summary.
"""

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from geometry.base import InputError
from geometry.cache import read_checked, write_checked
from geometry.files import hold, whole_file
from softdot.config import Config, config_from, config_hash
from softdot.console import plain, write_json
from softdot.outcome import outcome, outcome_key
from softdot.output import Product, check_output

Record = dict[str, Any]

SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST = "solved", "refused", "not-converged", "crashed", "lost"
STATUSES = (SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST)
ACCIDENTS = (CRASHED, LOST)
"""Not the fault of the configuration: tried again when the sweep is started again."""

TINY = {
    "segment": {
        "effector": {"height_mm": 0.5},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 100.0},
        "medium2": {"thickness_mm": 0.5},
    },
    "press": {"indentation_mm": 0.05, "load_steps": 1},
    "mesh": {"mesher": "layered", "element_size_mm": 1.0, "contact_element_size_mm": 1.0},
}


def solve_point(config: Config) -> Record:
    """Outcome of a press with status, reason (None when solved) and seconds. Raises nothing."""
    start = time.perf_counter()
    return {**_attempt(config), "seconds": time.perf_counter() - start}


def _attempt(config: Config) -> Record:
    try:
        found = outcome(config)
    except InputError as error:
        return failed(REFUSED, str(error))
    except Exception as error:
        return failed(CRASHED, f"{type(error).__name__}: {error}")
    if found["solver"]["converged"]:
        return {"status": SOLVED, "reason": None, **found}
    return {**failed(NOT_CONVERGED, found["solver"]["failure"]), **found}


def failed(status: str, reason: str) -> Record:
    """A record without numbers; the reason on one line."""
    return {"status": status, "reason": " ".join(reason.split())}


def warm_up_config() -> Config:
    """A press of seconds that has the kernels compiled by one worker before all of them need them."""
    return config_from(TINY)


AWAY = "the Dask scheduler disappeared; finished points are kept, start the sweep again"
Task = Callable[..., Record]


def solve_all(client: Any, configs: Mapping[str, Config]) -> Iterator[tuple[str, Record]]:
    """Name and record of every configuration, in the order in which they end."""
    return all_ended(client, solve_point, {name: (config,) for name, config in configs.items()}, AWAY)


def all_ended(
    client: Any, task: Task, arguments: Mapping[str, tuple[Any, ...]], away: str
) -> Iterator[tuple[str, Record]]:
    """Name and record of the task with each arguments, in the order in which they end.

    No more are under way than there are threads: when a worker dies, only what it worked on is suspected.
    InputError with the sentence away where the scheduler disappears.
    """
    from distributed import as_completed
    from distributed.client import ClosedClientError

    waiting = iter(arguments.items())
    names: dict[Any, str] = {}
    running = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]

    def fill() -> None:
        """Keep every thread busy, and one task at least under way while the workers are being replaced."""
        threads = max(1, sum(client.nthreads().values()))
        while len(names) < threads and (following := next(waiting, None)) is not None:
            future = client.submit(task, *following[1], pure=False)
            names[future] = following[0]
            running.add(future)  # type: ignore[no-untyped-call]

    try:
        fill()
        for future in running:
            if future.status == "cancelled":
                raise InputError(away)
            yield names.pop(future), _record(future)
            fill()
    except (OSError, ClosedClientError):
        raise InputError(away) from None


def _record(future: Any) -> Record:
    """What the worker returned, or why it could not."""
    from distributed import KilledWorker

    error = future.exception()
    if error is None:
        return dict(future.result())
    if isinstance(error, KilledWorker):
        return failed(LOST, "its worker died each time, perhaps for lack of memory")
    return failed(CRASHED, f"{type(error).__name__}: {error}")


POINTS, TABLE, SPACE_COPY = "points", "sweep.parquet", "space.toml"
CSV_TABLE, PICTURE, PAGE = "sweep.csv", "sweep.png", "report.html"
_WHOLE = ("sweep.json", TABLE, SPACE_COPY, CSV_TABLE, PICTURE, PAGE)
SWEEP = Product("softdot-sweep/1", "sweep.json", frozenset({*_WHOLE, *(f".{name}.part" for name in _WHOLE), POINTS}))
POINT_FORMAT = "softdot-point/1"


def check_folder(out: Path) -> Path:
    """The real path of out. InputError unless it can be made, or is empty or the folder of an earlier sweep."""
    place = check_output(out, SWEEP)
    existing = next(path for path in (place, *place.parents) if path.exists())
    if not os.access(existing, os.W_OK):
        raise InputError(f"output '{out}': not writable (Permission denied)")
    return place


def begin(place: Path) -> None:
    """Make the folder; an earlier sweep in it stays."""
    place.mkdir(parents=True, exist_ok=True)
    if not (place / SWEEP.summary).exists():
        write_json(place / SWEEP.summary, {"format": SWEEP.format, "complete": False})
    (place / POINTS).mkdir(exist_ok=True)


def take(place: Path) -> int | None:
    """Hold the folder for this process, to be released at the end. InputError while another sweep writes it."""
    held = hold(place)
    if held is None:
        raise InputError(f"output '{place}': another sweep is writing it; wait for it or name another folder")
    return held


def sweep_up(place: Path) -> None:
    """Remove what a process that was stopped may have left half-written."""
    for folder in (place, place / POINTS):
        for path in folder.glob(".*.part"):
            path.unlink(missing_ok=True)


def kept(place: Path, config: Config) -> Record | None:
    """The record of a point from an earlier sweep; None without one, after an accident and of another program.

    A damaged one is None too, with a warning; it is deleted.
    """
    found = read_checked(_path(place, config), "the point is solved again")
    if found is None:
        return None
    return found if found["key"] == outcome_key(config) and found["status"] not in ACCIDENTS else None


def keep(place: Path, config: Config, record: Record) -> Record:
    """Write the summary of a point, whole or not at all, and return it."""
    from softdot.console import installed_version

    summary: dict[str, Any] = plain({
        "format": POINT_FORMAT,
        "softdot_version": installed_version(),
        "key": outcome_key(config),
        "config_hash": config_hash(config),
        **record,
        "config": config.model_dump(mode="json"),
    })  # fmt: skip
    write_checked(_path(place, config), summary)
    return summary


def _path(place: Path, config: Config) -> Path:
    return place / POINTS / f"{config_hash(config)}.json"


def finish(
    place: Path, rows: list[dict[str, Any]], axes: Sequence[str], text: str | None, summary: Mapping[str, Any]
) -> None:
    """Replace tables, picture, page, space and, last, the summary. axes : the columns that the sweep has varied."""
    from softdot.sweeps.table import draw, write_csv, write_report, write_table

    write_table(place / TABLE, rows)
    write_csv(place / CSV_TABLE, rows)
    draw(place / PICTURE, rows, axes)
    write_report(place / PAGE, rows, axes, summary, place / PICTURE)
    if text is None:
        (place / SPACE_COPY).unlink(missing_ok=True)
    else:
        with whole_file(place / SPACE_COPY) as beside:
            beside.write_text(text, "utf-8")
    write_json(place / SWEEP.summary, summary)
