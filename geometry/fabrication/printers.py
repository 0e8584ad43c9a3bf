"""Printer profiles: what a printer can make, from one data table."""

import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import Any, Literal, get_args

from geometry.base import InputError

Confidence = Literal["high", "medium", "low"]
LimitName = Literal[
    "build_x_mm",
    "build_y_mm",
    "build_z_mm",
    "layer_mm",
    "wall_mm",
    "supported_wall_mm",
    "feature_mm",
    "relief_mm",
    "gap_mm",
    "groove_mm",
    "hole_mm",
    "overhang_deg",
    "overhang_area_mm2",
    "deviation_mm",
]


@dataclass(frozen=True)
class Limit:
    """One number of a profile, where it was read, and how sure it is."""

    value: float
    source: str
    confidence: Confidence


@dataclass(frozen=True)
class PrinterProfile:
    """The limits of one printer by name; profile["wall_mm"] is the number alone.

    build_x_mm, build_y_mm, build_z_mm : build volume. layer_mm : height of a layer.
    wall_mm : thinnest wall that stands free; supported_wall_mm : thinnest wall held on two sides or more.
    feature_mm : narrowest pin, rib, bump or dent; relief_mm : lowest bump and shallowest dent.
    gap_mm : narrowest slot that stays open; groove_mm : narrowest and shallowest channel in a face; hole_mm :
    narrowest hole.
    overhang_deg : slope from the horizontal below which the underside needs a support.
    overhang_area_mm2 : smaller undersides hold by themselves.
    deviation_mm : how far a size may come out from the drawing.
    """

    name: str
    title: str
    process: Literal["fdm", "sla"]
    limits: dict[LimitName, Limit]

    def __getitem__(self, name: LimitName) -> float:
        """The number of that name."""
        return self.limits[name].value


def printer_names() -> tuple[str, ...]:
    """Names of all profiles in the order of the table."""
    return tuple(_table()["printers"])


@cache
def printer_profile(name: str, field: str = "--printer") -> PrinterProfile:
    """A profile by its name. InputError, which names the field and the nearest name, for none."""
    rows = _table()["printers"]
    if name not in rows:
        near = get_close_matches(name.lower(), rows, n=1, cutoff=0.5)
        hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(rows)}"
        raise InputError(f"{field} = '{name}': no such printer profile; {hint}")
    row, sources = rows[name], _table()["sources"]
    limits = {
        key: Limit(value, sources[source], confidence)
        for key in get_args(LimitName)
        for value, source, confidence in [row[key]]
    }
    return PrinterProfile(name, row["title"], row["process"], limits)


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(files(__package__).joinpath("printers.toml").read_text("utf-8"))
