"""Probabilities of models from held-out scores."""

import numpy as np
from scipy.special import softmax

from foundation.arrays import Floats

BOOTSTRAP_DRAWS = 1000


def held_out_probabilities(scores: Floats, rng: np.random.Generator) -> Floats:
    """Probabilities (m,) from held-out log-scores (m, presses): pseudo-BMA+ (Yao, Vehtari, Simpson and Gelman 2018).

    A Bayesian bootstrap over presses keeps a lucky press from deciding (Bayesian Analysis 13, 917).
    """
    share = rng.dirichlet(np.ones(scores.shape[1]), BOOTSTRAP_DRAWS)
    return np.asarray(softmax(scores.shape[1] * share @ scores.T, axis=1).mean(axis=0))
