"""Bounded Levenberg-Marquardt over the coordinates of mechanisms, with all nuisance parameters integrated out.
What is linear leaves only inner products (variable projection; Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.fit.levenberg_marquardt import Patience, minimised
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.nuisances import slope_by_step
from diagnose.fit.observed_model import SLOPE_STEP_SHARE, ObservedModel
from diagnose.fit.secant_slopes import SecantSlopes
from diagnose.forward import Candidate, Coordinate, Setting
from foundation.arrays import Floats

ITERATIONS = 40
STILL = 0.02  # of a standard error: a step below it is none
LEAST_GAIN = 1e-3  # in half squares: less is no progress


@dataclass(frozen=True, eq=False)
class Place:
    """values : (q,). predicted : (n,) there. left : weighted residual. cost : half its square."""

    values: Floats
    predicted: Floats
    left: Floats
    cost: float


@dataclass(frozen=True)
class Descent:
    """Mechanisms in the metric of a system. origin : the prediction at which its residual was taken, and the residual.

    The best values are those whose prediction comes nearest to the origin.
    """

    model: ObservedModel
    system: LinearisedSystem
    candidates: tuple[Candidate, ...]
    origin: Floats

    def vector(self, values: Floats) -> Floats:
        """The prediction (n,) at the system's nuisances. ValueError where the model has no answer."""
        return self.model.vector(self.system.values, settings(self.candidates, values))

    def at(self, values: Floats) -> Place:
        """Residual and cost at values (q,); an infinite cost where the model has no answer."""
        try:
            predicted = self.vector(values)
        except ValueError:
            return Place(values, self.origin, np.zeros(int(self.system.informative.sum())), np.inf)
        left = self.system.weighted_rows(self.origin - predicted)
        return Place(values, predicted, left, 0.5 * self.system.quadratic.square(left))

    def slopes(self, place: Place) -> Floats:
        """(n, q) change per unit of each value, by differences towards the inside, or where the model has an answer."""
        columns = []
        for number, coordinate in enumerate(coordinates(self.candidates)):
            step = SLOPE_STEP_SHARE * max(min(map(abs, coordinate.starts)), abs(place.values[number]))
            step = -step if place.values[number] + step > coordinate.high else step
            columns.append(self._slope(place, number, step))
        return np.column_stack(columns)

    def _slope(self, place: Place, number: int, step: float) -> Floats:
        """(n,) per unit of one value; 0 where the model has an answer on neither side."""

        def change(by: float) -> Floats:
            moved = place.values.copy()
            moved[number] += by
            return np.asarray(self.vector(moved) - place.predicted)

        return slope_by_step(change, step, len(place.predicted))


def descent(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], about: Sequence[Setting]
) -> Descent:
    """about : the mechanisms about which the system is linear."""
    return Descent(model, system, tuple(candidates), model.vector(system.values, about) + system.residual)


def descended(problem: Descent, start: Floats, rough: float = 0.0) -> tuple[Place, Floats]:
    """The best place from a start (q,), and the slopes (n, q) there; a step that gains less than rough is the last."""
    slopes = SecantSlopes(problem.slopes)

    def expansion(here: Place, anew: bool) -> tuple[Floats, Floats]:
        columns = problem.system.weighted_rows(slopes.at(here, anew))
        cleared = problem.system.quadratic.apply_inverse(columns)
        return columns.T @ cleared, cleared.T @ here.left

    usual = 0.5 * max(float(problem.system.informative.sum()), 1.0)
    patience = Patience(ITERATIONS, LEAST_GAIN, STILL, usual, rough_gain=rough)
    found = minimised(problem.at, expansion, start, bounds(problem.candidates), patience)
    if not np.isfinite(found.cost):
        return found, np.zeros((len(found.predicted), len(start)))
    return found, slopes.at(found, anew=True)


def lowest(problem: Descent, starts: Sequence[Floats], rough: float = 0.0) -> Place | None:
    """The best place from several starts (q,); none where the model has no answer."""
    tries = [descended(problem, start, rough)[0] for start in starts]
    return min((place for place in tries if np.isfinite(place.cost)), key=lambda place: place.cost, default=None)


def settings(candidates: Sequence[Candidate], values: Floats) -> tuple[Setting, ...]:
    """Values (q,) dealt out to the candidates."""
    edges = np.cumsum([0, *(len(c.coordinates) for c in candidates)])
    return tuple(
        Setting(candidate, tuple(values[a:b].tolist()))
        for candidate, a, b in zip(candidates, edges[:-1], edges[1:], strict=True)
    )


def coordinates(candidates: Sequence[Candidate]) -> tuple[Coordinate, ...]:
    """All of them, in order."""
    return tuple(coordinate for candidate in candidates for coordinate in candidate.coordinates)


def bounds(candidates: Sequence[Candidate]) -> Floats:
    """(q, 2) of all coordinates."""
    return np.array([(c.low, c.high) for c in coordinates(candidates)])
