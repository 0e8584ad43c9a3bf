"""Sizes that a printed plate takes from a Braille standard and from the user, with the source of each."""

from collections.abc import Mapping
from dataclasses import dataclass

from foundation.errors import InputError
from geometry.braille_standards import QUANTITIES, Quantity, QuantityName, standard

SHORTEST_LENGTH_MM, LONGEST_LENGTH_MM = 0.01, 1000.0
"""A fifth of the thinnest layer, and more than any printer builds."""


@dataclass(frozen=True)
class BrailleSize:
    """One size in mm and its source; basis: "nominal", "middle of the range", "minimum" or "given".

    deviation_mm : the smaller distance to a limit of the standard; None where it gives no limits.
    """

    value_mm: float
    basis: str
    source: str
    deviation_mm: float | None


@dataclass(frozen=True)
class BrailleSizes:
    """The sizes that a standard and the user's explicit sizes give together."""

    standard: str
    title: str
    known: Mapping[QuantityName, BrailleSize]

    def __getitem__(self, name: QuantityName) -> float:
        """A size in mm. InputError, which names the option, where neither the standard nor the user gives it."""
        if name not in self.known:
            raise InputError(
                f"--standard '{self.standard}': has no {name}; give it by --{name.replace('_', '-')} "
                "or choose another standard"
            )
        return self.known[name].value_mm


def braille_sizes(name: str, given: Mapping[QuantityName, float] | None = None) -> BrailleSizes:
    """The sizes of a standard by its name or alias; sizes given in mm take the place of its own.

    Of the standard the nominal size counts, else the middle of the range, else the minimum. InputError for an unknown
    standard and for a size that is no length of a plate.
    """
    found = standard(name, field="--standard")
    known = {key: size for key in QUANTITIES if (size := _plate_size(found.quantities[key])) is not None}
    for key, value in (given or {}).items():
        require_length(f"--{key.replace('_', '-')}", value)
        known[key] = BrailleSize(value, "given", "the user", None)
    return BrailleSizes(found.name, found.title, known)


def require_length(option: str, value_mm: float) -> None:
    """Raise InputError, which names the option, for a length in mm that no solid is built with."""
    if not SHORTEST_LENGTH_MM <= value_mm <= LONGEST_LENGTH_MM:
        raise InputError(f"{option} = {value_mm:g}: must be from {SHORTEST_LENGTH_MM:g} to {LONGEST_LENGTH_MM:g} mm")


def _plate_size(quantity: Quantity) -> BrailleSize | None:
    """The size that a plate takes from one quantity of the table; None where it has neither nominal nor minimum."""
    nominal, low, high = quantity.nominal_mm, quantity.minimum_mm, quantity.maximum_mm
    if nominal is None:
        return None if low is None else BrailleSize(low, "minimum", quantity.source, None)
    sides = [abs(limit - nominal) for limit in (low, high) if limit is not None]
    basis = "middle of the range" if quantity.nominal_is_middle else "nominal"
    return BrailleSize(nominal, basis, quantity.source, min(sides) if any(sides) else None)
