"""The designs that are tried next, and those that no other design beats in everything.

The logarithm of the least force is modelled by a Gaussian process over the axes of the space, and the designs with the
largest expected improvement (Jones, Schonlau and Welch, J. Global Optim. 13, 1998, 455) are tried next. A choice from a
list is a corner of a simplex, so that no two values of it are nearer than others.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.stats import norm, qmc

from foundation.arrays import Bools, Floats
from softdot.families.gradient_process import GradientProcess, Prior
from softdot.sweeps.sampling import Axis, share_of, value_at_share

FEWEST_READING = 3
"""Least number of designs that read; below it the next ones fill the space instead."""
FAILURE_FACTOR = 1.5
"""A design that does not read, or cannot be solved, counts as this factor times the largest force of all."""
LOG2_CANDIDATES, NEAR_CANDIDATES, CHOICE_SWITCH_SHARE = 9, 512, 0.2
"""Candidates all over the space, as a power of two, and number of those beside the best design, with the share of their
choices that change.
"""
STEP_DEVIATION = 0.12
"""Standard deviation of steps beside a good design, in shares of an axis."""
LEAST_DISTANCE = 0.1
"""Least distance of two tried designs, in shares of the axes."""
PRIOR = Prior(power=1, length=(0.3, 1.0, 10.0), trend=(1e-3, 1.0, 1e4), noise=(1e-6, 1e-2, 1e2))
"""Of shares of the axes: a linear trend, and noise, which is what halving the depth leaves of the least force."""


def propose(
    axes: Sequence[Axis], rows: Sequence[Sequence[Any]], forces_N: Sequence[float | None], count: int, seed: int
) -> list[tuple[Any, ...]]:
    """Values of the axes of the designs to be tried next, at most count; equal calls give equal designs.

    rows : values of the axes of the designs so far; forces_N : their least forces, None where one does not read.
    """
    known = np.array([[share_of(axis, value) for axis, value in zip(axes, row, strict=True)] for row in rows])
    read = [number for number, force in enumerate(forces_N) if force is not None]
    best = known[min(read, key=lambda number: forces_N[number] or 0.0)] if read else None
    pool = [rounded_values(axes, shares) for shares in candidates(axes, best, seed)]
    shares = np.array([_shares(axes, row) for row in pool])
    gain = np.ones(len(pool)) if len(read) < FEWEST_READING else expected_gain(axes, known, forces_N, shares)
    chosen = choose_apart(gain, _features(axes, shares), _features(axes, known), count, LEAST_DISTANCE)
    return [pool[number] for number in chosen]


def _shares(axes: Sequence[Axis], row: Sequence[Any]) -> list[float]:
    return [share_of(axis, value) for axis, value in zip(axes, row, strict=True)]


def candidates(axes: Sequence[Axis], best: Floats | None, seed: int) -> Floats:
    """Shares (n, d) of the axes: Sobol points all over the space, and steps by chance from the best design (d,)."""
    random = np.random.default_rng(seed)
    spread = qmc.Sobol(len(axes), seed=random).random_base2(LOG2_CANDIDATES)
    if best is None:
        return np.asarray(spread)
    near = steps_beside(best, NEAR_CANDIDATES, random)
    switched = random.random(near.shape) < CHOICE_SWITCH_SHARE
    elsewhere = random.random(near.shape)
    for number, axis in enumerate(axes):
        if axis.values is not None:
            near[:, number] = np.where(switched[:, number], elsewhere[:, number], best[number])
    return np.concatenate([spread, near])


def steps_beside(place: Floats, count: int, random: np.random.Generator) -> Floats:
    """Random candidates (count, d) beside a place (d,), in shares of the axes."""
    return np.clip(place + STEP_DEVIATION * random.standard_normal((count, len(place))), 0.0, 1.0)


def choose_apart(gains: Floats, places: Floats, known: Floats, count: int, apart: float) -> list[int]:
    """Numbers of at most count candidates with the largest gains (n,), each farther than apart from known ones
    and from the others.

    places : (n, f) of the candidates, known : (k, f).

    >>> choose_apart(np.array([1.0, 3.0, 2.9]), np.array([[0.0], [1.0], [1.1]]), np.array([[5.0]]), 2, 0.5)
    [1, 0]
    """
    chosen: list[int] = []
    for number in np.argsort(-gains, kind="stable"):
        if len(chosen) == count:
            break
        if np.linalg.norm(known - places[number], axis=1).min() > apart:
            chosen.append(int(number))
            known = np.vstack([known, places[number]])
    return chosen


def rounded_values(axes: Sequence[Axis], shares: Floats) -> tuple[Any, ...]:
    """Values at shares (d,) of the axes, numbers between low and high to two digits, as one would make them."""
    return tuple(
        _rounded_value(axis, value_at_share(axis, float(share))) for axis, share in zip(axes, shares, strict=True)
    )


def _rounded_value(axis: Axis, value: Any) -> Any:
    """A number rounded to two digits within the bounds of its axis; a choice from a list as it is."""
    if axis.values is not None:
        return value
    return min(max(float(f"{value:.2g}"), float(axis.low or 0.0)), float(axis.high or 0.0))


def _features(axes: Sequence[Axis], shares: Floats) -> Floats:
    """Shares (n, d) of axes of numbers, and a corner of a simplex with edges of 1 for each choice, (n, f)."""
    columns = []
    for number, axis in enumerate(axes):
        if axis.values is None:
            columns.append(shares[:, [number]])
        else:
            choice = np.minimum((shares[:, number] * len(axis.values)).astype(int), len(axis.values) - 1)
            columns.append(np.eye(len(axis.values))[choice] / np.sqrt(2.0))
    return np.hstack(columns)


def expected_gain(axes: Sequence[Axis], known: Floats, forces_N: Sequence[float | None], wanted: Floats) -> Floats:
    """Expected improvement (m,) of the logarithm of the least force at shares wanted (m, d) by that at known (n, d)."""
    largest = FAILURE_FACTOR * max(force for force in forces_N if force is not None)
    target = np.log([largest if force is None else force for force in forces_N])
    process = GradientProcess(_features(axes, known), target[:, None], None, prior=PRIOR)
    features = _features(axes, wanted)
    below, deviation = target.min() - process.mean(features)[:, 0], process.deviation(features)[:, 0]
    score = below / np.maximum(deviation, 1e-12)
    return np.asarray(below * norm.cdf(score) + deviation * norm.pdf(score))


def pareto(values: Floats) -> Bools:
    """Which of the points (n, k) no other one is better than: as small in all and smaller in one.

    >>> pareto(np.array([[1.0, 2.0], [2.0, 1.0], [2.0, 2.0]])).tolist()
    [True, True, False]
    """
    no_more = (values[:, None] <= values[None]).all(axis=2)
    less = (values[:, None] < values[None]).any(axis=2)
    return np.asarray(~(no_more & less).any(axis=0))
