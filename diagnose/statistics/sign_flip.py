"""Few presses: is a gain real, without any law for its scatter?

Under the null a gain is as likely to be negative, so that all 2^presses signs are alike (Fisher, The Design of
Experiments, 1935, section 21; the maximum over candidates as in Westfall and Young 1993).
"""

import numpy as np

from mesh.types import Floats

EXACT = 14  # presses: 16 384 sign patterns
DRAWS = 9999


def sign_flip_p_values(gains: Floats, rng: np.random.Generator) -> Floats:
    """One-sided family-wise p-values (m,) for mean gains of m candidates above zero.

    gains : (m, presses). All patterns up to EXACT presses, beyond it random ones. Never below 2^-presses: six presses
    cannot prove anything at 1 %. The statistic is the sum over the root of the sum of squares, which flips keep.
    """
    length = np.linalg.norm(gains, axis=1)
    scaled = np.divide(gains.T, length, out=np.zeros_like(gains.T), where=length > 0.0)
    flipped = _signs(gains.shape[1], rng) @ scaled
    observed = scaled.sum(axis=0)
    tolerance = 1e-12 * gains.shape[1]  # sums in another order are equal
    return np.asarray((flipped.max(axis=1)[:, None] >= observed - tolerance).mean(axis=0))


def _signs(presses: int, rng: np.random.Generator) -> Floats:
    """Patterns (k, presses) of +1 and -1; the first is the observed one."""
    if presses <= EXACT:
        bits = np.arange(2**presses)[:, None] >> np.arange(presses)
        return np.asarray(1.0 - 2.0 * (bits & 1))
    drawn = rng.choice([-1.0, 1.0], (DRAWS, presses))
    return np.concatenate([np.ones((1, presses)), drawn])
