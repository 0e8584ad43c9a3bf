"""Braille: standards (sizes of dots and their spacing, from one data table), Unicode cells, the dots of a segment."""

import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from geometry.base import InputError
from geometry.parameters import Dot

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


FIRST, LAST = 0x2800, 0x28FF
COLUMN_AND_ROW = {1: (0, 0), 2: (0, 1), 3: (0, 2), 7: (0, 3), 4: (1, 0), 5: (1, 1), 6: (1, 2), 8: (1, 3)}
"""Dot number -> (column, row); rows count downwards."""
COLUMNS_ALONG_X, ROWS_ALONG_Y = 1.0, 1.0
"""Reading runs along +x and rows along +y: the plate faces down, so its dots read correctly from their own side."""


def raised_dots(character: str, field: str = "dot.cell") -> tuple[int, ...]:
    """Numbers of the raised dots of a Unicode Braille character: bit n - 1 of its code stands for dot n.

    InputError, which names the field, for anything but one character from U+2800 to U+28FF.

    >>> raised_dots("⠙")  # the letter d
    (1, 4, 5)
    """
    if len(character) != 1 or not FIRST <= ord(character) <= LAST:
        raise InputError(f"{field} = '{character}': must be one Unicode Braille character, U+2800 to U+28FF")
    bits = ord(character) - FIRST
    return tuple(dot for dot in range(1, 9) if bits >> (dot - 1) & 1)


def dot_offset_mm(dot: int, pitch_mm: float) -> NDArray[np.float64]:
    """Position (2,) of a dot against dot 1 of its cell, x and y in mm."""
    column, row = COLUMN_AND_ROW[dot]
    return np.array([COLUMNS_ALONG_X * column, ROWS_ALONG_Y * row]) * pitch_mm


DEFAULT_STANDARD = "marburg-medium"
SIZES = ("base_diameter_mm", "height_mm", "radius_mm")


@dataclass(frozen=True)
class DotSize:
    """In mm: radius of the sphere or cylinder, height over the plate, height of the cylindrical foot."""

    radius_mm: float
    height_mm: float
    foot_mm: float


def dot_standard(dot: Dot) -> BrailleStandard | None:
    """The standard a dot follows: the named one, the default when no size is given, else None. InputError."""
    given = [name for name in SIZES if getattr(dot, name) is not None]
    if dot.standard is None:
        return None if given else standard(DEFAULT_STANDARD)
    if given:
        raise InputError(
            f"dot.{given[0]} = {getattr(dot, given[0]):g}: dot.standard = '{dot.standard}' fixes the sizes "
            "already; give either the standard or explicit sizes"
        )
    return standard(dot.standard)


def dot_size(dot: Dot) -> DotSize:
    """The sizes of a cap or ridge. InputError for sizes that miss, contradict each other or are not fixed."""
    chosen = dot_standard(dot)
    if chosen is not None:
        return from_base(chosen.nominal_mm("base_diameter_mm"), chosen.nominal_mm("height_mm"))
    if dot.radius_mm is not None:
        return _from_radius(dot.radius_mm, dot)
    if dot.base_diameter_mm is None:
        raise InputError(
            f"dot.height_mm = {dot.height_mm:g}: a height alone is not a dot; add dot.base_diameter_mm or dot.radius_mm"
        )
    if dot.height_mm is None:
        raise InputError(
            f"dot.base_diameter_mm = {dot.base_diameter_mm:g}: a base alone is not a dot; add dot.height_mm"
        )
    return from_base(dot.base_diameter_mm, dot.height_mm)


def from_base(base_diameter_mm: float, height_mm: float) -> DotSize:
    """Sizes of a dot from its base and height in mm.

    A spherical cap has R = (d^2 / 4 + h^2) / 2h. Higher than d / 2 it would pass the hemisphere and undercut
    its base: such a dot is a hemisphere of radius d / 2 on a cylindrical foot of height h - d / 2.

    >>> from_base(1.5, 0.5).radius_mm
    0.8125
    """
    half = base_diameter_mm / 2
    if height_mm > half:
        return DotSize(half, height_mm, height_mm - half)
    return DotSize((half**2 + height_mm**2) / (2 * height_mm), height_mm, 0.0)


def _from_radius(radius_mm: float, dot: Dot) -> DotSize:
    """Sizes from the radius of the sphere or cylinder; without a height it stands out by its radius."""
    if dot.base_diameter_mm is not None:
        raise InputError(
            f"dot.radius_mm = {radius_mm:g}: dot.base_diameter_mm = {dot.base_diameter_mm:g} is given too; "
            "give either of them"
        )
    height = radius_mm if dot.height_mm is None else dot.height_mm
    return DotSize(radius_mm, height, max(0.0, height - radius_mm))


Floats = NDArray[np.float64]


def cell_tips(dot: Dot, height_mm: float) -> tuple[Floats, float]:
    """Tips (n, 3) of the raised dots from that of the pressed one, which comes first, z towards the plate, and the
    height of the pressed one, in mm. InputError.

    height_mm : of all dots where the cell does not state their own.
    """
    if dot.cell is None:
        return refuse_cell_of(dot, height_mm)
    raised = raised_dots(dot.cell)
    if dot.cell_dot not in raised:
        known = ", ".join(map(str, raised)) or "none"
        raise InputError(f"dot.cell_dot = {dot.cell_dot}: not raised in dot.cell = '{dot.cell}', which has {known}")
    heights = dot.cell_heights_mm or (height_mm,) * len(raised)
    if len(heights) != len(raised):
        raise InputError(
            f"dot.cell_heights_mm = {list(heights)}: dot.cell = '{dot.cell}' has {len(raised)} raised dots; "
            "give as many heights"
        )
    pitch = _pitch_mm(dot)
    tops = {n: np.append(dot_offset_mm(n, pitch), -height) for n, height in zip(raised, heights, strict=True)}
    pressed = tops.pop(dot.cell_dot)
    return np.array([np.zeros(3), *(top - pressed for top in tops.values())]), -float(pressed[2])


def refuse_cell_of(dot: Dot, height_mm: float) -> tuple[Floats, float]:
    """The one tip (1, 3) of a dot without a cell, and its height. InputError when a cell is asked for."""
    if dot.cell is not None:
        raise InputError(f"dot.cell = '{dot.cell}': a cell has dots of dot.shape = 'cap', not '{dot.shape}'")
    return np.zeros((1, 3)), height_mm


def _pitch_mm(dot: Dot) -> float:
    chosen = dot_standard(dot)
    if chosen is None:
        raise InputError(
            f"dot.cell = '{dot.cell}': the distance of its dots comes from dot.standard; "
            "name one with a dot pitch instead of explicit sizes"
        )
    return chosen.nominal_mm("dot_pitch_mm")
