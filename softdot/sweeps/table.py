"""The table of a sweep as Apache Parquet."""

import json
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.errors import InputError
from foundation.files import whole_file
from softdot.json_files import plain
from softdot.sweeps.points import Record

if TYPE_CHECKING:
    import pyarrow as pa

CURVES = (
    "indentation_mm", "reaction_force_N", "film_charge_pC", "open_circuit_voltage_V", "readout_voltage_V",
)  # fmt: skip
HEAD = ("status", "reason", "seconds", "config_hash")
LEFT_OUT = ("format", "softdot_version", "key", "config", *HEAD)


def row(number: int, values: Mapping[str, Any], record: Record) -> dict[str, Any]:
    """Number, values of the axes, how it ended, peaks of the curves, and every number of the summary.

    Nested keys are joined by dots. The peak of a curve is its value of largest magnitude, with its sign.
    """
    numbers = {key: value for key, value in record.items() if key not in LEFT_OUT}
    return {
        "point": number,
        **values,
        **{key: record.get(key) for key in HEAD},
        **{f"peak.{name}": max(record[name], key=abs) for name in CURVES if record.get(name)},
        **_flat(plain(numbers)),
    }


def _flat(tables: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """{'film': {'capacitance_pF': 24}} -> {'film.capacitance_pF': 24}."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        flat |= _flat(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value}
    return flat


def check_tables() -> None:
    """InputError, before any work, where the library of Parquet tables is not installed."""
    if find_spec("pyarrow") is None:
        raise InputError("Parquet tables need pyarrow, which softdot alone does not: pip install 'softdot[sweep]'")


def write_table(path: Path, rows: list[dict[str, Any]]) -> None:
    """Write Parquet that never exists half-written; a row lacks what other rows have: null."""
    import pyarrow as pa
    from pyarrow import parquet

    names = list(dict.fromkeys(name for one in rows for name in one))
    columns = {name: _column([one.get(name) for one in rows]) for name in names}
    with whole_file(path) as beside:
        parquet.write_table(pa.table(columns), beside)


def _column(values: list[Any]) -> "pa.Array":
    """Numbers, texts or lists of them with their own type; what has no common type as JSON."""
    import pyarrow as pa

    try:
        return pa.array(values)
    except (pa.ArrowInvalid, pa.ArrowTypeError):
        return pa.array([None if value is None else json.dumps(value) for value in values])
