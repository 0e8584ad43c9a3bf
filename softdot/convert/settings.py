"""Settings above the header of an instrument's file, some of which say units and how far apart samples are."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from foundation.errors import InputError
from softdot.convert.text_table import NUMBER, TextTable
from softdot.convert.units import CURRENT_UNIT, QUANTITY_NAMES, known_unit

INTERVAL_KEY = re.compile(
    r"(?:sampl\w*[ _]*|time[ _]*|[xht][ _]*)?(?:interval|period|incr\w*|resolution)|"
    r"(?:sampl\w*|data)[ _]*(?:rate|freq\w*)|fs|clock|(?:delta|d)[ _]?[xt]|tinc",
    re.IGNORECASE,
)
"""Keys of settings for the interval between samples, or for the number of samples in a second."""
RATE_UNIT = re.compile(r"([kMG]?)(?:Hz|Sa/s|S/s|samples(?:/s| per second)|sps)", re.IGNORECASE)
UNIT_KEY = re.compile(
    r"(?:(?P<time>horizontal|time|zeit|[xht])|vertical|channel|kanal|signal|data|amplitude|[yv])?[ _-]*(?:axis[ _-]*)?"
    r"(?:units?|einheit(?:en)?)"
)
"""Settings that say the unit of the time, or of any channel."""
OF_NO_SAMPLES = re.compile(r"trigger|offset|delay|level|limit|range|scale|display")
PER_SECOND = {"": 1.0, "k": 1e3, "m": 1e6, "g": 1e9}
"""Prefix of a rate in small letters -> its factor."""


@dataclass(frozen=True)
class Settings:
    """The settings above a header. values : key in small letters -> the cells beside it. units : of each column."""

    values: Mapping[str, Sequence[str]]
    units: Sequence[str]

    def number(self, key: str) -> str:
        """The first value of a key, 1 where there is none."""
        return next(iter(self.values.get(key, [])), "1")

    @property
    def time_units(self) -> list[str]:
        """The units of time that the settings state."""
        return [text for key, text in self._stated_units() if _is_of_time(key, text)]

    def unit_of_channel(self, number: int, names: Sequence[str], where: str) -> str:
        """The unit of the channel with this number, by its name or place; "" where no setting states it. InputError."""
        stated = [(key, text) for key, text in self._stated_units() if not _is_of_time(key, text)]
        others = self._of_quantities()
        named = re.compile(rf"(?<!\w){re.escape(names[number].lower())}(?!\w)")  # CH1 unit, Force unit
        own = [one for one in others if named.search(one[0])]
        own = own or [one for one in others if _is_of(names[number], one[1])]
        told = [text for _, text in own or stated]
        each = {text.rpartition(":")[2].strip() for text in told}
        if len(each) < 2:
            return next(iter(each), "")
        by_name = {one.rpartition(":")[0].strip().lower(): one.rpartition(":")[2].strip() for one in told if ":" in one}
        if names[number].lower() in by_name:
            return by_name[names[number].lower()]
        sources = list(self.values.get("source", []))
        if names[number] in sources and len(told) == len(sources):
            return told[sources.index(names[number])]
        if by_name or len(told) != len(names) or len({key for key, _ in stated}) != 1:
            raise InputError(
                f"{where}: the settings above tell {len(told)} units, {', '.join(told)}, and not which of them is that "
                f"of '{names[number][:40]}'; write it behind the name"
            )
        return told[number]

    def _stated_units(self) -> list[tuple[str, str]]:
        """Key and text of every unit that a setting states, known or not."""
        return [
            (key, text)
            for key, texts in self.values.items()
            if (found := UNIT_KEY.fullmatch(key))
            for text in texts
            if found[0] not in ("unit", "units") or _is_unit(text, texts)
        ]

    def _of_quantities(self) -> list[tuple[str, str]]:
        """The same of settings that name what they are of, such as Force unit."""
        return [
            (key, text)
            for key, texts in self.values.items()
            if ("unit" in key or "einheit" in key) and not UNIT_KEY.fullmatch(key) and not OF_NO_SAMPLES.search(key)
            for text in texts
            if _is_of(key, text)
        ]

    @property
    def interval_s(self) -> tuple[str, float] | None:
        """The key of the interval between samples and its length in s; None where no setting states it."""
        for full_key, texts in self.values.items():
            key, _, key_unit = re.sub(r"[)\]]$", "", full_key).partition("(" if "(" in full_key else "[")
            key = key.strip()
            if INTERVAL_KEY.fullmatch(key):
                text = " ".join([*texts[:1], key_unit, *texts[1:2]]).rpartition(":")[2].strip()
                found = re.match(rf"({NUMBER.pattern})\s*(samples per second|\S*)", text, re.ASCII)
                seconds = _seconds(key, found[1], found[2]) if found else None
                if seconds is not None:
                    return key, seconds
        return None


def _is_unit(text: str, texts: Sequence[str]) -> bool:
    """Whether a text behind Unit is one, and no device or system of units."""
    if any(known_unit(one.rpartition(":")[2]) for one in texts):
        return not re.search(r"\d", text.rpartition(":")[2])
    return "/" in text or CURRENT_UNIT.fullmatch(text) is not None


def _is_of_time(key: str, text: str) -> bool:
    unit = known_unit(text.rpartition(":")[2])
    found = UNIT_KEY.fullmatch(key)
    return bool(found and found["time"]) or (unit is not None and unit.base == "s")


def _is_of(name: str, text: str) -> bool:
    """Whether a name says the quantity that this is a unit of."""
    unit = known_unit(text.rpartition(":")[2], name)
    return unit is not None and QUANTITY_NAMES[unit.base].search(name) is not None


def _seconds(key: str, number: str, unit: str) -> float | None:
    """The interval between two samples, s, from an interval or a rate; None where the unit is neither."""
    value = float(number.upper().replace("D", "E").replace(",", "."))
    rate = RATE_UNIT.fullmatch(unit)
    if rate or ("rate" in key or "freq" in key or key == "fs"):
        value *= PER_SECOND[rate[1].lower()] if rate else 1.0
        return 1.0 / value if value > 0.0 and (rate or not unit) else None
    known = known_unit(unit or "s")
    return value * known.factor if known is not None and known.base == "s" and value > 0.0 else None


def settings_above(table: TextTable, row: int) -> Settings:
    """The settings in the rows above a header."""
    values: dict[str, list[str]] = {}
    for cells in table.rows[:row]:
        if not any(cells[1:]) and cells:
            cells = [part.strip() for part in re.split(r"[:=]", cells[0], maxsplit=1)]
        if cells and any(cells[1:]):
            values[cells[0].lstrip("#%/ ").rstrip(": ").lower()] = [cell for cell in cells[1:] if cell]
    above = table.rows[row - 1] if row else []
    stated = [cell for cell in above if cell]
    is_units = len(stated) > 1 and all(known_unit(without_brackets(cell), "load") for cell in stated)
    return Settings(values, above if is_units else [])


def without_brackets(cell: str) -> str:
    """The text of a cell without brackets around it: (mV) -> mV."""
    return cell.strip().strip("()[]{}").strip()
