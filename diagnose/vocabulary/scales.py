"""Coordinates of quantities that reach over decades, and of those that come from infinity."""

from math import asinh

from diagnose.forward import Coordinate

OFF = 1e-9  # of a coordinate


def shrinking(scale: float, value: float) -> float:
    """scale / value of what comes from infinity: finite, and beyond all that could be seen, where it is off."""
    return scale / max(value, OFF)


def growing(
    name: str, scale: float, most: float, starts: tuple[float, ...], nodes: tuple[float, ...] = ()
) -> Coordinate:
    """A quantity from 0 up as scale sinh(x): linear below the scale, logarithmic above. All are given in its unit.

    So one step of x means as much at a thousandth of the range as at its end.
    """
    return Coordinate(
        name, 0.0, asinh(most / scale), tuple(asinh(s / scale) for s in starts), tuple(asinh(n / scale) for n in nodes)
    )
