"""Columns of an impulse response: the drive as a mean over lags that double, any linear memory in a few of them.

residual(t) = sum over lags of h_k times the mean drive over the k-th lag interval: a finite impulse response, constant
over intervals that double, so that a few coefficients reach from one sample to the whole press (after Pillonetto and
De Nicolao, Automatica 46 (2010) 81, who give its coefficients a normal prior).
"""

from itertools import pairwise

import numpy as np

from foundation.arrays import Floats, Ints


def doubling_edges(longest: int) -> Ints:
    """Edges (k + 1,) of lag intervals in samples: [0, 1), [1, 2), [2, 4), [4, 8) ... up to at least `longest`."""
    return np.concatenate([[0], 2 ** np.arange(int(np.ceil(np.log2(max(longest, 1)))) + 1)])


def lagged_means(drive: Floats, edges: Ints) -> Floats:
    """Columns (n, k): means of a drive (n,) over lags [edges[k], edges[k + 1]); at rest before the first sample.

    Edges are in samples: runs at other rates need their own, equal in seconds. Give several drives, such as its
    square, or each run apart, for more freedom. Whiten the columns afterwards.
    """
    past = np.concatenate([np.zeros(int(edges[-1])), np.cumsum(drive - drive[0])])
    before = np.concatenate([[0.0], past])  # before[i + 1] is the sum up to and with i
    now = int(edges[-1]) + np.arange(len(drive)) + 1
    return np.column_stack([(before[now - a] - before[now - b]) / (b - a) for a, b in pairwise(edges)])
