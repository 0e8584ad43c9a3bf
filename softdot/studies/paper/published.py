"""The numbers that the paper prints, from published.toml, and the two readings of its segment.

The paper gives neither the width of its segment across its drawings, nor the effector's height, nor the dot's radius.
`plane-strain` reads the drawings as they are: nothing varies across a width of 16 mm, the film's width in the
experiment. `solid` takes the sentence that a segment reads one Braille dot at its word: 2.5 x 2.5 mm, a round dot.
"""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

from softdot.config import Config, config_from

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
def published() -> dict[str, Published]:
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
    """What is wrong or missing in the paper beyond single numbers too."""
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


Reading = Literal["plane-strain", "solid"]
Boundary = Literal["free", "clamped"]

LENGTH_MM = 2.5
FILM_WIDTH_MM = 16.0  # section 2 of the paper
FILM_UM = 28.0
H2_MM = 2.0  # the tables; the text says 5
E1_MPA = 5.0
EFFECTOR_MPA = 1.0
POISSON_RATIO = 0.495
INDENTATION_MM = 0.3
EFFECTOR_HEIGHT_MM = 1.0  # fitted to the paper's forces and voltages
RIDGE_RADIUS_MM = 1.15  # fitted to the paper's forces and voltages
HELD_LAYERS = ("effector", "medium1", "film")  # fitted too: with the sides of medium 2 held the film is blocked
DEFAULT_MESH = {"element_size_mm": 0.3, "contact_element_size_mm": 0.1, "mesher": "layered"}


def segment_config(
    boundary: Boundary,
    h1_mm: float,
    e2_MPa: float,
    reading: Reading = "plane-strain",
    *,
    h2_mm: float = H2_MM,
    film_um: float = FILM_UM,
    effector_height_mm: float = EFFECTOR_HEIGHT_MM,
    effector_MPa: float = EFFECTOR_MPA,
    e1_MPa: float = E1_MPA,
    ridge_radius_mm: float = RIDGE_RADIUS_MM,
    poisson_ratio: float = POISSON_RATIO,
    held_layers: Sequence[str] = HELD_LAYERS,
    load_steps: int = 4,
    mesh: Mapping[str, Any] = DEFAULT_MESH,
) -> Config:
    """One press of the paper's section 4: its segment with medium 1 of h1_mm and medium 2 of e2_MPa, and other designs.

    ridge_radius_mm : plane strain only; poisson_ratio : of all rubbers; load_steps : equal steps up to 0.3 mm;
    mesh : the table [mesh]. InputError for what cannot be built.
    """
    solid = reading == "solid"
    return config_from(
        {
            "segment": {
                "length_mm": LENGTH_MM,
                "width_mm": LENGTH_MM if solid else FILM_WIDTH_MM,
                "section": reading,
                "boundary": boundary,
                **({} if boundary == "free" else {"held_layers": list(held_layers)}),
                "effector": {"shape": "layer", "height_mm": effector_height_mm, "material": "effector"},
                "medium1": {"thickness_mm": h1_mm, "material": "medium1"},
                "film": {"thickness_um": film_um, "material": "pvdf"},
                "medium2": {"thickness_mm": h2_mm, "material": "medium2"},
            },
            "materials": {
                "effector": _rubber(effector_MPa, poisson_ratio),
                "medium1": _rubber(e1_MPa, poisson_ratio),
                "medium2": _rubber(e2_MPa, poisson_ratio),
            },
            "dot": {"shape": "cap", "standard": "marburg-medium"}
            if solid
            else {"shape": "ridge", "radius_mm": ridge_radius_mm},
            "press": {"indentation_mm": INDENTATION_MM, "load_steps": load_steps},
            "mesh": dict(mesh),
        }
    )


def _rubber(youngs_modulus_MPa: float, poisson_ratio: float) -> dict[str, Any]:
    return {
        "model": "neo-hookean",
        "youngs_modulus_MPa": youngs_modulus_MPa,
        "poisson_ratio": poisson_ratio,
        "density_kg_m3": 950.0,  # no part in a quasi-static press
    }
