"""What depends on the path: softening and yield, from presses down and up again.

While the dot goes deeper than ever, force and charge are those of the way down. On the way up, and down again as far
as the largest depth U so far, they are those of the way up from U. The curves of several U go over into each other as
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

    def along(self, share: Floats, before: float = 0.0) -> tuple[Floats, Floats]:
        """Changes (t, 2 + e) along a path in shares (t,) of the depth, and the depths (t,) that charges refer to.

        before : the largest share that was reached earlier.
        """
        place = np.clip(share, 0.0, None)
        largest = np.maximum(np.maximum.accumulate(place), before)
        down = self._down(np.clip(place, 0.0, 1.0))
        inside = np.clip(place / np.maximum(largest, 1e-12), 0.0, 1.0)
        back = _between(np.array([self.shares[m] for m in BACK]), self._ways(inside), largest)
        returning = place < largest
        return np.where(returning[:, None], back, down), np.where(returning, largest, place)

    @cached_property
    def _down(self) -> PchipInterpolator:
        """Changes (t, 2 + e) at shares (t,) of the depth."""
        return _curve(self.shares, self.values[: len(self.shares)])

    @cached_property
    def _ways(self) -> PchipInterpolator:
        """Changes (t, b, 2 + e) on all ways back at parts (t,) of the depth where each began."""
        back = self.values[len(self.shares) :].reshape(len(BACK), len(RETURN), -1)[:, ::-1]
        whole = np.concatenate([back, self.values[list(BACK), None]], axis=1)
        return _curve((*RETURN[::-1], 1.0), whole.transpose(1, 0, 2))


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


def _curve(at: Sequence[float], values: Floats) -> PchipInterpolator:
    """Through values (n, ...) at depths (n,), constant towards touch."""
    return PchipInterpolator(np.array([0.0, *at]), np.concatenate([values[:1], values]))


def _between(turned: Floats, curves: Floats, largest: Floats) -> Floats:
    """Linear between curves (t, b, o) in the largest depth, constant beyond the ends."""
    place = np.interp(largest, turned, np.arange(len(turned)))
    low = np.minimum(place.astype(np.int64), len(turned) - 2)
    mix, rows = (place - low)[:, None], np.arange(len(largest))
    return np.asarray((1.0 - mix) * curves[rows, low] + mix * curves[rows, low + 1])


def with_history(
    found: Mechanics, histories: Sequence[PathHistory], fit: ResponseTable, depth_mm: float, before_mm: float
) -> Mechanics:
    """The path with force, area and charge as its history makes them; before_mm : reached by the dot in earlier runs.

    Charges count from rest: what yield left before has leaked away.
    """
    force, before = fit.table[:, 0, 0], before_mm / depth_mm
    share = np.concatenate([[0.0], found.path_mm / depth_mm])
    factors, charge = np.ones((len(found.path_mm), 2)), found.charge_C
    for history in histories:
        change, at = history.along(share, before)
        factors = factors * np.maximum(1.0 + change[1:, :2], 0.0)
        more = np.interp(at, ROWS, force)[:, None] * change[:, 2:]
        charge = charge + more[1:] - more[0]
    contact = factors.T * [found.force_N, found.area_m2]
    return replace(found, force_N=contact[0], area_m2=contact[1], charge_C=charge)
