"""A whole proof: all cases, each with its record, and at the end the table of rates."""

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from foundation.cache import check_cache_folder, data_hash
from foundation.errors import InputError
from foundation.source_hash import source_hash
from softdot.json_files import plain, write_json
from softdot.log import LOG_FILE, log_file
from softdot.progress import Logged, Progress
from softdot.studies.proof import proof_folder as proof_files
from softdot.studies.proof.score import Score
from softdot.studies.proof.trial import Terms, try_case
from softdot.studies.proof.world.cases import KINDS, Case, plan
from softdot.studies.proof.world.effects import EFFECTS, KNOWN, STAGED, fits
from softdot.studies.proof.world.rigs import BENCHES, OFFERED


def prove_case(case: Case, terms: Terms, place: Path, program: str) -> dict[str, Any]:
    """The record of a case, kept in the folder of the proof. Its digest is there before the diagnosis begins."""
    try:
        record = try_case(case, terms, lambda name, digest: proof_files.commit(place, name, digest))
    except Exception as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        return {"case": {"number": case.number}, "status": "crashed", "reason": reason, "score": None}
    record["program"] = program
    proof_files.keep(place, case.name, record)
    return record


RIGS = tuple(name for name in OFFERED if BENCHES[name].usual)


@dataclass(frozen=True)
class Request:
    """What is asked for. staged : the first eight mechanisms only. workers : processes, None for one per core.

    kinds : of cases; each case is the same as among all kinds. scheduler : address of a Dask cluster that sees the same
    folders; None for processes of this computer. details : whether every rig has flaws that no mechanism describes.
    mechanisms : to which the known effects are restricted, () for all.
    """

    cases: int
    seed: int = 0
    rigs: tuple[str, ...] = RIGS
    staged: bool = False
    workers: int | None = None
    kinds: tuple[str, ...] = KINDS
    scheduler: str | None = None
    limit_s: float = 3600.0
    details: bool = False
    mechanisms: tuple[str, ...] = ()


def run_proof(request: Request, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Prove all cases into the folder out and return the summary (proof.json). InputError before any work.

    Cases that an earlier proof left in out are not tried again. After Ctrl-C those that were finished stay.
    """
    _check(request)
    check_cache_folder()
    place, program = proof_files.check(out), program_hash()
    cases = plan(
        request.cases, request.seed, request.rigs, request.staged, request.kinds, request.details, request.mechanisms
    )
    found = {
        case.name: record for case in cases if (record := proof_files.recall_record(place, case, program)) is not None
    }
    missing = [case for case in cases if case.name not in found]
    progress = progress or Logged()
    reused = len(found)
    for name, record in _try_cases(missing, request, place, program):
        if not found:
            progress.stage("prove")
        found[name] = record
        progress.step(len(found), len(cases), record["reason"] or "")
    return _finish(request, place, [found[case.name] for case in cases], reused)


def _check(request: Request) -> None:
    if request.cases < 1:
        raise InputError(f"--cases {request.cases}: must be at least 1")
    if request.workers is not None and request.workers < 1:
        raise InputError(f"--workers {request.workers}: must be at least 1")
    if request.seed < 0:
        raise InputError(f"--seed {request.seed}: must not be negative")
    for rig in request.rigs:
        if rig not in OFFERED:
            raise InputError(f"--rigs '{rig}': must be of {', '.join(OFFERED)}")
    for name in request.mechanisms:
        can = _hidden(request)
        if name not in can:
            raise InputError(f"--mechanisms '{name}': must be of those that these rigs can hide: {', '.join(can)}")
    for kind in request.kinds:
        if kind not in KINDS:
            raise InputError(f"--kinds '{kind}': must be of {', '.join(KINDS)}")


def _hidden(request: Request) -> list[str]:
    """Mechanisms that one of the rigs can hide."""
    names = KNOWN[:STAGED] if request.staged else KNOWN
    able = [name for name in names if any(fits(name, BENCHES[rig]) for rig in request.rigs)]
    return list(dict.fromkeys(EFFECTS[name].mechanism for name in able))


def _try_cases(
    missing: Sequence[Case], request: Request, place: Path, program: str
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Try the missing cases; names and records as they come, from one process per core or from a cluster that runs
    already.
    """
    if not missing:
        return
    from foundation.cache import cache_folder
    from softdot.executors import executor_for
    from softdot.sweeps.points import records_as_completed

    terms = Terms(cache_folder().resolve(), request.limit_s)
    arguments = {case.name: (case, terms, place.resolve(), program) for case in missing}
    with executor_for(request.scheduler, request.workers) as executor:
        proof_files.begin(place)  # once somebody can work
        with log_file(place / LOG_FILE):
            for name, record in records_as_completed(executor, prove_case, arguments):
                yield name, {"score": None, **record}


def _finish(request: Request, place: Path, records: Sequence[Mapping[str, Any]], reused: int) -> dict[str, Any]:
    """Count, draw and write; returns the summary."""
    from softdot.hardware import hardware
    from softdot.studies.proof.detection_curves import draw
    from softdot.studies.proof.proof_page import text
    from softdot.studies.proof.rates import tally
    from softdot.studies.proof.rival_rates import rival_rates
    from softdot.version import installed_version

    scores = [score_from(record["score"]) for record in records if record["score"] is not None]
    summary: dict[str, Any] = plain({
        "format": proof_files.FORMAT, "complete": True, "softdot_version": installed_version(),
        "cases": request.cases, "seed": request.seed, "rigs": list(request.rigs), "staged": request.staged,
        "kinds": list(request.kinds), "details": request.details, "mechanisms": list(request.mechanisms),
        "ended": dict(Counter(record["status"] for record in records)), "reused": reused,
        "reasons": sorted({record["reason"] for record in records if record["reason"]}),
        "rates": tally(scores), "rivals": rival_rates(records), "hardware": hardware(),
    })  # fmt: skip
    (place / proof_files.TABLE).write_text(text(summary), "utf-8")
    (place / proof_files.CURVE).unlink(missing_ok=True)  # an earlier one may be of other kinds of cases
    if summary["rates"]["by_size"]:
        draw(summary["rates"]["by_size"], place / proof_files.CURVE)
    write_json(place / proof_files.PROOF.summary, summary)
    return summary


def score_from(saved: Mapping[str, Any]) -> Score:
    """The score that a record holds."""
    names = {key: tuple((m, c) for m, c in saved[key]) for key in ("truth", "named", "main_part") if key in saved}
    return Score(**{**saved, **names})


def program_hash() -> str:
    """Hash of everything that a verdict, a case or a score depends on."""
    program = [source_hash(module) for module in (__name__, "softdot.commands.diagnose")]
    recordings = os.environ.get("SOFTDOT_RECORDINGS", "")
    return data_hash([*program, recordings])
