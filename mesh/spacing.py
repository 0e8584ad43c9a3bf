"""Graded division of a line."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from mesh.types import Floats


def graded(start: float, end: float, size: Callable[[Floats], Floats]) -> Floats:
    """Points from start to end, both included, whose steps follow size at the points.

    The number of steps is the integral of 1/size, rounded up; the points cut that integral into equal parts.
    """
    fine = np.linspace(start, end, 513)
    density = 1.0 / size(fine)
    integral = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(fine))])
    steps = max(1, int(np.ceil(integral[-1] - 1e-9)))
    points = np.interp(np.linspace(0.0, integral[-1], steps + 1), integral, fine)
    points[0], points[-1] = start, end
    return np.asarray(points, dtype=np.float64)


def graded_through(breaks: list[float], size: Callable[[Floats], Floats]) -> Floats:
    """Points through all breaks (rising), graded between them."""
    pieces = [graded(a, b, size)[:-1] for a, b in pairwise(breaks)]
    return np.concatenate([*pieces, [breaks[-1]]])
