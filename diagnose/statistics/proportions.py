"""Proportions: Wilson's interval of one, and the rate per case that keeps a promise on a count."""

from math import sqrt

from scipy.stats import beta, norm


def wilson_interval(successes: int, trials: int, level: float = 0.95) -> tuple[float, float]:
    """Two-sided score interval of a proportion (Wilson, J. Am. Stat. Assoc. 22 (1927) 209).

    ValueError unless 0 <= successes <= trials and trials is at least 1.
    """
    if not 0 <= successes <= trials or trials < 1:
        raise ValueError(f"{successes} of {trials} is no proportion")
    z, share = float(norm.isf(0.5 * (1.0 - level))), successes / trials
    middle = share + z**2 / (2.0 * trials)
    half = z * sqrt(share * (1.0 - share) / trials + z**2 / (4.0 * trials**2))
    return max(0.0, (middle - half) / (1.0 + z**2 / trials)), min(1.0, (middle + half) / (1.0 + z**2 / trials))


def rate_for_promise(allowed: int, cases: int, confidence: float = 0.99) -> float:
    """Largest rate per case at which at most `allowed` of `cases` events occur with this confidence.

    It solves P(Binomial(cases, rate) <= allowed) = confidence, by the beta distribution (Clopper and Pearson,
    Biometrika 26 (1934) 404).
    """
    return float(beta.ppf(1.0 - confidence, allowed + 1, cases - allowed))
