"""A goal in a family: the design that needs least of one quantity and gives enough of another in nearly every batch.

Numbers of a batch (a modulus of silicone, a height of a printed dot) are drawn over their ranges, the others chosen,
by differential evolution (Storn and Price, J. Glob. Optim. 11, 1997) on the answers of the family. The same draws serve
all designs, so that they differ by their numbers alone (a sample average: Kleywegt, Shapiro and Homem-de-Mello, SIAM J.
Optim. 12, 2002). What a full press gives, over what the family answers there, corrects its answers (space mapping:
Bandler et al., IEEE Trans. Microw. Theory Tech. 42, 1994), since the press has a mesh of its own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.families.family import Family

SEARCH_DRAWS, TOLD_DRAWS, SEED = 256, 4096, 0
"""Batches of the search, and those of which the result is told; powers of two."""
POPULATION, GENERATIONS = 12, 80
MISSED = 1e6
"""Beyond all sizes of the quantity that is to be least: what a design that misses the goal counts."""


MARGIN = 1e-3
"""By which share a design is to give more than the goal, so that its press gives no less."""


@dataclass(frozen=True)
class Goal:
    """What is asked. enough : quantity that is to reach target, in its unit and without sign, with the probability
    asked; least : quantity that is to be small. batch : short names or keys of what no design chooses.
    """

    enough: str
    target: float
    least: str
    batch: tuple[str, ...] = ()
    probability: float = 0.95


@dataclass(frozen=True)
class MetGoal:
    """The best design. place (d,) : in the space, batches in their middle. reached : whether it meets the goal.

    enough, least : low end (5 %), middle and high end (95 %) over the batches. probability : that it gives enough;
    surely : the same at the low end of the family's interval.
    """

    place: Floats
    reached: bool
    enough: tuple[float, float, float]
    least: tuple[float, float, float]
    probability: float
    surely: float


def met_goal(family: Family, goal: Goal, corrections: Mapping[str, float] | None = None) -> MetGoal:
    """The best design of a family for a goal at full load. corrections : by which what a quantity is answered is
    multiplied. InputError for names that the family does not have.
    """
    search = _Search(family, goal, corrections or {})
    return search.told(search.best())


def judged_goal(family: Family, goal: Goal, place: Floats, corrections: Mapping[str, float]) -> MetGoal:
    """How the design at a place (d,) of a family meets a goal. InputError as of met_goal."""
    search = _Search(family, goal, corrections)
    return search.told(search.chosen_of(place))


def corrections_by(answered: Mapping[str, float], pressed: Mapping[str, float]) -> dict[str, float]:
    """What a press gives over what the family answers for the same design, by quantity; those that it answers with 0
    stay as they are.
    """
    return {name: pressed[name] / answered[name] for name in pressed if answered.get(name)}


class _Search:
    """Designs by their chosen places (c,), each with the same batches."""

    def __init__(self, family: Family, goal: Goal, corrections: Mapping[str, float]) -> None:
        self._goal, self._family, self._corrections = goal, family, corrections
        for name in (goal.enough, goal.least):
            if name not in family.quantities:
                raise InputError(f"'{name}': this family answers {', '.join(family.quantities)}")
        batch = _axes(family, goal.batch)
        self._batch = np.array(batch, dtype=int)
        self._chosen = np.array([n for n in range(family.space.count) if n not in batch], dtype=int)
        if not len(self._chosen):
            raise InputError("--batch: names all numbers of the family, so that none is left to choose")

    def best(self) -> Floats:
        """The chosen places (c,) of the best design."""
        shares = self._batches(SEARCH_DRAWS)
        bounds = [(-1.0, 1.0)] * len(self._chosen)
        found = differential_evolution(
            lambda columns: self._cost(columns.T, shares), bounds, vectorized=True, updating="deferred", seed=SEED,
            popsize=POPULATION, maxiter=GENERATIONS, tol=1e-4, polish=False,
        )  # fmt: skip
        return np.asarray(found.x)

    def chosen_of(self, place: Floats) -> Floats:
        """The chosen places (c,) of a place (d,)."""
        return np.asarray(place[self._chosen])

    def told(self, chosen: Floats) -> MetGoal:
        """What a design gives over many batches."""
        places = self._places(chosen[None], self._batches(TOLD_DRAWS))[0]
        enough, least = (self._sizes(name, places) for name in (self._goal.enough, self._goal.least))
        course = self._family.quantities[self._goal.enough].course(places)
        ratio = self._corrections.get(self._goal.enough, 1.0)
        low = ratio * np.minimum(np.abs(course.low[:, -1]), np.abs(course.high[:, -1]))
        probability = float((enough >= self._goal.target).mean())
        middle = np.zeros(self._family.space.count)
        middle[self._chosen] = chosen
        ends = tuple(tuple(float(one) for one in np.quantile(values, (0.05, 0.5, 0.95))) for values in (enough, least))
        return MetGoal(
            middle, probability >= self._goal.probability, ends[0], ends[1], probability,  # type: ignore[arg-type]
            float((low >= self._goal.target).mean()),
        )  # fmt: skip

    def _batches(self, count: int) -> Floats:
        """Places (k, b) of batches, drawn over their ranges; one in the middle where nothing is drawn."""
        if not len(self._batch):
            return np.zeros((1, 0))
        shares = qmc.Sobol(len(self._batch), seed=np.random.default_rng(SEED)).random(count)
        ranges = [self._family.space.ranges[axis] for axis in self._batch]
        return np.column_stack([one.places(one.drawn(share)) for one, share in zip(ranges, shares.T, strict=True)])

    def _places(self, chosen: Floats, batches: Floats) -> Floats:
        """Places (q, k, d) of designs (q, c) with each batch (k, b)."""
        places = np.empty((len(chosen), len(batches), self._family.space.count))
        places[:, :, self._chosen] = chosen[:, None]
        places[:, :, self._batch] = batches
        return places

    def _cost(self, chosen: Floats, batches: Floats) -> Floats:
        """What designs (q, c) need; of those that miss the goal, or lie where nothing can be pressed, beyond MISSED."""
        places = self._places(chosen, batches)
        flat = places.reshape(-1, places.shape[-1])
        names = self._goal.enough, self._goal.least
        enough, least = (self._sizes(name, flat).reshape(places.shape[:2]) for name in names)
        missing = max(1.0 - self._goal.probability - 1.0 / len(batches), 0.0)  # by one draw on the safe side
        reached = np.quantile(enough, missing, axis=1, method="lower")
        lacking = np.maximum((1.0 + MARGIN) * self._goal.target - reached, 0.0) / self._goal.target
        good = self._family.region.holds(flat).reshape(places.shape[:2]).all(axis=1)
        return np.where(good & (lacking == 0.0), least.mean(axis=1), MISSED * (1.0 + lacking + 10.0 * ~good))

    def _sizes(self, name: str, places: Floats) -> Floats:
        """Of a quantity at full load (q,)."""
        answered = self._family.quantities[name].course_values(places)[:, -1]
        return np.asarray(self._corrections.get(name, 1.0) * np.abs(answered))


def _axes(family: Family, names: Sequence[str]) -> list[int]:
    """Numbers of the axes with these names or keys. InputError."""
    known = {name: number for number, one in enumerate(family.space.ranges) for name in (one.name, *one.keys)}
    for name in names:
        if name not in known:
            raise InputError(f"--batch {name}: this family varies {', '.join(one.name for one in family.space.ranges)}")
    return sorted({known[name] for name in names})
