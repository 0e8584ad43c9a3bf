"""Whether the electrodes fit on the film."""

from itertools import combinations

from geometry.errors import InputError
from geometry.parameters import Electrode, Segment

ROUNDING_MM = 1e-9


def check_electrodes(segment: Segment) -> None:
    """Raise InputError for electrodes that leave the film, overlap each other or share a name."""
    electrodes = segment.film.electrodes
    for number, electrode in enumerate(electrodes):
        _check_within(number, electrode, segment)
    for first, second in combinations(electrodes, 2):
        if first.name == second.name:
            raise InputError(f"segment.film.electrodes: the name '{first.name}' is given twice")
        if all(_shared(first, second, axis) > ROUNDING_MM for axis in (0, 1)):
            raise InputError(
                f"segment.film.electrodes: '{first.name}' and '{second.name}' overlap by "
                f"{_shared(first, second, 0):.3g} x {_shared(first, second, 1):.3g} mm"
            )


def _check_within(number: int, electrode: Electrode, segment: Segment) -> None:
    for axis, limit in enumerate((segment.length_mm, segment.width_mm)):
        reach = abs(electrode.center_mm[axis]) + electrode.size_mm[axis] / 2
        if reach > limit / 2 + ROUNDING_MM:
            raise InputError(
                f"segment.film.electrodes[{number}]: '{electrode.name}' reaches {reach:g} mm from the "
                f"centre in {'xy'[axis]}, beyond the edge of the film at {limit / 2:g} mm"
            )


def _shared(first: Electrode, second: Electrode, axis: int) -> float:
    """Length in mm along an axis that two electrodes share; negative for a gap."""
    high = min(one.center_mm[axis] + one.size_mm[axis] / 2 for one in (first, second))
    low = max(one.center_mm[axis] - one.size_mm[axis] / 2 for one in (first, second))
    return high - low
