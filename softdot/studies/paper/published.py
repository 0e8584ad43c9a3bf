"""The numbers that the paper prints, from published.toml."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

COLUMN_NAMES = {
    "E_MPa": "Young's modulus",
    "nu": "Poisson's ratio",
    "density_kg_m3": "density",
    "h1_mm": "h₁",
    "E1_MPa": "E₁",
    "h2_mm": "h₂",
    "E2_MPa": "E₂",
    "f": "index of thickness f",
    "e": "index of modulus e",
    "S1": "softness S₁",
    "S2": "softness S₂",
    "S2/S1": "S₂/S₁",
    "S1b": "bending softness S₁b",
}
INPUT_COLUMNS = ("E_MPa", "nu", "density_kg_m3", "h1_mm", "E1_MPa", "h2_mm", "E2_MPa")


TABLES = ("table2", "table3", "table4")


@dataclass(frozen=True)
class Published:
    """One printed number."""

    key: str
    place: str
    quantity: str
    kind: str
    """input, formula or result."""
    value: float
    unit: str
    misprint: str | None
    """Why the printed value cannot be right; None when nothing speaks against it."""


@dataclass(frozen=True)
class Inconsistency:
    """A passage of the paper that disagrees with another one, or with mechanics."""

    place: str
    printed: str
    comment: str


@cache
def published_numbers() -> dict[str, Published]:
    """Every printed number by its key, in the order of the paper."""
    tables = _tables()
    misprints = tables["misprint"]
    found = [
        Published(misprint=misprints.get(entry["key"]), **(entry | {"value": float(entry["value"])}))
        for entry in [*tables["number"], *(cell for table in TABLES for cell in _cells(tables, table))]
    ]
    return {number.key: number for number in sorted(found, key=_order)}


@cache
def inconsistencies() -> tuple[Inconsistency, ...]:
    """Errors and gaps of the paper beyond single numbers."""
    return tuple(Inconsistency(**entry) for entry in _tables()["inconsistency"])


def table_rows(table: str) -> dict[str, dict[str, float]]:
    """The rows of "table2", "table3" or "table4": case name -> column -> printed value."""
    content = _tables()[table]
    columns = content["columns"]
    return {
        name: dict(zip(columns, map(float, row), strict=True))
        for name, row in content.items()
        if name not in ("place", "columns", "units")
    }


def _cells(tables: dict[str, Any], table: str) -> list[dict[str, Any]]:
    """The cells of a table as numbers of their own."""
    content = tables[table]
    units = dict(zip(content["columns"], content["units"], strict=True))
    return [
        {
            "key": f"{table}.{case}.{column}",
            "place": content["place"],
            "quantity": f"{case.replace('medium', 'medium ')}, {COLUMN_NAMES[column]}",
            "kind": "input" if column in INPUT_COLUMNS else "formula",
            "value": value,
            "unit": units[column],
        }
        for case, row in table_rows(table).items()
        for column, value in row.items()
    ]


def _order(number: Published) -> int:
    """The order of the paper."""
    places = ("section2", "table1", "table2", "table3", "table4", "section4", "fig10")
    return places.index(number.key.split(".")[0])


@cache
def _tables() -> dict[str, Any]:
    return tomllib.loads(Path(__file__).with_name("published.toml").read_text("utf-8"))
