"""Units as instruments write them into the headers of their files, and the factor of each to that of a recording.

A unit stands in brackets, behind a slash, a comma or an underscore, at the end of a name, or in a row of its own. An
unknown one is refused by name: a factor of a thousand must not be guessed.
"""

import re
from dataclasses import dataclass

from foundation.errors import InputError

STANDARD_GRAVITY = 9.80665  # m/s2: gram-force and its kin (3rd General Conference on Weights and Measures, 1901)
POUND_KG = 0.45359237
"""The international pound."""
PREFIXES = {"": 1.0, "n": 1e-9, "u": 1e-6, "\u00b5": 1e-6, "\u03bc": 1e-6, "m": 1e-3, "k": 1e3}
"""Micro is a sign of its own, and the Greek letter."""


@dataclass(frozen=True)
class Unit:
    """A unit: base, the one of a recording for its quantity (s, V, N, mm or C), and the factor to it."""

    base: str
    factor: float


def _with_prefixes(base: str, *names: str) -> dict[str, Unit]:
    return {f"{prefix}{name}": Unit(base, factor) for prefix, factor in PREFIXES.items() for name in names}


UNITS_BY_SYMBOL = {
    **_with_prefixes("s", "s", "sec"),
    **_with_prefixes("V", "V", "v"),
    **_with_prefixes("N", "N"),
    **{name: Unit("mm", 1e3 * unit.factor) for name, unit in _with_prefixes("mm", "m").items()},
    "S": Unit("s", 1.0), "min": Unit("s", 60.0), "h": Unit("s", 3600.0), "hr": Unit("s", 3600.0),
    "cm": Unit("mm", 10.0), "in": Unit("mm", 25.4), '"': Unit("mm", 25.4),
    "gf": Unit("N", 1e-3 * STANDARD_GRAVITY), "kgf": Unit("N", STANDARD_GRAVITY),
    "kp": Unit("N", STANDARD_GRAVITY), "mgf": Unit("N", 1e-6 * STANDARD_GRAVITY),
    "lbf": Unit("N", POUND_KG * STANDARD_GRAVITY), "ozf": Unit("N", POUND_KG / 16.0 * STANDARD_GRAVITY),
    "°C": Unit("C", 1.0), "℃": Unit("C", 1.0), "degC": Unit("C", 1.0),
}  # fmt: skip
"""Symbol -> unit; case matters: mV is not MV, N is not n, and S means seconds only where it stands alone."""
UNITS_BY_WORD = {
    **{f"{prefix}{name}": Unit(base, factor * size)
       for prefix, factor in {"": 1.0, "milli": 1e-3, "micro": 1e-6, "nano": 1e-9, "kilo": 1e3}.items()
       for name, base, size in (("second", "s", 1.0), ("volt", "V", 1.0), ("newton", "N", 1.0), ("meter", "mm", 1e3),
                                ("metre", "mm", 1e3))},
    **{name: UNITS_BY_SYMBOL[short] for name, short in {
        "sec": "s", "msec": "ms", "usec": "us", "nsec": "ns", "minute": "min", "hour": "h", "micron": "um",
        "inch": "in", "gram-force": "gf", "pound-force": "lbf", "kilogram-force": "kgf", "min": "min",
        "milli": "ms", "micro": "us", "gf": "gf", "kgf": "kgf", "lbf": "lbf", "ozf": "ozf", "degc": "degC"}.items()},
}  # fmt: skip
"""Word in small letters and the singular -> unit."""
WEIGHT_OF_MASS = {"g": "gf", "kg": "kgf", "mg": "mgf", "lb": "lbf", "lbs": "lbf", "oz": "ozf"}
"""Unit of mass -> the unit of force that a load cell means by it: the weight."""
LOAD_NAME = re.compile(r"^(?!.*(?:accel|g[- ]?force)).*(?:load|force|cell|weight|scale|kraft|last)", re.IGNORECASE)
"""Words in the name of a load cell's channel."""
TEMPERATURE_NAME = re.compile(r"temp|t_?room", re.IGNORECASE)
"""Beginnings of the name of a channel of temperature."""
CURRENT_UNIT = re.compile(r"(?:[nu\u00b5\u03bcmk]?A|amps?|amperes?|milliamps?)", re.IGNORECASE)
"""Units of current, which no recording has."""
CURRENT_NAME = re.compile(r"\b(?:current|strom|amperage)\b", re.IGNORECASE)
"""Words in the name of a channel of current."""
TEN = r"(?:10+|0[.,]0*1|1[eE][-+]?\d+)"
FACTOR = re.compile(
    rf"(?:(?<=[\s\[])x|[×*·/])\s*{TEN}(?!\d)|(?<![\w.]){TEN}\s*[x×*·]|(?<!\w)(?:1[eE][-+]?\d+|1:10+|10+:1)(?!\w)|"
    r"[\^²³]|\bper\b|/\s*(?:s|mm|N|V)$",
    re.IGNORECASE,
)
"""What would change the unit that stands beside it: x10, /1000, 10:1, per mm."""
QUANTITY_NAMES = {
    base: re.compile(rf"(?:{words})", re.IGNORECASE)
    for base, words in {
        "s": r"time|zeit|temps|elapsed|(?<![a-z])t(?![a-z])",
        "N": r"load|force|weight|kraft|last(?![a-z])",
        "V": r"volt|spannung|(?<![a-z])ch(?:an|annel)?[ _-]*(?:\d|[a-h]?(?![a-z]))|(?<![a-z])[uv](?![a-z])",
        "mm": r"(?<![a-z])pos|displ|travel|stroke|extension|length|height|depth|distance|weg(?![a-z])",
        "C": r"temp(?!s)",
    }.items()
}
"""Unit of a recording -> words in the name of a column that measures it."""
ALSO_WORDS = {"s", "S", "h", "m", "in", "min", "C", "v"}
"""Units that may be an end of a name as well: V_in is no inch, Force_min no minute."""
KNOWN_UNITS = "ns, us, ms, s, min, h, nV, uV, mV, V, kV, mN, N, kN, gf, kgf, lbf, um, mm, cm, m, in, °C"
"""The known units, for messages."""


def unit_of(text: str, name: str, where: str) -> Unit:
    """The unit that a text states. name : of its column. InputError, which begins with where, for an unknown one."""
    found = known_unit(text, name)
    if found is not None:
        return found
    shown = f"{where}: column '{name[:40]}' is in '{text[:20]}'"
    if CURRENT_UNIT.fullmatch(text):
        raise InputError(f"{shown}, a current: no channel of a recording; leave this column out")
    if text in WEIGHT_OF_MASS:
        raise InputError(f"{shown}, a mass or an acceleration; a load cell's column is named as one, such as Load (g)")
    raise InputError(f"{shown}, which is not a known unit; known are {KNOWN_UNITS}")


def known_unit(text: str, name: str = "") -> Unit | None:
    """The unit that a text states, None for an unknown one. name : of its column."""
    text = text.strip().rstrip(".")
    if text in WEIGHT_OF_MASS and LOAD_NAME.search(name):
        return UNITS_BY_SYMBOL[WEIGHT_OF_MASS[text]]
    if text == "C" and TEMPERATURE_NAME.match(name):  # elsewhere it is a charge
        return UNITS_BY_SYMBOL["°C"]
    low = text.lower()
    return (
        UNITS_BY_SYMBOL.get(text)
        or UNITS_BY_WORD.get(low)
        or UNITS_BY_WORD.get(low.removesuffix("s"))
        or UNITS_BY_WORD.get(low.removesuffix("es"))
    )


def split_name(cell: str, where: str) -> tuple[str, Unit | None]:
    """Name and unit of a cell of the header: CH1(mV) -> CH1 and mV; the unit is None without one. InputError."""
    text = cell.strip()
    name, unit = _name_and_unit(text, where)
    if FACTOR.search(name):
        raise InputError(
            f"{where}: column '{text[:40]}' has a factor or a quotient in its name; scale its values, and leave it out"
        )
    return name, unit


def _name_and_unit(text: str, where: str) -> tuple[str, Unit | None]:
    """Name and unit of a cell of the header, None for a missing unit."""
    bracket = re.fullmatch(r"(.*?)\s*[(\[{]\s*([^()\[\]{}]*?)\s*[)\]}]\s*(.*)", text)
    if bracket:
        name = " ".join(f"{bracket[1]} {bracket[3]}".split())
        unit = unit_of(bracket[2], name or text, where)
        others = [*re.findall(r"[(\[{]([^()\[\]{}]*)", name), bracket[3]]
        if any(known_unit(other, name) not in (None, unit) for other in others):
            raise InputError(f"{where}: column '{text[:40]}' has two units")
        return name, unit
    head, _, tail = (part.strip() for part in text.rpartition(","))
    if head and tail:
        return head, unit_of(tail, head, where)
    inside = re.fullmatch(r"(?:(.+)\s)?in (\S+)", text)  # of Rohde & Schwarz: in s,C1 in V
    if inside and known_unit(inside[2], inside[1] or ""):
        return inside[1] or text, known_unit(inside[2], inside[1] or "")
    for mark in "/_ ":
        head, _, tail = (part.strip() for part in text.rpartition(mark))
        if head and tail and (_is_unit_of_name(head, tail, mark) or (mark != " " and _is_current(head, tail))):
            return head, unit_of(tail, head, where)
    glued = re.fullmatch(r"(CH\d)([nu\u00b5\u03bcmk]?V)", text)  # of Rigol's newer instruments
    if glued:
        return glued[1], known_unit(glued[2])
    if CURRENT_NAME.search(text):
        raise InputError(f"{where}: column '{text[:40]}' is a current: no channel of a recording; leave it out")
    return text, None


def _is_unit_of_name(head: str, tail: str, mark: str) -> bool:
    """Whether the end of a column's name is its unit: one of the quantity that the name states, or else not a word."""
    unit = known_unit(tail, head)
    said = {base for base, words in QUANTITY_NAMES.items() if words.search(head)}
    if unit is None or mark == "/":
        return unit is not None and not _is_quotient(head, unit)
    return unit.base in said if said else mark == "_" and tail not in ALSO_WORDS


def _is_quotient(head: str, unit: Unit) -> bool:
    """Whether a slash behind this divides two units: Stiffness N/mm, and not h/mm."""
    last = re.split(r"[\s_]", head)[-1]
    over = None if last in ("in", "min") else known_unit(last)
    return over is not None and over.base != unit.base and (last != head or over.base in ("N", "V"))


def _is_current(head: str, tail: str) -> bool:
    """Whether the end of a name is a unit of current: of I_mA, but not of channel_A."""
    return CURRENT_UNIT.fullmatch(tail) is not None and re.fullmatch(r"(?:ch|channel)\s*", head, re.IGNORECASE) is None


SCOPE_CHANNEL = re.compile(
    r"(?:ch|chan|channel|c|math|ref|trace|wfm|waveform|m|r|f)?[ _-]*\d{1,2}|(?:ch|chan|channel)[ _-]*[A-H]|[A-D]|"
    r"ampl|amplitude|value|y|volts?|(?:.*[ _])?voltage(?:[ _].*)?|spannung",
    re.IGNORECASE,
)
"""Names that oscilloscopes give to channels."""


def assumed_unit(name: str, where: str) -> Unit:
    """The unit of a column without one: volts for channels named as oscilloscopes do. InputError for any other."""
    if SCOPE_CHANNEL.fullmatch(name.strip()):
        return Unit("V", 1.0)
    raise InputError(
        f"{where}: column '{name[:40]}' has no unit; write it behind the name in the header, such as Force (N) or "
        "Position (mm)"
    )
