"""Where the baseline fails, and which component's sensitivities explain it.

How much of the excess each component of the 3D model can explain.

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

from diagnose.findings import LocatedExcess
from diagnose.fit.refit import Fitted
from diagnose.fit.samples import Samples
from diagnose.inference.residual_test import Checked
from diagnose.inference.search import Screening
from diagnose.signals.phases import PHASES
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.nuisance_projection import Marginal
from geometry.arrays import Bools, Floats

MOST = 10  # components: 1 024 small fits


def shares_of_excess(energies: Floats, degrees: Floats) -> Floats:
    """Shares (c,) of cells in all energy above what noise has; zeros when no cell has any."""
    excess = np.maximum(energies - degrees, 0.0)
    return np.asarray(excess / excess.sum() if excess.any() else excess)


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


COMPONENTS = 6  # whose shares are worked out
ENOUGH = 0.5  # of a cell's excess that a component has to explain to be named there


def explanations(found: Screening, fits: Sequence[Fitted]) -> dict[str, tuple[Floats, Bools]]:
    """Component -> columns (n, q) that it can make, those that explain most first, and which cannot be negative.

    The fitted effect where there is one, else the sensitivity of the candidate that shows most.
    """
    by_component: dict[str, tuple[Floats, Bools]] = {}
    for fit in fits:
        if len(fit.candidates) == 1:
            own = fit.candidates[0].component
            by_component.setdefault(own, (fit.system.effect[:, None], np.array([True])))
    for number in found.survivors:
        one = found.each[number]
        by_component.setdefault(one.candidate.component, (one.columns, one.non_negative))
    return dict(list(by_component.items())[:COMPONENTS])


def shares(found: Screening, explained: dict[str, tuple[Floats, Bools]]) -> dict[str, float]:
    """Component -> share of all excess."""
    if not explained:
        return {}
    marginal = _marginal(found)
    start = found.start
    columns = [marginal(start.weighted(columns)) for columns, _ in explained.values()]
    signs = [non_negative for _, non_negative in explained.values()]
    found_shares = component_shares(marginal(start.weighted(start.residual)), columns, signs)
    return {name: float(share) for name, share in zip(explained, found_shares, strict=True)}


def places(
    samples: Samples, checked: Checked, found: Screening, explained: dict[str, tuple[Floats, Bools]]
) -> tuple[LocatedExcess, ...]:
    """Cells with an excess that stands out, the largest first; the strongest one where only sums of cells do."""
    cells = samples.bank.cells
    share = shares_of_excess(checked.energies, samples.bank.degrees)
    kept = [int(n) for n in np.argsort(-share) if checked.p_values[n] <= RATES.level]
    kept = kept or [int(np.argmax(checked.scores[: len(cells)]))]
    owner = _owners(samples, found, explained) if explained else {}
    return tuple(
        LocatedExcess(
            samples.recording.runs[cells[n].labels["run"]].label,
            samples.channels[cells[n].labels["channel"]],
            PHASES[cells[n].labels["phase"]],
            cells[n].labels["press"],
            cells[n].band_Hz,
            float(checked.scores[n]),
            float(checked.p_values[n]),
            float(share[n]),
            owner.get(n, ""),
        )
        for n in kept
    )


def _owners(samples: Samples, found: Screening, explained: dict[str, tuple[Floats, Bools]]) -> dict[int, str]:
    """Cell -> the component whose best fit takes most of its excess away."""
    marginal, start = _marginal(found), found.start
    white = marginal(start.weighted(start.residual))
    cell, count = samples.bank.cell[start.informative], len(samples.bank.cells)
    before = np.bincount(cell, white**2, count)
    degrees = np.bincount(cell, minlength=count)
    taken = []
    for columns, _ in explained.values():
        own = marginal(start.weighted(columns))
        made = own @ np.linalg.lstsq(own, white, rcond=None)[0]
        taken.append(before - np.bincount(cell, (white - made) ** 2, count))
    best = np.argmax(taken, axis=0)
    enough = np.max(taken, axis=0) > ENOUGH * np.maximum(before - degrees, 1.0)
    names = list(explained)
    return {int(n): names[best[n]] for n in np.flatnonzero(enough)}


def _marginal(found: Screening) -> Marginal:
    return Marginal(found.start.weighted(found.start.nuisance_design), found.start.sigma)
