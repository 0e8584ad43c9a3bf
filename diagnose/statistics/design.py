"""The press that would best tell the surviving rivals apart, before it is made.

The separation of a proposed press is the distance in sigma between what two rivals predict for it, after the rival's
parameters and the nuisances have moved as far as earlier presses leave them free (T-optimality: Atkinson and Fedorov,
Biometrika 62 (1975) 57; the criterion of the least separated pair: Hunter and Reiner, Technometrics 7 (1965) 307).
"""

import numpy as np
from scipy.stats import norm

from diagnose.statistics.nuisance import Marginal
from mesh.types import Floats


def remaining_spread(information: Floats) -> Floats:
    """A root (p, p) of the covariance that earlier presses, with priors, leave to p parameters: R R' = information^-1.

    LinAlgError where they leave one undetermined.
    """
    return np.linalg.inv(np.linalg.cholesky(information)).T


def expected_separation(difference: Floats, tangent: Floats, spread: Floats) -> float:
    """Sigma between two rivals in a proposed press.

    difference : (n,) of their whitened predictions. tangent : (n, p) whitened sensitivities of what may still move,
    spread : (p, p) from `remaining_spread`.
    """
    return float(np.linalg.norm(Marginal(tangent @ spread, np.ones(spread.shape[1]))(difference)))


def best_press(separation: Floats) -> int:
    """The press whose least separated pair of rivals is farthest apart; separation : (presses, pairs) in sigma."""
    return int(max(range(len(separation)), key=lambda n: (separation[n].min(), separation[n].mean())))


def chance_of_right_choice(separation: float) -> float:
    """Probability that the true one of two fixed predictions fits better."""
    return float(norm.cdf(0.5 * separation))
