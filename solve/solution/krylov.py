"""Flexible GMRES (Saad, Iterative Methods for Sparse Linear Systems, 2003, algorithm 9.6), without restarts.

The preconditioned directions are kept: SciPy's GMRES, which does not keep them, applies the preconditioner twice more
for every solution, and gains no more digits than a preconditioner in single precision has.
"""

from collections.abc import Callable

import numpy as np

from foundation.arrays import Floats

EXHAUSTED = 1e-15  # relative length of a direction that is new by round-off alone

Apply = Callable[[Floats], Floats]


def flexible_gmres(product: Apply, approximate: Apply, rhs: Floats, tolerance: float, iterations: int) -> Floats:
    """Solution x (n,) with |rhs - A x| <= tolerance |rhs|, or as near as the iterations bring it; NaN where something
    overflows.

    product : A v of a vector; approximate : about A^-1 v, which need not be linear.
    """
    size = float(np.linalg.norm(rhs))
    if size == 0.0:
        return np.zeros_like(rhs)
    basis, directions = np.empty((iterations + 1, len(rhs))), np.empty((iterations, len(rhs)))
    projected, weights = np.zeros((iterations + 1, iterations)), np.zeros(0)
    goal = np.append(size, np.zeros(iterations))
    basis[0] = rhs / size
    for i in range(iterations):
        directions[i] = approximate(basis[i])
        image = product(directions[i])
        length = float(np.linalg.norm(image))
        if not np.isfinite(length):
            return np.full_like(rhs, np.nan)
        for _ in range(2):  # the second time takes away what round-off left of the basis
            part = basis[: i + 1] @ image
            image -= part @ basis[: i + 1]
            projected[: i + 1, i] += part
        projected[i + 1, i] = new = float(np.linalg.norm(image))
        weights = np.linalg.lstsq(projected[: i + 2, : i + 1], goal[: i + 2])[0]
        left = float(np.linalg.norm(goal[: i + 2] - projected[: i + 2, : i + 1] @ weights))
        if left <= tolerance * size or new <= EXHAUSTED * length:
            break
        basis[i + 1] = image / new
    return np.asarray(weights @ directions[: len(weights)])
