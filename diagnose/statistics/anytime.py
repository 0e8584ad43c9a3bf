"""Presses that come one by one, with leave to stop at any of them.

If every press is predicted from the earlier ones only, the product of density ratios to the null is a martingale, and
the chance that it ever exceeds 1 / p is at most p (Ville 1939; Shafer, Shen, Vereshchagin and Vovk, Stat. Sci. 26
(2011) 84). The null must have no free parameter: give its nuisances a prior.
"""

import numpy as np

from diagnose.statistics.held_out import sums_by_press
from diagnose.statistics.linear_gaussian import Sums
from mesh.types import Floats, Ints


def sequential_log_scores(residual: Floats, columns: Floats, prior_sigma: Floats, press: Ints) -> Floats:
    """Log-scores (presses,) of a linear model, each press predicted from those before it (Dawid 1984).

    residual (n,) and columns (n, k) whitened; prior_sigma : (k,), finite. ValueError where one is not.
    """
    if not np.all(np.isfinite(prior_sigma)):
        raise ValueError("the first press is predicted from the priors: each must be finite")
    so_far = Sums(np.zeros((columns.shape[1],) * 2), np.zeros(columns.shape[1]), 0.0, 0)
    evidence = [0.0]
    for part in sums_by_press(residual, columns, press):
        so_far = so_far + part
        evidence.append(so_far.log_evidence(prior_sigma))
    return np.diff(evidence)


def anytime_p_value(gains: Floats, candidates: int = 1) -> float:
    """p-value of sequential gains (presses,) over the null, valid at any stop; Bonferroni over candidates."""
    best = max(0.0, float(np.cumsum(gains).max()))
    return min(1.0, candidates * float(np.exp(-best)))
