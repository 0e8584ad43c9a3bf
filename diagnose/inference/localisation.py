"""Where the baseline fails, and which component's sensitivities explain it."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from diagnose.findings import LocatedExcess
from diagnose.fit.refit import Fitted
from diagnose.fit.samples import Samples
from diagnose.inference.residual_test import Checked
from diagnose.inference.screening import Screening
from diagnose.signals.phases import PHASES
from diagnose.statistics.component_shares import component_shares
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.nuisance_projection import Marginal
from foundation.arrays import Bools, Floats


def shares_of_excess(energies: Floats, degrees: Floats) -> Floats:
    """Shares (c,) of cells in all energy above what noise has; zeros when no cell has any."""
    excess = np.maximum(energies - degrees, 0.0)
    return np.asarray(excess / excess.sum() if excess.any() else excess)


COMPONENTS = 6  # whose shares are worked out
ENOUGH = 0.5  # of a cell's excess that a component has to explain to be named there


def explanations(
    found: Screening, fits: Sequence[Fitted], only: Collection[str] | None = None
) -> dict[str, tuple[Floats, Bools]]:
    """Component -> columns (n, q) that it can make, those that explain most first, and which cannot be negative.

    The fitted effect where there is one, else the sensitivity of the candidate that shows most. only : the components
    of what was named, beside which others are excluded however alike they look; all if None.
    """
    by_component: dict[str, tuple[Floats, Bools]] = {}
    for fit in fits:
        if len(fit.candidates) == 1:
            own = fit.candidates[0].component
            by_component.setdefault(own, (fit.system.effect[:, None], np.array([True])))
    for number in found.survivors:
        one = found.each[number]
        by_component.setdefault(one.candidate.component, (one.columns, one.non_negative))
    wanted = [(name, each) for name, each in by_component.items() if only is None or name in only]
    return dict(wanted[:COMPONENTS])


def shares(found: Screening, explained: dict[str, tuple[Floats, Bools]]) -> dict[str, float]:
    """Component -> share of all excess."""
    if not explained:
        return {}
    marginal = _marginal(found)
    start = found.start
    columns = [marginal(start.weighted_rows(columns)) for columns, _ in explained.values()]
    signs = [non_negative for _, non_negative in explained.values()]
    found_shares = component_shares(marginal(start.weighted_rows(start.residual)), columns, signs)
    return {name: float(share) for name, share in zip(explained, found_shares, strict=True)}


def places(
    samples: Samples, checked: Checked, found: Screening, explained: dict[str, tuple[Floats, Bools]]
) -> tuple[LocatedExcess, ...]:
    """Cells with an excess that stands out, each with the component that explains most of it."""
    return excess_places(samples, checked, _owners(samples, found, explained) if explained else {})


def excess_places(samples: Samples, checked: Checked, owner: Mapping[int, str]) -> tuple[LocatedExcess, ...]:
    """Cells with an excess that stands out, the largest first; the strongest one where only sums of cells do.

    owner : cell -> component that explains it.
    """
    cells = samples.bank.cells
    share = shares_of_excess(checked.energies, samples.bank.degrees)
    kept = [int(n) for n in np.argsort(-share) if checked.p_values[n] <= RATES.level]
    kept = kept or [int(np.argmax(checked.scores[: len(cells)]))]
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
    white = marginal(start.weighted_rows(start.residual))
    cell, count = samples.bank.cell[start.informative], len(samples.bank.cells)
    before = np.bincount(cell, white**2, count)
    degrees = np.bincount(cell, minlength=count)
    taken = []
    for columns, _ in explained.values():
        own = marginal(start.weighted_rows(columns))
        made = own @ np.linalg.lstsq(own, white, rcond=None)[0]
        taken.append(before - np.bincount(cell, (white - made) ** 2, count))
    best = np.argmax(taken, axis=0)
    enough = np.max(taken, axis=0) > ENOUGH * np.maximum(before - degrees, 1.0)
    names = list(explained)
    return {int(n): names[best[n]] for n in np.flatnonzero(enough)}


def _marginal(found: Screening) -> Marginal:
    return Marginal(found.start.weighted_rows(found.start.nuisance_design), found.start.sigma)
