"""The refusal of anything below what a printer makes."""

from collections.abc import Iterable

from geometry.errors import InputError
from geometry.fabrication.parameters import Fabrication
from geometry.printers import PrinterProfile

ROUNDING_MM = 1e-9


def refuse_thin(what: str, size_mm: float, least_mm: float, limit: str, advice: str) -> None:
    """InputError for a size in mm below the limit.

    what : the key with its value, and what follows from it; limit : the name of the limit; advice : how to mend it.
    """
    if size_mm < least_mm - ROUNDING_MM:
        raise InputError(f"{what} of {max(size_mm, 0.0):.3g} mm, below {limit} of {least_mm:g} mm; {advice}")


def refuse_small_keys(
    fabrication: Fabrication, printer: PrinterProfile, checks: Iterable[tuple[str, str, float, str]]
) -> None:
    """InputError for a size of the table [fabrication] that the printer cannot make.

    checks : key, what it is the size of, least in mm, name of the limit.
    """
    advice = "make it larger" if printer.process == "sla" else "make it larger or print with printer = 'sla'"
    for key, what, least_mm, limit in checks:
        value = getattr(fabrication, key)
        named = f"the {printer.process.upper()} limit for the {limit}"
        refuse_thin(f"fabrication.{key} = {value:g}: {what}", value, least_mm, named, advice)
