"""How much of the excess each component of the 3D model can explain.

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

MOST = 10  # components: 1 024 small fits


def component_shares(residual: Floats, sensitivities: Sequence[Floats], non_negative: Sequence[Bools]) -> Floats:
    """Shares (k,) of components in the excess of a residual (n,), each in [0, 1]; the rest to 1 nobody explains.

    sensitivities : (n, q_i) of each component, nuisance-free. non_negative : (q_i,) parameters whose off value is the
    lower end of their range. The excess is the sum of squares above n. ValueError for more than MOST components.
    """
    count = len(sensitivities)
    if count > MOST:
        raise ValueError(f"shares of {count} components; at most {MOST}: screen them first")
    triangle = np.asarray(qr(np.column_stack([residual, *sensitivities]), mode="economic")[1])
    edges = np.cumsum([1, *(s.shape[1] for s in sensitivities)])
    parts = [_signed(triangle[:, a:b], ok) for a, b, ok in zip(edges[:-1], edges[1:], non_negative, strict=True)]
    values = _shapley(count, lambda chosen: _explained(triangle[:, 0], [parts[n] for n in chosen]))
    excess = max(float(residual @ residual) - len(residual), float(values.sum()))
    return np.asarray(values / excess if excess > 0.0 else values)


def _signed(columns: Floats, non_negative: Bools) -> Floats:
    """Columns whose non-negative combinations are all that the component can do."""
    return np.column_stack([columns, -columns[:, ~non_negative]])


def _explained(target: Floats, parts: list[Floats]) -> float:
    """Fall of the sum of squares by the best non-negative combination."""
    if not parts:
        return 0.0
    columns = np.column_stack(parts)
    length = np.linalg.norm(columns, axis=0)
    _, misfit = nnls(columns / np.where(length > 0.0, length, 1.0), target)
    return float(target @ target - misfit**2)


def _shapley(count: int, value: Callable[[tuple[int, ...]], float]) -> Floats:
    """Mean gain (count,) of each player over all orders of a set function."""
    worth = {c: value(c) for size in range(count + 1) for c in combinations(range(count), size)}
    mean = np.zeros(count)
    for chosen, before in worth.items():
        for n in set(range(count)) - set(chosen):
            orders = factorial(len(chosen)) * factorial(count - len(chosen) - 1)
            mean[n] += orders / factorial(count) * (worth[tuple(sorted((*chosen, n)))] - before)
    return mean
