"""Proportions: Wilson's interval of one, and the rate per case that keeps a promise on a count."""

from scipy.stats import beta, binomtest


def wilson_interval(successes: int, trials: int) -> tuple[float, float]:
    """Two-sided score interval of a proportion, at 95 % (Wilson, J. Am. Stat. Assoc. 22 (1927) 209).

    ValueError unless 0 <= successes <= trials and trials is at least 1.
    """
    low, high = binomtest(successes, trials).proportion_ci(method="wilson")
    return float(low), float(high)


def rate_for_promise(allowed: int, cases: int, confidence: float = 0.99) -> float:
    """Largest rate per case at which at most `allowed` of `cases` events occur with this confidence.

    It solves P(Binomial(cases, rate) <= allowed) = confidence, by the beta distribution (Clopper and Pearson,
    Biometrika 26 (1934) 404).
    """
    return float(beta.ppf(1.0 - confidence, allowed + 1, cases - allowed))
