"""Shapes of a layer's elastic stress field, collected from presses and condensed to the few that matter.

Snapshots enter an orthonormal basis one by one (Gram and Schmidt); the proper orthogonal decomposition of their
coordinates then turns it so that the first modes carry the most (Sirovich, Quart. Appl. Math. 45, 1987).
"""

import numpy as np

from mesh.types import Floats

NEW_DIRECTION = 3e-3  # of the largest snapshot: what is left of a smaller one is dropped


class Basis:
    """Orthonormal shapes of one field under given weights (one to each of its numbers)."""

    def __init__(self, weight: Floats) -> None:
        self._root = np.sqrt(weight).astype(np.float32)
        self._shapes: list[Floats] = []
        self._largest = 0.0

    def add(self, field: Floats) -> Floats:
        """Coordinates (b,) of a field (n,) in the basis as it is now, enlarged where the field asks for it."""
        rest = np.asarray(field, dtype=np.float64) * self._root
        self._largest = max(self._largest, float(np.linalg.norm(rest)))
        coordinates = []
        for shape in self._shapes:
            coordinates.append(float(shape @ rest))
            rest = rest - coordinates[-1] * shape
        size = float(np.linalg.norm(rest))
        if size > NEW_DIRECTION * self._largest:
            self._shapes.append(rest / size)
            coordinates.append(size)
        return np.array(coordinates)


def leading_modes(snapshots: Floats, count: int) -> tuple[Floats, float]:
    """Rotation (b, r) from coordinates (s, b) to the leading modes, and the share of the largest one left out."""
    _, sizes, modes = np.linalg.svd(snapshots, full_matrices=False)
    kept = min(count, int((sizes > 1e-6 * sizes[0]).sum())) if sizes[0] > 0.0 else 1
    missing = snapshots - snapshots @ modes[:kept].T @ modes[:kept]
    largest = max(float(np.linalg.norm(snapshots, axis=1).max()), 1e-300)
    return modes[:kept].T, float(np.linalg.norm(missing, axis=1).max()) / largest
