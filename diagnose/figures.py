"""Numbers as text: one way for each kind, so that a number looks the same wherever it is printed."""

from math import floor, isfinite, log10

LEAST_P_VALUE = 1e-16
"""p-value below which tails of probability distributions are round-off."""
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def figure(value: float | None, digits: int = 2) -> str:
    """Number as text with significant digits; a power of ten only below 1e-4 and from 1e6 on. None: "unknown"."""
    if value is None or value != value:
        return "unknown"
    if not isfinite(value):
        return "∞" if value > 0.0 else "−∞"
    rounded = float(f"{value:.{digits}g}")
    if rounded and not 1e-4 <= abs(rounded) < 1e6:
        power = floor(log10(abs(rounded)))
        return f"{_plain(rounded / 10.0**power, digits)} × 10{str(power).translate(SUPERSCRIPTS)}"
    return _plain(rounded, digits)


def _plain(value: float, digits: int) -> str:
    text = f"{float(f'{value:.{digits}g}'):.10f}".rstrip("0").rstrip(".")
    return "0" if text in ("", "-0") else text.replace("-", "−")


def percent(share: float | None) -> str:
    """Share as a percentage: 0.026 -> 2.6 %."""
    return figure(share) if share is None else f"{figure(100.0 * share)} %"


def part_percent(share: float) -> str:
    """Share of a whole as a percentage that says 0 or 100 only where nothing or everything is meant."""
    if 0.0 < share < 0.001:
        return "less than 0.1 %"
    if 0.99 < share < 1.0:
        return "more than 99.9 %" if share > 0.999 else f"{figure(100.0 * share, 3)} %"
    return percent(share)


def probability(value: float | None) -> str:
    """Probability as text, which is never quite 0 or 1."""
    if value is None:
        return figure(value)
    return "< 0.001" if value < 0.001 else "> 0.999" if value > 0.999 else figure(value)


def p_equals(value: float, least: float = LEAST_P_VALUE) -> str:
    """p-value as text: p = 0.021; p < 10⁻¹⁶ for any smaller one; p ≤ least where no value below that was possible."""
    if value < LEAST_P_VALUE:
        return "p < 10⁻¹⁶"
    return f"p ≤ {figure(value)}" if value == least else f"p = {figure(value)}"


def p_alone(value: float | None) -> str:
    """p-value for a column of them, without its name."""
    return figure(value) if value is None else p_equals(value).removeprefix("p ").removeprefix("= ")
