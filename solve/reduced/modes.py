"""Fields of remembered stress, measured by what they do to the pressed segment, and condensed to a few modes.

A field M loads the segment by f = integral M : dE. Two fields are alike when the segment answers them alike, so that
fields are compared in the compliance of the deepest elastic state,
    (M, N) = f(M) . K^-1 f(N),
and what is in equilibrium with itself, f = 0, counts as nothing. Loads enter an orthonormal basis one by one (Gram
and Schmidt); the proper orthogonal decomposition of their coordinates then turns it so that the first modes carry
the most (Sirovich, Quart. Appl. Math. 45, 1987).
"""

from collections.abc import Callable

import numpy as np

from foundation.arrays import Floats

NEW_DIRECTION = 1e-3  # of the largest load: what is left of a smaller one is dropped
WORTH_A_MODE = 0.02  # of the first mode's size


class Basis:
    """Orthonormal loads f_i and answers z_i = K^-1 f_i with f_i . z_j = 1 for i = j, else 0."""

    def __init__(self, answer: Callable[[Floats], Floats]) -> None:
        self._answer = answer
        self._loads: list[Floats] = []
        self._answers: list[Floats] = []
        self._largest = 0.0

    def coordinates(self, load: Floats) -> Floats:
        """Coordinates (b,) of a load (n,) in the basis as it is now, enlarged where the load asks for it."""
        rest, found = load, []
        for f, z in zip(self._loads, self._answers, strict=True):
            found.append(float(rest @ z))
            rest = rest - found[-1] * f
        answer = self._answer(rest)
        size = np.sqrt(max(float(rest @ answer), 0.0))
        self._largest = max(self._largest, float(np.linalg.norm([*found, size])))
        if size > NEW_DIRECTION * self._largest:
            self._loads.append(rest / size)
            self._answers.append(answer / size)
            found.append(size)
        return np.array(found)


def leading_modes(snapshots: Floats, count: int) -> tuple[Floats, float]:
    """Rotation (b, r) from coordinates (s, b) to the leading modes, and the share of the largest one left out."""
    _, sizes, modes = np.linalg.svd(snapshots, full_matrices=False)
    kept = min(count, int((sizes > WORTH_A_MODE * sizes[0]).sum())) if sizes[0] > 0.0 else 1
    missing = snapshots - snapshots @ modes[:kept].T @ modes[:kept]
    largest = max(float(np.linalg.norm(snapshots, axis=1).max()), 1e-300)
    return modes[:kept].T, float(np.linalg.norm(missing, axis=1).max()) / largest
