"""The table of a sweep as an Apache Parquet file."""

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

CURVE_KEYS = (
    "indentation_mm", "reaction_force_N", "film_charge_pC", "open_circuit_voltage_V", "readout_voltage_V",
)  # fmt: skip
"""Keys of a record with values over the load steps, whose peaks get a column."""
STATUS_KEYS = ("status", "reason", "seconds", "config_hash")
"""Keys of a record that tell how it ended."""
EXCLUDED_KEYS = ("format", "softdot_version", "key", "config", *STATUS_KEYS)
"""Keys of a record that get no column of their own."""


def table_row(number: int, values: Mapping[str, Any], record: Record) -> dict[str, Any]:
    """A row of the table: number of the point, values of the axes, status, peaks of the curves, numbers of the summary.

    Nested keys are joined by dots. The peak of a curve is its value of largest magnitude, with its sign.
    """
    numbers = {key: value for key, value in record.items() if key not in EXCLUDED_KEYS}
    return {
        "point": number,
        **values,
        **{key: record.get(key) for key in STATUS_KEYS},
        **{f"peak.{name}": max(record[name], key=abs) for name in CURVE_KEYS if record.get(name)},
        **_with_joined_keys(plain(numbers)),
    }


def _with_joined_keys(tables: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Nested tables with keys joined by dots: {'film': {'capacitance_pF': 24}} -> {'film.capacitance_pF': 24}."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        flat |= _with_joined_keys(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value}
    return flat


def check_tables() -> None:
    """InputError, before any work, where pyarrow, the library for Parquet, is not installed."""
    if find_spec("pyarrow") is None:
        raise InputError("Parquet tables need pyarrow, which softdot alone does not: pip install 'softdot[sweep]'")


def write_table(path: Path, rows: list[dict[str, Any]]) -> None:
    """Write rows as Parquet, whole or not at all; a key that a row lacks becomes null."""
    import pyarrow as pa
    from pyarrow import parquet

    names = list(dict.fromkeys(name for one in rows for name in one))
    columns = {name: _column([one.get(name) for one in rows]) for name in names}
    with whole_file(path) as beside:
        parquet.write_table(pa.table(columns), beside)


def _column(values: list[Any]) -> "pa.Array":
    """A column of numbers, texts or lists with a type of its own; values without a common type as JSON."""
    import pyarrow as pa

    try:
        return pa.array(values)
    except (pa.ArrowInvalid, pa.ArrowTypeError):
        return pa.array([None if value is None else json.dumps(value) for value in values])
