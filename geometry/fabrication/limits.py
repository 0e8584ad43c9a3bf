"""The refusal of anything below what a printer makes."""

from geometry.errors import InputError

ROUNDING_MM = 1e-9


def refuse_thin(what: str, size_mm: float, least_mm: float, limit: str, advice: str) -> None:
    """InputError for a size in mm below the limit.

    what : the key with its value, and what follows from it; limit : the name of the limit; advice : how to mend it.
    """
    if size_mm < least_mm - ROUNDING_MM:
        raise InputError(f"{what} of {max(size_mm, 0.0):.3g} mm, below {limit} of {least_mm:g} mm; {advice}")
