"""Shares of the excess that each component of the 3D model can explain.

The residual is fitted by the sensitivities of a set of components. What a component adds to the explained sum of
squares depends on which others came before; its share is the mean over all orders (Shapley 1953; Lindeman, Merenda and
Gold, Introduction to Bivariate and Multivariate Analysis, 1980). Shares are never negative, add up to what all explain
together, and components that look alike get alike shares.
"""

from collections.abc import Callable, Sequence
from itertools import combinations
from math import factorial

import numpy as np
from scipy.linalg import qr
from scipy.optimize import nnls

from foundation.arrays import Bools, Floats

MOST_COMPONENTS = 10  # 1 024 small fits


def component_shares(residual: Floats, sensitivities: Sequence[Floats], non_negative: Sequence[Bools]) -> Floats:
    """Shares (k,) of components in the excess of a residual (n,), each in [0, 1]; nobody explains the rest to 1.

    sensitivities : (n, q_i) of each component, nuisance-free. non_negative : (q_i,) flags of parameters whose off value
    is the lower end of their range. The excess is the sum of squares above n. ValueError for more than MOST_COMPONENTS
    components.
    """
    count = len(sensitivities)
    if count > MOST_COMPONENTS:
        raise ValueError(f"shares of {count} components; at most {MOST_COMPONENTS}: screen them first")
    triangle = np.asarray(qr(np.column_stack([residual, *sensitivities]), mode="economic")[1])
    edges = np.cumsum([1, *(s.shape[1] for s in sensitivities)])
    parts = [
        _cone_generators(triangle[:, a:b], ok) for a, b, ok in zip(edges[:-1], edges[1:], non_negative, strict=True)
    ]
    values = _shapley_values(count, lambda chosen: _explained_square(triangle[:, 0], [parts[n] for n in chosen]))
    excess = max(float(residual @ residual) - len(residual), float(values.sum()))
    return np.asarray(values / excess if excess > 0.0 else values)


def _cone_generators(columns: Floats, non_negative: Bools) -> Floats:
    """Columns whose non-negative combinations are all signals that the component can make."""
    return np.column_stack([columns, -columns[:, ~non_negative]])


def _explained_square(target: Floats, parts: list[Floats]) -> float:
    """Fall of the sum of squares of a target (m,) by the best non-negative combination of the parts' columns."""
    if not parts:
        return 0.0
    columns = np.column_stack(parts)
    length = np.linalg.norm(columns, axis=0)
    _, misfit = nnls(columns / np.where(length > 0.0, length, 1.0), target)
    return float(target @ target - misfit**2)


def _shapley_values(count: int, value: Callable[[tuple[int, ...]], float]) -> Floats:
    """Shapley value (count,) of each player of a set function: its mean gain over all orders."""
    worth = {c: value(c) for size in range(count + 1) for c in combinations(range(count), size)}
    mean = np.zeros(count)
    for chosen, before in worth.items():
        for n in set(range(count)) - set(chosen):
            orders = factorial(len(chosen)) * factorial(count - len(chosen) - 1)
            mean[n] += orders / factorial(count) * (worth[tuple(sorted((*chosen, n)))] - before)
    return mean
