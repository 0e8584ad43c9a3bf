"""The search for designs on all cores: its folder, which keeps presses and readings, and its results."""

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from foundation.checked_records import read_checked, write_checked
from foundation.errors import InputError
from foundation.executor import Executor
from foundation.scratch_folders import lock_folder, unlock_folder
from foundation.source_hash import source_hash
from softdot.config.hashes import config_hash
from softdot.json_files import plain, write_json
from softdot.log import LOG_FILE, log_file
from softdot.output import Product, check_output
from softdot.progress import Logged, Progress
from softdot.reading.conditions import ReadingConditions
from softdot.reading.designs.design_file import DesignRequest, TriedDesign
from softdot.reading.designs.operating import DesignTask, design_record
from softdot.reading.designs.search import propose

FOLDER = "designs"
DESIGNS = Product(
    "softdot-designs/1",
    "design.json",
    frozenset(
        {"design.json", "designs.csv", "designs.parquet", "designs.toml", "readings.csv", "pareto.png", "report.html",
         "best.toml", FOLDER}
    ),
)  # fmt: skip
ACCIDENTS = ("crashed", "lost")
"""Failures that are not the design's: it is tried again when the search is started again."""


@dataclass(frozen=True)
class AskedReading:
    """The reading that is asked of every design, and its decoder. conditions : without a depth or a force."""

    text: str
    table: str | None
    decoder: str
    conditions: ReadingConditions

    def __post_init__(self) -> None:
        """InputError for a depth or force, which the search finds, and for presses, whose force is no steady one."""
        for name in ("depth_mm", "force_N"):
            if getattr(self.conditions, name) is not None:
                option = f"--{name.replace('_', '-')}"
                raise InputError(f"{option} = {getattr(self.conditions, name):g}: --design finds it; leave it out")
        if self.conditions.mode == "press":
            raise InputError("--mode press: --design slides; leave it out")


@dataclass
class DesignRecords:
    """The tried designs, in order, and their records by name, as of design_record."""

    designs: list[TriedDesign] = field(default_factory=list)
    records: dict[str, dict[str, Any]] = field(default_factory=dict)

    def least_N(self, design: TriedDesign) -> float | None:
        """Mean force at the least depth at which a design reads, N; None where it does not read."""
        least = self.records[design.name]["least"]
        return None if least is None else float(least["mean_force_N"])

    @property
    def best(self) -> TriedDesign | None:
        """The design with the least force of all; None where none reads."""
        read = [one for one in self.designs if self.least_N(one) is not None]
        return min(read, key=lambda one: self.least_N(one) or 0.0, default=None)


def run_designs(
    request: DesignRequest,
    asked: AskedReading,
    out: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Search for the design that reads with the least force into the folder out; the content of design.json.

    The work is done by one process per core, by as many as workers, or by the Dask cluster of a scheduler. A design
    that fails has its reason and does not stop the others; designs of an earlier search in out are not pressed again.
    InputError.
    """
    from softdot.executors import executor_for
    from softdot.reading.designs.results import write_results
    from softdot.sweeps.table import check_tables

    check_tables()
    progress = progress or Logged()
    place = check_output(out, DESIGNS)
    with ExitStack() as stack:
        executor = stack.enter_context(executor_for(scheduler, workers))
        stack.enter_context(_held_folder(place))
        stack.enter_context(log_file(place / LOG_FILE))
        work = DesignWork(request, asked, place / FOLDER, executor, progress)
        found = run_search(work)
        return write_results(place, request, asked, found)


@contextmanager
def _held_folder(place: Path) -> Iterator[None]:
    """Make the folder and hold it for this process; an earlier search in it stays. InputError while another writes."""
    (place / FOLDER).mkdir(parents=True, exist_ok=True)
    held = lock_folder(place)
    if held is None:
        raise InputError(f"output '{place}': another search is writing it; wait for it or name another folder")
    try:
        if not (place / DESIGNS.summary).exists():
            write_json(place / DESIGNS.summary, {"format": DESIGNS.format, "complete": False})
        yield
    finally:
        unlock_folder(held)


def run_search(work: "DesignWork") -> DesignRecords:
    """Press and read with the compared designs, those that fill the space, and then those of the rounds."""
    request = work.request
    work.press_and_read([*request.compared, *request.first])
    for number in range(request.search.rounds):
        own = [one for one in work.found.designs if one not in request.compared]
        rows, forces = [request.row(one) for one in own], [work.found.least_N(one) for one in own]
        seed = request.space.sweep.seed + number
        chosen = propose(request.space.sweep.axes, rows, forces, request.search.each, seed)
        work.press_and_read([request.chosen(len(own) + k, row) for k, row in enumerate(chosen, 1)])
    return work.found


class DesignWork:
    """The work of a search: designs of an earlier one from its folder, and missing ones by an executor."""

    def __init__(
        self, request: DesignRequest, asked: AskedReading, folder: Path, executor: Executor, progress: Progress
    ) -> None:
        self.request, self.found = request, DesignRecords()
        self._asked, self._folder, self._executor, self._progress = asked, folder, executor, progress
        self._program = source_hash(design_record.__module__)

    def press_and_read(self, wanted: list[TriedDesign]) -> None:
        """Press and read with these designs, as far as no record is stored."""
        from softdot.sweeps.points import failed_record, records_as_completed

        search, space = self.request.search, self.request.space
        count = len(self.request.compared) + len(space.points) + search.rounds * search.each
        self.found.designs += wanted
        missing: dict[str, TriedDesign] = {}
        for one in wanted:
            kept = self._stored_record(one)
            if one.config is None:
                kept = {**failed_record("refused", one.reason or ""), "readings": [], "least": None, "seconds": 0.0}
            if kept is None:
                missing[one.name] = one
            else:
                self.found.records[one.name] = kept
        self._progress.stage("designs")
        self._progress.step(len(self.found.records), count, "")
        tasks = {name: (self._task(one),) for name, one in missing.items()}
        for name, record in records_as_completed(self._executor, design_record, tasks):
            whole = {"readings": [], "least": None, "seconds": None, **record}  # a worker that died tells nothing
            self.found.records[name] = self._store_record(missing[name], whole)
            self._progress.step(len(self.found.records), count, _result_line(name, whole))

    def _task(self, design: TriedDesign) -> DesignTask:
        asked, search = self._asked, self.request.search
        assert design.config is not None
        return DesignTask(
            design.config, asked.conditions, asked.text, asked.table, asked.decoder, search.repeats, search.accuracy
        )

    def _path(self, design: TriedDesign) -> Path:
        """The file of a record, named by the hash of everything that it depends on, the program included."""
        task = self._task(design)
        told = {**asdict(task), "config": config_hash(task.config), "program": self._program}
        return self._folder / f"{sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()}.json"

    def _stored_record(self, design: TriedDesign) -> dict[str, Any] | None:
        if design.config is None:
            return None
        found = read_checked(self._path(design), "the design is pressed again")
        return None if found is None or found["status"] in ACCIDENTS else found

    def _store_record(self, design: TriedDesign, record: dict[str, Any]) -> dict[str, Any]:
        told: dict[str, Any] = plain({**record, "name": design.name, "values": dict(design.values)})
        write_checked(self._path(design), told)
        return told


def _result_line(name: str, record: dict[str, Any]) -> str:
    if record["status"] != "solved":
        return f"{name}: {record['status']}, {record['reason']}"
    least = record["least"]
    return f"{name}: " + ("does not read" if least is None else f"reads with {1e3 * least['mean_force_N']:.3g} mN")
