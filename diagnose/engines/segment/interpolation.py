"""Interpolation between the values of a candidate's coordinates at which the 3D model was pressed.

A change is a sum of functions of the coordinates, phi(x) (p,), with as many presses as there are functions: with Phi
(p, p) their values at the presses, the weights of the presses at x are phi(x) Phi^-1. Where a fit has led, the model is
pressed once more; what it differs by there fades with the distance, and is nothing at the first presses.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import asinh, sinh

import numpy as np
from scipy.interpolate import BSpline, RBFInterpolator, make_interp_spline

from diagnose.forward import Candidate, Coordinate
from foundation.arrays import Floats

SPLINE_DEGREE = 3
GLUE_ANISOTROPY = 100.0  # along to across a glue; with less than this between them, Newton's method has no trouble
Values = Sequence[float]
Functions = Callable[[Values], Floats]


@dataclass(frozen=True)
class PressedEffect:
    """Layout of the presses of a candidate with q coordinates. points (p, q) : where the 3D model is pressed.

    pressed : numbers of the coordinates that need presses.
    """

    points: tuple[tuple[float, ...], ...]
    pressed: tuple[int, ...]
    functions: Functions
    bounds: tuple[Coordinate, ...]
    inverse: Floats

    def weights(self, values: Values) -> Floats:
        """Weights (p,) of the presses at values (q,), all 0 where all values are. ValueError beyond the bounds."""
        for n in self.pressed:
            low, high = self.bounds[n].low, self.bounds[n].high
            if not low - 1e-9 <= values[n] <= high + 1e-9:
                raise ValueError(f"{self.bounds[n].name} = {values[n]:.4g}: must lie between {low:.4g} and {high:.4g}")
        return np.asarray(self.functions(values) @ self.inverse)


@lru_cache(maxsize=512)
def pressed_effect(together: str, coordinates: tuple[Coordinate, ...]) -> PressedEffect:
    """Layout of the presses for coordinates that go together in this way; see diagnose.forward.Candidate."""
    pressed = tuple(n for n, coordinate in enumerate(coordinates) if coordinate.nodes)
    splines = [_spline(coordinates[n]) for n in pressed]
    points, functions = _LAYOUTS[together](coordinates, pressed, splines)
    whole = np.array([functions(point) for point in points])
    inverse = np.linalg.inv(whole) if points else np.zeros((0, 0))
    return PressedEffect(tuple(points), pressed, functions, coordinates, inverse)


def candidate_effect(candidate: Candidate) -> PressedEffect:
    """Layout of the presses of a candidate."""
    return pressed_effect(candidate.together, candidate.coordinates)


def _spline(coordinate: Coordinate) -> BSpline:
    """Cardinal splines (m,) of the m nodes of a coordinate, all 0 at 0."""
    knots = np.array([0.0, *coordinate.nodes])
    order = np.argsort(knots)
    return make_interp_spline(knots[order], np.eye(len(knots))[order][:, 1:], min(SPLINE_DEGREE, len(knots) - 1))


Layout = tuple[Sequence[tuple[float, ...]], Functions]


def _additive_layout(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Layout with each coordinate by itself; their changes add up."""
    points = [_point_at(coordinates, {n: node}) for n in pressed for node in coordinates[n].nodes]

    def functions(values: Values) -> Floats:
        return np.concatenate([spline(values[n]) for spline, n in zip(splines, pressed, strict=True)] or [np.zeros(0)])

    return points, functions


def _joint_layout(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Layout with one more press, all at their ends, for coordinates that act on the same thing."""
    points, separate = _additive_layout(coordinates, pressed, splines)
    if len(pressed) < 2:
        return points, separate

    def functions(values: Values) -> Floats:
        both = np.prod([values[n] / coordinates[n].nodes[-1] for n in pressed])
        return np.append(separate(values), both)

    return [*points, _point_at(coordinates, {n: coordinates[n].nodes[-1] for n in pressed})], functions


def _fading_layout(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Layout where later coordinates mean nothing without the first: each is pressed at every node of the first."""
    first, nodes = pressed[0], coordinates[pressed[0]].nodes
    points = [_point_at(coordinates, {first: node}) for node in nodes]
    points += [
        _point_at(coordinates, {first: node, n: later})
        for n in pressed[1:]
        for node in nodes
        for later in coordinates[n].nodes
    ]

    def functions(values: Values) -> Floats:
        reach = splines[0](values[first])
        later = [np.outer(reach, spline(values[n])).ravel() for spline, n in zip(splines[1:], pressed[1:], strict=True)]
        return np.concatenate([reach, *later])

    return points, functions


def _glue_layout(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Layout of compliances across and along a bond, which add up; pressed equal, and with a hundredth of it across."""
    _, functions = _additive_layout(coordinates, pressed, splines)
    nodes = coordinates[1].nodes
    across = (*nodes, *(asinh(sinh(node) / GLUE_ANISOTROPY) for node in nodes))
    return list(zip(across, nodes * 2, strict=True)), functions


def _point_at(coordinates: tuple[Coordinate, ...], values: dict[int, float]) -> tuple[float, ...]:
    """The point with these values by the number of their coordinate, and 0 in all other coordinates."""
    return tuple(values.get(n, 0.0) for n in range(len(coordinates)))


_LAYOUTS: dict[str, Callable[[tuple[Coordinate, ...], tuple[int, ...], list[BSpline]], Layout]] = {
    "sum": _additive_layout,
    "glue": _glue_layout,
    "jointly": _joint_layout,
    "fading": _fading_layout,
}


FADE_RANGE_SHARE = 0.3
"""Share of the range of a coordinate over which a difference fades."""
SAME_PRESS_RANGE_SHARE = 0.02
"""Share of the range of a coordinate within which a second press adds next to nothing."""


class Differences:
    """Differences of a candidate's later presses from the interpolation of its first ones; nothing at these."""

    def __init__(self, candidate: Candidate) -> None:
        effect = candidate_effect(candidate)
        self._pressed = list(effect.pressed)
        self._range = np.array([candidate.coordinates[n].high - candidate.coordinates[n].low for n in effect.pressed])
        off = (0.0,) * len(candidate.coordinates)
        self._points = np.array([self._scaled_point(point) for point in (off, *effect.points)])
        self._found: list[Floats] = []
        self._between: RBFInterpolator | None = None

    def _scaled_point(self, values: Values) -> Floats:
        return np.asarray(np.array(values)[self._pressed] / self._range)

    def is_pressed_at(self, values: Values) -> bool:
        """Whether the model was pressed at values (q,), or next to them."""
        return bool(np.linalg.norm(self._points - self._scaled_point(values), axis=1).min() < SAME_PRESS_RANGE_SHARE)

    def add(self, values: Values, difference: Floats) -> None:
        """Add a press at values (q,) where none was, and what it still differs by, of any shape."""
        self._points = np.vstack([self._points, self._scaled_point(values)])
        before = self.difference_at(values)
        self._found.append(difference if before is None else difference + before)
        none = np.zeros((len(self._points) - len(self._found), difference.size))
        all_of_them = np.vstack([none, *(one.reshape(1, -1) for one in self._found)])
        self._between = RBFInterpolator(
            self._points, all_of_them, kernel="inverse_quadratic", epsilon=1.0 / FADE_RANGE_SHARE, degree=-1
        )

    def difference_at(self, values: Values) -> Floats | None:
        """Difference at values (q,), of the shape of those that were added; None before there are any."""
        if self._between is None:
            return None
        return np.asarray(self._between(self._scaled_point(values)[None])[0].reshape(self._found[0].shape))
