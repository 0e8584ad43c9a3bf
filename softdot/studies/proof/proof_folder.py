"""The folder of a proof: commitments before, records after; at the end the table of rates and detection.png."""

import json
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from foundation.checked_records import read_checked, write_checked
from softdot.json_files import plain, write_json
from softdot.output import Product, check_output
from softdot.studies.proof.commitment import matches_digest
from softdot.studies.proof.world.cases import Case

FORMAT = "softdot-proof/1"
COMMITMENTS, CASES, TABLE, CURVE = "commitments", "cases", "proof.md", "detection.png"
PROOF = Product(FORMAT, "proof.json", frozenset({"proof.json", ".proof.json.part", COMMITMENTS, CASES, TABLE, CURVE}))
"""With what a proof leaves that was killed while it wrote."""


def check(out: Path) -> Path:
    """The folder, which may be missing yet or hold an earlier proof. InputError."""
    return check_output(out, PROOF)


def begin(place: Path) -> None:
    """Make the folder where it is missing; an earlier proof in it stays."""
    place.mkdir(parents=True, exist_ok=True)
    if not (place / PROOF.summary).exists():  # first of all: it tells whose folder this is
        write_json(place / PROOF.summary, {"format": FORMAT, "complete": False})
    for name in (COMMITMENTS, CASES):
        (place / name).mkdir(exist_ok=True)


def commit(place: Path, name: str, digest: str) -> None:
    """Publish a digest. An earlier one, of a case that was stopped, is replaced together with its record."""
    (place / CASES / f"{name}.json").unlink(missing_ok=True)
    write_json(place / COMMITMENTS / f"{name}.json", {"recording": name, "sha256": digest})


def keep(place: Path, name: str, record: dict[str, Any]) -> None:
    """Write a record, whole or not at all; its truth to the last digit, since the digest is of that."""
    write_checked(place / CASES / f"{name}.json", {**plain(record), "truth": record["truth"]})


def recall_record(place: Path, case: Case, program: str) -> dict[str, Any] | None:
    """The record of an earlier proof of the same case by the same program, whose commitment it fulfils; else None."""
    record = read_checked(place / CASES / f"{case.name}.json", "the case is made again")
    if record is None:
        return None
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        committed = json.loads((place / COMMITMENTS / f"{case.name}.json").read_text("utf-8"))["sha256"]
        same = Case(**{**record["case"], "effects": tuple(record["case"]["effects"])}) == case
        ended = record["program"] == program and record["status"] == "scored"
        if same and ended and matches_digest(record["truth"], record["salt"], committed):
            return record
    return None


def records(place: Path) -> Iterator[dict[str, Any]]:
    """Records that are there, in order; a damaged one of an earlier proof is left out with a warning."""
    for path in sorted((place / CASES).glob("case-*.json")):
        record = read_checked(path, "is left out of the table")
        if record is not None:
            yield record
