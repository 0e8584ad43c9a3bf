"""What a fair test does in so many trials."""

from scipy.stats import binom


def fair_range(trials, level, doubt=1e-3):
    """Counts that a test of this level gives with probability 1 - doubt: (least, most)."""
    least, most = binom.interval(1.0 - doubt, trials, level)
    return int(least), int(most)


def is_fair(count, trials, level):
    least, most = fair_range(trials, level)
    return least <= count <= most
