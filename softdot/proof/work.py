"""One case in a worker. Nothing is raised for a case that fails."""

from pathlib import Path
from typing import Any

from diagnose.prove.trial import Terms, tried
from diagnose.prove.world.cases import Case
from softdot.proof import store


def prove_case(case: Case, terms: Terms, place: Path, program: str) -> dict[str, Any]:
    """The record of a case, kept in the folder of the proof. Its digest is there before the diagnosis begins."""
    try:
        record = tried(case, terms, lambda name, digest: store.commit(place, name, digest))
    except Exception as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        return {"case": {"number": case.number}, "status": "crashed", "reason": reason, "score": None}
    record["program"] = program
    store.keep(place, case.name, record)
    return record
