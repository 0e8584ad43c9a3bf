"""Braille standards: sizes of dots and their spacing, from one data table."""

import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import Any, Literal, get_args

from foundation.errors import InputError

Confidence = Literal["high", "medium", "low"]
QuantityName = Literal["base_diameter_mm", "height_mm", "dot_pitch_mm", "cell_pitch_mm", "line_pitch_mm"]
QUANTITIES: tuple[QuantityName, ...] = get_args(QuantityName)


@dataclass(frozen=True)
class Quantity:
    """One size in mm; None where the standard does not fix it.

    nominal_is_middle : the standard gives a range only and nominal_mm is its middle.
    source : where the numbers were read; note : what else is to be known about them.
    """

    minimum_mm: float | None
    nominal_mm: float | None
    maximum_mm: float | None
    nominal_is_middle: bool
    source: str
    confidence: Confidence
    note: str


@dataclass(frozen=True)
class BrailleStandard:
    """The sizes of one standard; quantities maps every name of QUANTITIES to its numbers."""

    name: str
    title: str
    source: str
    confidence: Confidence
    note: str
    quantities: dict[QuantityName, Quantity]

    def nominal_mm(self, quantity: QuantityName, field: str = "dot.standard") -> float:
        """Nominal size in mm. InputError, which names the field, where the standard has none."""
        nominal = self.quantities[quantity].nominal_mm
        if nominal is None:
            has = ", ".join(name for name in QUANTITIES if self.quantities[name].nominal_mm is not None)
            raise InputError(
                f"{field} = '{self.name}': this standard has no nominal {quantity}, only {has}; "
                "choose another standard or give the size itself"
            )
        return nominal


def standard_names() -> tuple[str, ...]:
    """Names of all standards, without aliases, in the order of the table."""
    return tuple(_table()["standards"])


def standard(name: str, field: str = "dot.standard") -> BrailleStandard:
    """A standard by its name or alias. InputError, which names the field and the nearest name, for none."""
    rows = _table()["standards"]
    names = {alias: key for key, row in rows.items() for alias in (key, *row.get("aliases", ()))}
    if name not in names:
        near = get_close_matches(name.lower(), names, n=1, cutoff=0.5)
        hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(rows)}"
        raise InputError(f"{field} = '{name}': no such Braille standard; {hint}")
    return _standard(names[name])


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(files(__package__).joinpath("braille_standards.toml").read_text("utf-8"))


@cache
def _standard(name: str) -> BrailleStandard:
    row = _table()["standards"][name]
    sizes = _table()["standards"][row["like"]] if "like" in row else row
    about = {key: row[key] for key in ("source", "confidence")}
    quantities = {key: _quantity({**about, **sizes.get(key, {})}) for key in QUANTITIES}
    source = _table()["sources"][row["source"]]
    return BrailleStandard(name, row["title"], source, row["confidence"], row.get("note", ""), quantities)


def _quantity(row: dict[str, Any]) -> Quantity:
    low, nominal, high = row.get("minimum"), row.get("nominal"), row.get("maximum")
    middle = nominal is None and low is not None and high is not None
    if nominal is None and low is not None and high is not None:
        nominal = (low + high) / 2
    source = _table()["sources"][row["source"]]
    return Quantity(low, nominal, high, middle, source, row["confidence"], row.get("note", ""))
