"""Between the values of a candidate's coordinates at which the 3D model was pressed.

A change is a sum of functions of the coordinates, phi(x) (p,), with as many presses as there are functions: with
Phi (p, p) their values at the presses, the weights of the presses at x are phi(x) Phi^-1. Where a fit has led, the
model is pressed once more; what it differs by there fades with the distance, and is nothing at the first presses.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import asinh, sinh

import numpy as np
from scipy.interpolate import BSpline, RBFInterpolator, make_interp_spline

from diagnose.forward import Candidate, Coordinate
from foundation.arrays import Floats

DEGREE = 3
TIGHT = 100.0  # along to across a glue; with less than this between them, Newton's method has no trouble
Values = Sequence[float]
Functions = Callable[[Values], Floats]


@dataclass(frozen=True)
class PressedEffect:
    """points (p, q) : where the 3D model is pressed. pressed : numbers of the coordinates that need presses."""

    points: tuple[tuple[float, ...], ...]
    pressed: tuple[int, ...]
    functions: Functions
    bounds: tuple[Coordinate, ...]
    inverse: Floats

    def weights(self, values: Values) -> Floats:
        """(p,), all 0 where all values are. ValueError beyond the bounds."""
        for n in self.pressed:
            low, high = self.bounds[n].low, self.bounds[n].high
            if not low - 1e-9 <= values[n] <= high + 1e-9:
                raise ValueError(f"{self.bounds[n].name} = {values[n]:.4g}: must lie between {low:.4g} and {high:.4g}")
        return np.asarray(self.functions(values) @ self.inverse)


@lru_cache(maxsize=512)
def effect(together: str, coordinates: tuple[Coordinate, ...]) -> PressedEffect:
    """How a candidate is pressed and read; together : see diagnose.forward.Candidate."""
    pressed = tuple(n for n, coordinate in enumerate(coordinates) if coordinate.nodes)
    splines = [_spline(coordinates[n]) for n in pressed]
    points, functions = _LAYOUTS[together](coordinates, pressed, splines)
    whole = np.array([functions(point) for point in points])
    inverse = np.linalg.inv(whole) if points else np.zeros((0, 0))
    return PressedEffect(tuple(points), pressed, functions, coordinates, inverse)


def effect_of(candidate: Candidate) -> PressedEffect:
    """What a candidate changes in a press."""
    return effect(candidate.together, candidate.coordinates)


def _spline(coordinate: Coordinate) -> BSpline:
    """Cardinal functions (m,) of the m nodes, all 0 at 0."""
    knots = np.array([0.0, *coordinate.nodes])
    order = np.argsort(knots)
    return make_interp_spline(knots[order], np.eye(len(knots))[order][:, 1:], min(DEGREE, len(knots) - 1))


Layout = tuple[Sequence[tuple[float, ...]], Functions]


def _alone(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Each coordinate by itself; their changes add up."""
    points = [_at(coordinates, {n: node}) for n in pressed for node in coordinates[n].nodes]

    def functions(values: Values) -> Floats:
        return np.concatenate([spline(values[n]) for spline, n in zip(splines, pressed, strict=True)] or [np.zeros(0)])

    return points, functions


def _jointly(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """One more press with all at their ends, for how coordinates that act on the same thing go together."""
    points, separate = _alone(coordinates, pressed, splines)
    if len(pressed) < 2:
        return points, separate

    def functions(values: Values) -> Floats:
        both = np.prod([values[n] / coordinates[n].nodes[-1] for n in pressed])
        return np.append(separate(values), both)

    return [*points, _at(coordinates, {n: coordinates[n].nodes[-1] for n in pressed})], functions


def _fading(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """The later coordinates mean nothing without the first: each is pressed at every node of the first."""
    first, nodes = pressed[0], coordinates[pressed[0]].nodes
    points = [_at(coordinates, {first: node}) for node in nodes]
    points += [
        _at(coordinates, {first: node, n: later})
        for n in pressed[1:]
        for node in nodes
        for later in coordinates[n].nodes
    ]

    def functions(values: Values) -> Floats:
        reach = splines[0](values[first])
        later = [np.outer(reach, spline(values[n])).ravel() for spline, n in zip(splines[1:], pressed[1:], strict=True)]
        return np.concatenate([reach, *later])

    return points, functions


def _glue(coordinates: tuple[Coordinate, ...], pressed: tuple[int, ...], splines: list[BSpline]) -> Layout:
    """Compliances across and along the bond add up; pressed equal, and with a hundredth of it across."""
    _, functions = _alone(coordinates, pressed, splines)
    nodes = coordinates[1].nodes
    across = (*nodes, *(asinh(sinh(node) / TIGHT) for node in nodes))
    return list(zip(across, nodes * 2, strict=True)), functions


def _at(coordinates: tuple[Coordinate, ...], values: dict[int, float]) -> tuple[float, ...]:
    return tuple(values.get(n, 0.0) for n in range(len(coordinates)))


_LAYOUTS: dict[str, Callable[[tuple[Coordinate, ...], tuple[int, ...], list[BSpline]], Layout]] = {
    "sum": _alone,
    "glue": _glue,
    "jointly": _jointly,
    "fading": _fading,
}


REACH = 0.3
"""Of the range of a coordinate, over which a difference fades."""
SAME = 0.02
"""Of the range: a press nearer to another one tells next to nothing new."""


class Differences:
    """What a candidate's presses beyond those of its effect differ by from what these say, nothing at these."""

    def __init__(self, candidate: Candidate) -> None:
        effect = effect_of(candidate)
        self._pressed = list(effect.pressed)
        self._range = np.array([candidate.coordinates[n].high - candidate.coordinates[n].low for n in effect.pressed])
        off = (0.0,) * len(candidate.coordinates)
        self._points = np.array([self._place(point) for point in (off, *effect.points)])
        self._found: list[Floats] = []
        self._between: RBFInterpolator | None = None

    def _place(self, values: Values) -> Floats:
        return np.asarray(np.array(values)[self._pressed] / self._range)

    def known(self, values: Values) -> bool:
        """Whether the model was pressed there."""
        return bool(np.linalg.norm(self._points - self._place(values), axis=1).min() < SAME)

    def add(self, values: Values, difference: Floats) -> None:
        """A press at values (q,), and what it still differs by, of any shape; nowhere that is known."""
        self._points = np.vstack([self._points, self._place(values)])
        before = self.at(values)
        self._found.append(difference if before is None else difference + before)
        none = np.zeros((len(self._points) - len(self._found), difference.size))
        all_of_them = np.vstack([none, *(one.reshape(1, -1) for one in self._found)])
        self._between = RBFInterpolator(
            self._points, all_of_them, kernel="inverse_quadratic", epsilon=1.0 / REACH, degree=-1
        )

    def at(self, values: Values) -> Floats | None:
        """The difference at values (q,), of the shape of those that were added; None before there are any."""
        if self._between is None:
            return None
        return np.asarray(self._between(self._place(values)[None])[0].reshape(self._found[0].shape))
