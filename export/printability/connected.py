"""Triangles that hang together."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


def connected_labels(pairs: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """One number (count,) for each triangle, equal where a chain of the pairs (n, 2) joins them."""
    graph = coo_array((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
