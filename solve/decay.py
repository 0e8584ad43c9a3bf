"""The mean of an exponential decay over a step, by which linear relaxation of stress or charge is exact in time."""

import numba as nb
import numpy as np


@nb.vectorize(cache=True)  # type: ignore[no-untyped-call]
def mean_decay(a):  # type: ignore[no-untyped-def]
    """Mean of exp(-s) for s from 0 to a >= 0, which is (1 - exp(-a)) / a."""
    return -np.expm1(-a) / a if a > 0.0 else 1.0
