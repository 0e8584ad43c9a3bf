"""What a column or a setting in the file of a testing machine measures, by its name and its unit."""

import re

from softdot.convert.table_layout import TIME_NAME
from softdot.convert.units import known_unit

STRESS_MPA = {
    "MPa": 1.0, "N/mm2": 1.0, "N/mm²": 1.0, "N/mm^2": 1.0, "kPa": 1e-3, "Pa": 1e-6, "GPa": 1e3, "bar": 0.1,
    "psi": 6.894757e-3, "ksi": 6.894757,
}  # fmt: skip
"""Unit of stress -> MPa."""
STRAINS = {"%": 0.01, "mm/mm": 1.0, "m/m": 1.0, "in/in": 1.0, "-": 1.0, "1": 1.0}
"""Unit of strain -> 1."""
AREAS_MM2 = {"mm2": 1.0, "mm²": 1.0, "mm^2": 1.0, "cm2": 100.0, "cm²": 100.0, "cm^2": 100.0, "in2": 645.16}
"""Unit of area -> mm2."""
BASES = {"s": "time_s", "mm": "displacement_mm", "N": "force_N"}
"""Unit of a recording -> quantity."""
WORDS = {
    "time_s": TIME_NAME.pattern,
    "strain": r".*(?:strain|elongation|dehnung|verformung)",
    "stretch": r".*(?:stretch|streckung)",
    "stress_MPa": r".*(?:stress|spannung)",
    "displacement_mm": r".*(?:displ|extension|crosshead|stroke|travel|weg|position|deflection)",
    "force_N": r".*(?:force|load|kraft)",
}
"""Quantity -> what the name of its column holds."""
NOT_NOMINAL = re.compile(r"\b(?:true|cauchy|log(?:arithmic)?|hencky|wahre?)\b", re.IGNORECASE)
"""Words of a column in true stress or strain."""
SIZES = {
    "width_mm": r"(?:.*\b(?:width|breite)|b0?)",
    "thickness_mm": r"(?:.*\b(?:thickness|dicke)|a0?)",
    "gauge_length_mm": r"(?:.*\b(?:length|gauge|messlänge|einspannlänge|height)|l0|le)",
    "area_mm2": r"(?:.*\b(?:area|cross[- ]?section|querschnitt)|s0|a_?0)",
}
"""Size of a specimen -> what the name of its setting holds."""


def split_unit(text: str) -> tuple[str, str | None]:
    """Name and unit of a cell: 'Load (N)', 'Load [N]', 'Load, N', 'Load in N', 'Load_N'; None without a unit."""
    bracket = re.fullmatch(r"(.*?)\s*[(\[]\s*([^()\[\]]*)[)\]]\s*", text)
    if bracket and unit_factor(bracket[2].strip()):
        return bracket[1], bracket[2].strip()
    tail = re.fullmatch(r"(.*?)(?:,\s*|\s+in\s+|\s*/\s*|[\s_]+)(\S+)", text)
    if tail and unit_factor(tail[2]):
        return tail[1], tail[2]
    return text, None


def unit_factor(unit: str) -> tuple[str, float] | None:
    """Quantity and factor of a unit; None for an unknown one.

    >>> unit_factor("kPa"), unit_factor("%"), unit_factor("kN"), unit_factor("furlong")
    (('stress_MPa', 0.001), ('strain', 0.01), ('force_N', 1000.0), None)
    """
    for quantity, table in (("stress_MPa", STRESS_MPA), ("strain", STRAINS), ("area_mm2", AREAS_MM2)):
        if unit in table:
            return quantity, table[unit]
    known = known_unit(unit, "load")
    return (BASES[known.base], known.factor) if known is not None and known.base in BASES else None


def quantity_of(name: str, unit: str | None) -> tuple[str, float] | None:
    """Quantity of a column and the factor to its unit; None for one that is not used, such as a true stress."""
    if NOT_NOMINAL.search(name):
        return None
    words = [one for one, pattern in WORDS.items() if re.match(pattern + r"$" * (one == "time_s"), name, re.IGNORECASE)]
    named = words[0] if words else None
    if unit is None:
        return (named, 1.0) if named in ("time_s", "strain", "stretch") else None
    found = unit_factor(unit)
    if found is None or (found[0] == "strain" and named not in ("strain", "stretch")):
        return None
    return (named, found[1]) if named == "stretch" else found


def size_of(name: str, unit: str) -> tuple[str, float] | None:
    """Size of a specimen and the factor to its unit in a setting above the samples; None for any other setting."""
    found = unit_factor(unit)
    base = {"displacement_mm": ("width_mm", "thickness_mm", "gauge_length_mm"), "area_mm2": ("area_mm2",)}
    sizes = base.get(found[0], ()) if found else ()
    named = [size for size in sizes if re.match(SIZES[size] + "$", name.strip(), re.IGNORECASE)]
    return (named[0], found[1]) if named and found else None
