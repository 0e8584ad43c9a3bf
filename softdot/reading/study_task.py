"""One reading of a study, kept as a file by the hash of all it depends on, so that a study that was stopped goes on."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from foundation.checked_records import read_checked, write_checked
from foundation.errors import InputError
from foundation.source_hash import source_hash
from softdot.arrays.kernel import JSON, NPZ, ArrayKernel
from softdot.progress import Untold
from softdot.reading.cells import cells_of, text_of
from softdot.reading.conditions import ReadingConditions
from softdot.reading.decoders import named_decoders
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.kernels import open_kernel
from softdot.reading.line_reading import read_line, reading_content
from solve.model import Readout

RATES = ("cell", "character", "word")
"""Elements whose share of right ones is recorded."""


@dataclass(frozen=True)
class StudyTask:
    """One reading of a study, with the folder of its kernel and its read-out as JSON."""

    folder: str
    readout: str
    conditions: ReadingConditions
    text: str
    table: str | None
    decoder: str

    def hash_key(self, kernel_hash: str) -> str:
        """The hash of everything that the reading depends on, the program included."""
        told = {**asdict(self), "folder": kernel_hash, "program": source_hash(__name__)}
        return sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def kernel_hash(folder: Path) -> str:
    """The hash of both files of a kernel."""
    return sha256(b"".join((folder / name).read_bytes() for name in (NPZ, JSON))).hexdigest()


@lru_cache(maxsize=1)
def _kernel(folder: str) -> ArrayKernel:
    return open_kernel(Path(folder))


def read_task(task: StudyTask) -> dict[str, Any]:
    """The record of one reading: status "read" with the numbers of the first decoder, and of each by its name, or
    "refused" with the reason. Raises no InputError.
    """
    try:
        kernel, cells = _kernel(task.folder), cells_of(task.text, task.table)
        readout, names = Readout.model_validate_json(task.readout), named_decoders(task.decoder)
        reading = read_line(kernel, readout, task.conditions, names, Untold(), cells)
    except NoDotError:
        nothing = {"right": 0, "of": len(text_of(cells, task.table)), "accuracy": dict.fromkeys(RATES, 0.0)}
        return {"status": "read", "reason": None, **nothing, "text_read": "", "decoders": dict.fromkeys(names, nothing)}
    except InputError as error:
        return {"status": "refused", "reason": str(error)}
    told = reading_content(reading, task.text, task.table)
    decoders = {name: _decoder_record(own) for name, own in told["decoders"].items()}
    first = decoders[told["decoder"]]
    return {"status": "read", "reason": None, **first, "text_read": told["text_read"], "decoders": decoders}


def _decoder_record(told: Mapping[str, Any]) -> dict[str, Any]:
    """The record of one decoder: right characters, all characters, and all rates."""
    counts = {name: told["character_accuracy"][name] for name in ("right", "of")}
    return {**counts, "accuracy": {name: told[f"{name}_accuracy"]["value"] for name in RATES}}


def stored_record(folder: Path, key: str) -> dict[str, Any] | None:
    """The record of an earlier reading, None where there is none."""
    return read_checked(folder / f"{key}.json", "it is read again")


def store_record(folder: Path, key: str, task: StudyTask, record: dict[str, Any]) -> None:
    """Write the record of a reading, whole or not at all."""
    write_checked(folder / f"{key}.json", {**record, "conditions": asdict(task.conditions)})
