"""How far apart two predictions have to be for the recordings to tell them apart."""

from scipy.stats import norm

Group = tuple[int, ...]
"""Numbers of models that cannot be told apart."""


def least_separation(error: float) -> float:
    """Distance in sigma between two predictions at which the wrong one fits better with this probability.

    It is 2 z (Fisher 1936).
    """
    return 2.0 * float(norm.isf(error))
