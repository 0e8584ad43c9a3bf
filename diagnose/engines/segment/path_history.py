"""Mechanisms that depend on the path, softening and yield, from presses down and up again.

While the dot goes deeper than ever, force and charge are those of the way down. On the way up, and down again as far as
the largest depth U so far, they are those of the way up from U. The curves of several U go over into each other as
functions of u / U.

Friction is not here: a straight press slips on the way down and sticks on the way up, where the force was found the
same to 0.1 %.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.engines.segment.response import Mechanics
from foundation.arrays import Floats
from solve.reduced.fit import CELLS, ResponseTable
from solve.tables.depth_press import RETURN

TURNING_NUMBERS = 2, 4
"""Numbers of the shares of the depth at which a press turns back."""
TABLE_SHARES = np.linspace(0.0, 1.0, CELLS + 1)


@dataclass(frozen=True)
class PathHistory:
    """Changes of a press on the way down and on the ways back. shares (n,) : of the depth on the way down.

    values (n + b r, 2 + e) : of force and area relative to the baseline's, of charges per force of the baseline.
    """

    values: Floats
    shares: tuple[float, ...]

    def changes_along(self, share: Floats, before: float = 0.0) -> tuple[Floats, Floats]:
        """Changes (t, 2 + e) along a path in shares (t,) of the depth, and the shares (t,) that charges refer to.

        before : the largest share that was reached earlier.
        """
        place = np.clip(share, 0.0, None)
        largest = np.maximum(np.maximum.accumulate(place), before)
        down = self._way_down(np.clip(place, 0.0, 1.0))
        inside = np.clip(place / np.maximum(largest, 1e-12), 0.0, 1.0)
        back = _interpolate_returns(
            np.array([self.shares[m] for m in TURNING_NUMBERS]), self._ways_back(inside), largest
        )
        returning = place < largest
        return np.where(returning[:, None], back, down), np.where(returning, largest, place)

    @cached_property
    def _way_down(self) -> PchipInterpolator:
        """Changes (t, 2 + e) on the way down, a function of shares (t,) of the depth."""
        return _curve(self.shares, self.values[: len(self.shares)])

    @cached_property
    def _ways_back(self) -> PchipInterpolator:
        """Changes (t, b, 2 + e) on all ways back, a function of parts (t,) of the depth where each began."""
        back = self.values[len(self.shares) :].reshape(len(TURNING_NUMBERS), len(RETURN), -1)[:, ::-1]
        whole = np.concatenate([back, self.values[list(TURNING_NUMBERS), None]], axis=1)
        return _curve((*RETURN[::-1], 1.0), whole.transpose(1, 0, 2))


def path_changes(
    outputs: Floats,
    base: Floats,
    shares: Sequence[float],
    turning: Sequence[int],
    back: Sequence[float],
    fit: ResponseTable,
) -> Floats:
    """Changes (n + b r, 2 + e) from outputs of a press down and up; base (n, 2 + e) : of the baseline down.

    turning (b,) : numbers of the shares where it turns back, to be seen at parts (r,) of that depth.
    The baseline's way back is its way down; charges on a way back are per force at the depth where it began.
    """
    found = [_relative_changes(outputs[: len(shares)], base, base[:, :1])]
    for number, m in enumerate(turning):
        rows = outputs[len(shares) + number * len(back) :][: len(back)]
        depths = np.array(back) * shares[m]
        before = np.column_stack(
            [np.interp(depths, TABLE_SHARES, column) for column in fit.table[:, 0, : outputs.shape[1]].T]
        )
        found.append(_relative_changes(rows, before, base[m, :1]))
    return np.concatenate(found)


def _relative_changes(outputs: Floats, base: Floats, force: Floats) -> Floats:
    """Changes (n, 2 + e) of outputs (n, 2 + e) against the baseline's; force in N that charges are referred to."""
    ratios = outputs[:, :2] / np.maximum(base[:, :2], 1e-300) - 1.0
    return np.concatenate([ratios, (outputs[:, 2:] - base[:, 2:]) / np.maximum(force, 1e-300)], axis=1)


def _curve(at: Sequence[float], values: Floats) -> PchipInterpolator:
    """Curve through values (n, ...) at depths (n,), constant towards touch."""
    return PchipInterpolator(np.array([0.0, *at]), np.concatenate([values[:1], values]))


def _interpolate_returns(turned: Floats, curves: Floats, largest: Floats) -> Floats:
    """Values (t, o) of curves (t, b, o), linear in the largest depth (t,), constant beyond the ends."""
    place = np.interp(largest, turned, np.arange(len(turned)))
    low = np.minimum(place.astype(np.int64), len(turned) - 2)
    mix, rows = (place - low)[:, None], np.arange(len(largest))
    return np.asarray((1.0 - mix) * curves[rows, low] + mix * curves[rows, low + 1])


def with_histories(
    found: Mechanics, histories: Sequence[PathHistory], fit: ResponseTable, depth_mm: float, before_mm: float
) -> Mechanics:
    """Mechanics with force, area and charge as the histories of the path make them.

    before_mm : depth that the dot reached in earlier runs. Charges count from rest: what yield left before has leaked
    away.
    """
    force, before = fit.table[:, 0, 0], before_mm / depth_mm
    share = np.concatenate([[0.0], found.path_mm / depth_mm])
    factors, charge = np.ones((len(found.path_mm), 2)), found.charge_C
    for history in histories:
        change, at = history.changes_along(share, before)
        factors = factors * np.maximum(1.0 + change[1:, :2], 0.0)
        more = np.interp(at, TABLE_SHARES, force)[:, None] * change[:, 2:]
        charge = charge + more[1:] - more[0]
    contact = factors.T * [found.force_N, found.area_m2]
    return replace(found, force_N=contact[0], area_m2=contact[1], charge_C=charge)
