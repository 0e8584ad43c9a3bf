"""Where the sensitivities live: fits leave the other coefficients alone, which hold noise and nothing to fit."""

from collections.abc import Sequence

import numpy as np

from diagnose.inference.samples import Samples
from mesh.types import Bools, Floats

KEPT = 0.999  # of the energy of each sensitivity: a thousandth of the information is given up for speed


def live_rows(samples: Samples, sensitivities: Sequence[Floats]) -> Bools:
    """Coefficients (n,) that together hold all but a little of every column of each (n, k).

    They are chosen without regard to what was measured, so that no test is biased.
    """
    kept = np.zeros(len(samples), dtype=bool)
    for column in (column for columns in sensitivities for column in columns.T):
        energy = column**2
        order = np.argsort(-energy)
        total = np.cumsum(energy[order])
        if total[-1] > 0.0:
            kept[order[: int(np.searchsorted(total, KEPT * total[-1])) + 1]] = True
    for label in np.unique(samples.fold):  # every press keeps something to be judged by
        own = samples.fold == label
        if not kept[own].any():
            kept |= own
    return kept
