"""What depends on the path: softening and yield, from presses down and up again.

While the dot goes deeper than ever, force and charge are those of the way down. On the way up, and down again as far
as the largest depth U so far, they are those of the way up from U. The curves of several U go over into each other as
functions of u / U.

Friction is not here: a straight press slips on the way down and sticks on the way up, where the force was found the
same to 0.1 %.

Between the values of a candidate's coordinates at which the 3D model was pressed.

A change is a sum of functions of the coordinates, phi(x) (p,), with as many presses as there are functions: with
Phi (p, p) their values at the presses, the weights of the presses at x are phi(x) Phi^-1.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import asinh, sinh

import numpy as np
from scipy.interpolate import BSpline, PchipInterpolator, make_interp_spline

from diagnose.engines.segment.answer import Mechanics
from diagnose.forward import Candidate, Coordinate
from geometry.arrays import Floats
from solve.reduced.fit import CELLS, ResponseTable
from solve.tables.job import RETURN

BACK = 2, 4
"""Which of the shares of the depth are turned at."""
ROWS = np.linspace(0.0, 1.0, CELLS + 1)


@dataclass(frozen=True)
class PathHistory:
    """values (n + b r, 2 + e) : changes on the way down and on the ways back: of force and area relative to the
    baseline's, of charges per force of the baseline.

    shares (n,) : of the depth on the way down.
    """

    values: Floats
    shares: tuple[float, ...]

    def along(self, share: Floats) -> tuple[Floats, Floats]:
        """Changes (t, 2 + e) along a path in shares (t,) of the depth, and the depths (t,) that charges refer to."""
        place = np.clip(share, 0.0, None)
        largest = np.maximum.accumulate(place)
        down = _curve(np.array(self.shares), self.values[: len(self.shares)], place)
        inside = np.clip(place / np.maximum(largest, 1e-12), 0.0, 1.0)
        turned = np.array([self.shares[m] for m in BACK])
        back = _between(turned, [self._way(number, inside) for number in range(len(BACK))], largest)
        returning = place < largest
        return np.where(returning[:, None], back, down), np.where(returning, largest, place)

    def _way(self, number: int, inside: Floats) -> Floats:
        """Changes (t, 2 + e) on a way back at parts (t,) of the depth where it began."""
        first = len(self.shares) + number * len(RETURN)
        values = np.vstack([self.values[first : first + len(RETURN)][::-1], self.values[BACK[number]]])
        return _curve(np.array([*RETURN[::-1], 1.0]), values, inside)


def changes(outputs: Floats, base: Floats, shares: Sequence[float], fit: ResponseTable) -> Floats:
    """Changes (n + b r, 2 + e) from outputs of a press down and up; base (n, 2 + e) : of the baseline down.

    The baseline's way back is its way down; charges on a way back are per force at the depth where it began.
    """
    found = [_relative(outputs[: len(shares)], base, base[:, :1])]
    for number, m in enumerate(BACK):
        rows = outputs[len(shares) + number * len(RETURN) :][: len(RETURN)]
        depths = np.array(RETURN) * shares[m]
        before = np.column_stack([np.interp(depths, ROWS, column) for column in fit.table[:, 0, : outputs.shape[1]].T])
        found.append(_relative(rows, before, base[m, :1]))
    return np.concatenate(found)


def _relative(outputs: Floats, base: Floats, force: Floats) -> Floats:
    """(n, 2 + e) from outputs (n, 2 + e) and the baseline's; force in N that charges are referred to."""
    ratios = outputs[:, :2] / np.maximum(base[:, :2], 1e-300) - 1.0
    return np.concatenate([ratios, (outputs[:, 2:] - base[:, 2:]) / np.maximum(force, 1e-300)], axis=1)


def _curve(at: Floats, values: Floats, place: Floats) -> Floats:
    """Values (t, o) over the depth, constant towards touch."""
    curve = PchipInterpolator(np.array([0.0, *at]), np.vstack([values[:1], values]))
    return np.asarray(curve(np.clip(place, 0.0, 1.0)))


def _between(turned: Floats, curves: Sequence[Floats], largest: Floats) -> Floats:
    """Linear in the largest depth, constant beyond the ends."""
    place = np.interp(largest, turned, np.arange(len(turned)))
    low = np.minimum(place.astype(np.int64), len(turned) - 2)
    mix, stack = (place - low)[:, None], np.array(curves)
    rows = np.arange(len(largest))
    return np.asarray((1.0 - mix) * stack[low, rows] + mix * stack[low + 1, rows])


def with_history(found: Mechanics, histories: Sequence[PathHistory], fit: ResponseTable, depth_mm: float) -> Mechanics:
    """The path with force, area and charge as its history makes them."""
    share, force = found.path_mm / depth_mm, fit.table[:, 0, 0]
    factors, charge = np.ones((len(share), 2)), found.charge_C
    for history in histories:
        change, at = history.along(share)
        factors = factors * np.maximum(1.0 + change[:, :2], 0.0)
        charge = charge + np.interp(at, ROWS, force)[:, None] * change[:, 2:]
    contact = factors.T * [found.force_N, found.area_m2]
    return replace(found, force_N=contact[0], area_m2=contact[1], charge_C=charge)


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
