"""The folder of a sweep, which keeps points as they are solved.

Points are added one whole file at a time, named by the hash of their configuration, so they fit any sweep. Table,
space and summary are replaced together when a sweep is complete: before that the folder has no table, or still that
of the sweep before, with its own summary.
"""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.checked_records import read_checked, write_checked
from foundation.errors import InputError
from foundation.files import whole_file
from foundation.scratch_folders import lock_folder
from softdot.config.hashes import config_hash
from softdot.config.schema import Config
from softdot.json_files import plain, write_json
from softdot.outcome import outcome_key
from softdot.output import Product, check_output
from softdot.sweeps.points import ACCIDENTS, Record

if TYPE_CHECKING:
    import pyarrow as pa
from softdot.sweeps.table import check_tables

POINTS, TABLE, SPACE_COPY = "points", "sweep.parquet", "space.toml"
CSV_TABLE, PICTURE, PAGE = "sweep.csv", "sweep.png", "report.html"
_REPLACED_TOGETHER = ("sweep.json", TABLE, SPACE_COPY, CSV_TABLE, PICTURE, PAGE)
SWEEP = Product(
    "softdot-sweep/1",
    "sweep.json",
    frozenset({*_REPLACED_TOGETHER, *(f".{name}.part" for name in _REPLACED_TOGETHER), POINTS}),
)
POINT_FORMAT = "softdot-point/1"


def check_folder(out: Path) -> Path:
    """The real path of out. InputError unless it can be made, is empty or is the folder of an earlier sweep."""
    place = check_output(out, SWEEP)
    existing = next(path for path in (place, *place.parents) if path.exists())
    if not os.access(existing, os.W_OK):
        raise InputError(f"output '{out}': not writable (Permission denied)")
    return place


def make_folder(place: Path) -> None:
    """Make the folder of a sweep; an earlier sweep in it stays."""
    place.mkdir(parents=True, exist_ok=True)
    if not (place / SWEEP.summary).exists():
        write_json(place / SWEEP.summary, {"format": SWEEP.format, "complete": False})
    (place / POINTS).mkdir(exist_ok=True)


def hold_folder(place: Path) -> int | None:
    """Hold the folder for this process, to be released at the end. InputError while another sweep writes it."""
    held = lock_folder(place)
    if held is None:
        raise InputError(f"output '{place}': another sweep is writing it; wait for it or name another folder")
    return held


def remove_half_written(place: Path) -> None:
    """Remove the files that a stopped process may have left half-written."""
    for folder in (place, place / POINTS):
        for path in folder.glob(".*.part"):
            path.unlink(missing_ok=True)


def stored_record(place: Path, config: Config) -> Record | None:
    """The record of a point from an earlier sweep; None without one, after an accident and of another program.

    A damaged record is None too: it is deleted, with a warning.
    """
    found = read_checked(_record_path(place, config), "the point is solved again")
    if found is None:
        return None
    return found if found["key"] == outcome_key(config) and found["status"] not in ACCIDENTS else None


def store_record(place: Path, config: Config, record: Record) -> Record:
    """Write the record of a point, whole or not at all, and return it."""
    from softdot.version import installed_version

    summary: dict[str, Any] = plain({
        "format": POINT_FORMAT,
        "softdot_version": installed_version(),
        "key": outcome_key(config),
        "config_hash": config_hash(config),
        **record,
        "config": config.model_dump(mode="json"),
    })  # fmt: skip
    write_checked(_record_path(place, config), summary)
    return summary


def _record_path(place: Path, config: Config) -> Path:
    return place / POINTS / f"{config_hash(config)}.json"


def finish(
    place: Path, rows: list[dict[str, Any]], axes: Sequence[str], text: str | None, summary: Mapping[str, Any]
) -> None:
    """Replace tables, picture, page, space and, last, the summary. axes : keys that the sweep has varied."""
    from softdot.sweeps.report import draw, write_csv, write_report
    from softdot.sweeps.table import write_table

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


def read_table(out: Path | str) -> "pa.Table":
    """The table in the folder of a complete sweep: .to_pylist() gives rows, .to_pandas() a frame. InputError."""
    check_tables()
    from pyarrow import ArrowException, parquet

    from softdot.sweeps.folder import TABLE

    path = Path(out) / TABLE
    try:
        return parquet.read_table(path)
    except FileNotFoundError:
        raise InputError(f"'{out}': holds no table '{TABLE}'; the sweep is not complete") from None
    except (OSError, ArrowException) as error:
        raise InputError(f"'{path}': cannot be read ({error})") from None
