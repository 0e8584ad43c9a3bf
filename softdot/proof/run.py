"""A proof from its plan to its table."""

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diagnose.prove.score import Score
from diagnose.prove.trial import Terms
from diagnose.prove.world.cases import KINDS, Case, plan
from geometry.base import InputError
from mesh.cache import check_folder
from mesh.fingerprint import data_hash, files_hash
from softdot.log import LOG_FILE, log_file
from softdot.numbers import plain, write_json
from softdot.progress import Logged, Progress
from softdot.proof import store
from softdot.proof.work import prove_case

RIDGES = ("ridge-clamped", "ridge-free")
RIGS = (*RIDGES, "dot-clamped")
AWAY = "the Dask scheduler disappeared; finished cases are kept, start the proof again"


@dataclass(frozen=True)
class Request:
    """What is asked for. staged : the first eight mechanisms only. workers : processes, None for one per core.

    kinds : of cases; each case is the same as among all kinds. scheduler : address of a Dask cluster that sees the same
    folders; None for processes of this computer.
    """

    cases: int
    seed: int = 0
    rigs: tuple[str, ...] = RIGS
    staged: bool = False
    workers: int | None = None
    kinds: tuple[str, ...] = KINDS
    scheduler: str | None = None
    limit_s: float = 3600.0


def run_proof(request: Request, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Prove all cases into the folder out and return the summary (proof.json). InputError before any work.

    Cases that an earlier proof left in out are not tried again. After Ctrl-C those that were finished stay.
    """
    _check(request)
    check_folder()
    place, program = store.check(out), program_hash()
    cases = plan(request.cases, request.seed, request.rigs, request.staged, request.kinds)
    found = {case.name: record for case in cases if (record := store.kept(place, case, program)) is not None}
    missing = [case for case in cases if case.name not in found]
    progress = progress or Logged()
    reused = len(found)
    for name, record in _tried(missing, request, place, program):
        if not found:
            progress.stage("prove")
        found[name] = record
        progress.step(len(found), len(cases), record["reason"] or "")
    return _finished(request, place, [found[case.name] for case in cases], reused)


def _check(request: Request) -> None:
    if request.cases < 1:
        raise InputError(f"--cases {request.cases}: must be at least 1")
    if request.workers is not None and request.workers < 1:
        raise InputError(f"--workers {request.workers}: must be at least 1")
    if request.seed < 0:
        raise InputError(f"--seed {request.seed}: must not be negative")
    for rig in request.rigs:
        if rig not in RIGS:
            raise InputError(f"--rigs '{rig}': must be of {', '.join(RIGS)}")
    for kind in request.kinds:
        if kind not in KINDS:
            raise InputError(f"--kinds '{kind}': must be of {', '.join(KINDS)}")


def _tried(
    missing: Sequence[Case], request: Request, place: Path, program: str
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Names and records as they come, from one process per core or from a cluster that runs already."""
    if not missing:
        return
    from mesh.cache import folder
    from softdot.sweep.cluster import local_cluster
    from softdot.sweep.scheduler import existing_cluster
    from softdot.sweep.stream import all_ended

    terms = Terms(folder().resolve(), request.limit_s)
    arguments = {case.name: (case, terms, place.resolve(), program) for case in missing}
    address = request.scheduler
    with local_cluster(request.workers) if address is None else existing_cluster(address) as client:
        store.begin(place)  # once somebody can work
        with log_file(place / LOG_FILE):
            for name, record in all_ended(client, prove_case, arguments, AWAY):
                yield name, {"score": None, **record}


def _finished(request: Request, place: Path, records: Sequence[Mapping[str, Any]], reused: int) -> dict[str, Any]:
    """Count, draw and write."""
    from diagnose.prove.tally import tally
    from softdot.proof.curve import draw
    from softdot.proof.table import rival_rates, text
    from softdot.sweep.hardware import hardware
    from softdot.version import installed_version

    scores = [score_from(record["score"]) for record in records if record["score"] is not None]
    summary: dict[str, Any] = plain({
        "format": store.FORMAT, "complete": True, "softdot_version": installed_version(),
        "cases": request.cases, "seed": request.seed, "rigs": list(request.rigs), "staged": request.staged,
        "kinds": list(request.kinds),
        "ended": dict(Counter(record["status"] for record in records)), "reused": reused,
        "reasons": sorted({record["reason"] for record in records if record["reason"]}),
        "rates": tally(scores), "rivals": rival_rates(records), "hardware": hardware(),
    })  # fmt: skip
    (place / store.TABLE).write_text(text(summary), "utf-8")
    (place / store.CURVE).unlink(missing_ok=True)  # an earlier one may be of other kinds of cases
    if summary["rates"]["by_size"]:
        draw(summary["rates"]["by_size"], place / store.CURVE)
    write_json(place / store.PROOF.summary, summary)
    return summary


def score_from(saved: Mapping[str, Any]) -> Score:
    """The score that a record holds."""
    names = {key: tuple((m, c) for m, c in saved[key]) for key in ("truth", "named")}
    return Score(**{**saved, **names})


def program_hash() -> str:
    """Of everything that a verdict, a case or a score depends on."""
    root = Path(__file__).parents[2]
    rooms = ("geometry", "mesh", "solve", "diagnose", "softdot")
    files = (path for room in rooms for path in root.glob(f"{room}/**/*"))
    sources = [path for path in files if path.suffix in (".py", ".toml", ".csv")]
    recordings = os.environ.get("SOFTDOT_RECORDINGS", "")
    return data_hash([files_hash(sources), recordings])
