"""Criteria for the choice of a model: Schwarz's, and probabilities from held-out scores."""

import numpy as np
from scipy.special import softmax

from foundation.arrays import Floats


def bic(log_likelihood: float, parameters: int, samples: int) -> float:
    """Schwarz's criterion q ln n - 2 ln L (Ann. Stat. 6 (1978) 461).

    parameters : their number q. samples : number n of whitened samples, which are independent.
    """
    return parameters * float(np.log(samples)) - 2.0 * log_likelihood


def held_out_probabilities(scores: Floats, rng: np.random.Generator, draws: int = 1000) -> Floats:
    """Probabilities (m,) from held-out log-scores (m, presses): pseudo-BMA+ (Yao, Vehtari, Simpson and Gelman 2018).

    A Bayesian bootstrap over presses keeps a lucky press from deciding (Bayesian Analysis 13, 917).
    """
    share = rng.dirichlet(np.ones(scores.shape[1]), draws)
    return np.asarray(softmax(scores.shape[1] * share @ scores.T, axis=1).mean(axis=0))
