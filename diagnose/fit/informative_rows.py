"""The coefficients of a recording in which sensitivities have energy: fits leave the others alone, which hold noise."""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.samples import Samples
from foundation.arrays import Bools, Floats

INFORMATIVE_SIGMAS = 0.3  # rows in which no sensitivity, as large as all the residual, makes more are not looked at


def informative_rows(samples: Samples, system: LinearisedSystem, sensitivities: Sequence[Floats]) -> Bools:
    """Flags (n,) of coefficients in which a column of any (n, k), scaled to the length of the residual, shows at all.

    A nuisance parameter is scaled to its prior where that is less. Only the length of the residual counts, not its
    shape, so that no test is biased.
    """
    weight = system.weight
    length = float(np.linalg.norm(system.residual * weight))
    largest = np.zeros(len(samples))
    for columns, sigma in [
        (system.nuisance_design, system.sigma),
        *((c, np.full(c.shape[1], np.inf)) for c in sensitivities),
    ]:
        shown = np.abs(columns) * weight[:, None]
        size = np.linalg.norm(shown, axis=0)
        scale = np.minimum(sigma, np.divide(length, size, out=np.zeros(len(size)), where=size > 0.0))
        largest = np.maximum(largest, (shown * scale).max(axis=1, initial=0.0))
    kept = largest > INFORMATIVE_SIGMAS
    for label in np.unique(samples.fold):  # every press keeps something to be judged by
        own = samples.fold == label
        if not kept[own].any():
            kept |= own
    return kept
