"""The stop operator, the element of which all hysteresis without rate is made here, and the play that is its rest.

Of a signal x the stop of half width r is what a slider shows that sticks until r and then slips,
    s_n = s_(n-1) + x_n - x_(n-1), at most r either way,
and x - s, the play, is what has slipped. Sums of them are Prandtl's and Ishlinskii's model (Visintin, Differential
Models of Hysteresis, 1994, chapter III). The answer is the same at any speed.
"""

import numba as nb
import numpy as np

from foundation.arrays import Floats


def apply_stop(signal: Floats, limit: float, stiffness: float = 1.0) -> Floats:
    """Stop operator on a signal (t,) times a stiffness, at most limit either way; zero at the first sample."""
    return np.asarray(_stop(np.ascontiguousarray(signal, dtype=np.float64), limit, stiffness))


@nb.njit(cache=True)
def _stop(signal, limit, stiffness):  # type: ignore[no-untyped-def]
    stop = np.zeros_like(signal)
    for n in range(1, len(signal)):
        moved = stop[n - 1] + stiffness * (signal[n] - signal[n - 1])
        stop[n] = min(max(moved, -limit), limit)
    return stop
